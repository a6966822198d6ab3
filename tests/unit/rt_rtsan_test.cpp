// SPDX-License-Identifier: Apache-2.0
// The building blocks of the real-time path inside a nonblocking function. Built with -fsanitize=realtime a wrong call
// ends the process (and the first test shows that it does); in other builds the allocation count must stay 0.
#include <array>
#include <cstddef>
#include <cstdlib>
#include <mutex>
#include <optional>

#include <gtest/gtest.h>

#include "rt/allocation_guard.hpp"
#include "rt/arena.hpp"
#include "rt/counters.hpp"
#include "rt/fixed_pool.hpp"
#include "rt/latency_histogram.hpp"
#include "rt/nonblocking.hpp"
#include "rt/so3.hpp"
#include "rt/spsc_drop_oldest_ring.hpp"
#include "rt/spsc_ring.hpp"
#include "rt/stopwatch.hpp"
#include "rt/sweep_pool.hpp"

#if defined(__clang__)
#if __has_feature(realtime_sanitizer)
#define LXD_REALTIME_SANITIZER 1
#endif
#endif

namespace lxd::rt_rtsan_test {
namespace {

#ifdef LXD_REALTIME_SANITIZER

// Wrong on purpose, which the compiler would otherwise tell.
LXD_KNOWN_NONBLOCKING_BEGIN
void allocates() noexcept LXD_NONBLOCKING {
  void* volatile block = std::malloc(10);
  std::free(block);
}
void locks(std::mutex& mutex) noexcept LXD_NONBLOCKING { const std::lock_guard<std::mutex> lock(mutex); }
LXD_KNOWN_NONBLOCKING_END

TEST(RealtimeSanitizer, GivenANonblockingFunctionThatAllocatesOrLocksThenTheProcessEnds) {
  std::mutex mutex;
  EXPECT_DEATH(allocates(), "malloc");
  EXPECT_DEATH(locks(mutex), "pthread_mutex_lock");
}

#endif

enum class Drop { kPoolEmpty, kRingFull, kCount };

// Everything a cycle of the real-time thread is made of.
struct Blocks {
  alignas(Arena::kAlignment) std::array<std::byte, 1 << 16> block{};
  Arena arena{block};
  SpscRing<int> ring{arena.take<int>("ring", 8)};
  SpscDropOldestRing<int> newest{arena.take<SpscDropOldestRing<int>::Slot>("newest", 8)};
  FixedPool<double> pool{arena, "pool", 4};
  SweepPool sweeps{arena, "sweeps", 2, 100};
  LatencyHistogram latency;
  Counters<Drop> drops;
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();

  void cycle(int i) noexcept LXD_NONBLOCKING {
    const Stopwatch watch;
    pass_through_rings(i);
    borrow();
    R = orthonormalized(R * Exp(0.1 * Log(R) + Eigen::Vector3d(0.1, 0.2, 0.3)));
    latency.add(watch.elapsed());
  }

 private:
  void pass_through_rings(int i) noexcept LXD_NONBLOCKING {
    if (!ring.push(i)) drops.add(Drop::kRingFull);
    newest.push(i);
    if (i % 2 == 0) (void)ring.pop();
    if (i % 16 == 0) (void)newest.pop();
  }

  void borrow() noexcept LXD_NONBLOCKING {
    if (!pool.acquire()) {
      drops.add(Drop::kPoolEmpty);
      for (std::uint32_t k = 0; k < pool.capacity(); ++k) pool.release(k);
    }
    const std::optional<SweepIndex> sweep = sweeps.acquire();
    if (!sweep) return;
    (void)sweeps[*sweep].push({1, 2, 3, 4, 5});
    (void)sweeps.release(*sweep);
  }
};

TEST(RealTimePath, RingsPoolsHistogramsAndRotationsNeitherAllocateNorBlock) {
  static Blocks blocks;
  ASSERT_FALSE(blocks.arena.exhausted());
#ifndef LXD_SANITIZED
  ASSERT_TRUE(AllocationGuard::active()) << "this executable does not link lxd_alloc_hook";
#endif
  const AllocationGuard guard;
  for (int i = 0; i < 1000; ++i) blocks.cycle(i);
  EXPECT_EQ(guard.count(), 0u);
  EXPECT_EQ(guard.frees(), 0u);
  EXPECT_GT(blocks.drops[Drop::kRingFull], 0u);
  EXPECT_GT(blocks.drops[Drop::kPoolEmpty], 0u);
  EXPECT_GT(blocks.newest.dropped(), 0u);
  EXPECT_EQ(blocks.latency.count(), 1000u);
}

}  // namespace
}  // namespace lxd::rt_rtsan_test
