// SPDX-License-Identifier: Apache-2.0
// Cost of handing an element over, and of borrowing a buffer: what each sample pays before any algorithm sees it.
#include <array>
#include <cstddef>
#include <vector>

#include <benchmark/benchmark.h>

#include "rt/arena.hpp"
#include "rt/fixed_pool.hpp"
#include "rt/spsc_drop_oldest_ring.hpp"
#include "rt/spsc_ring.hpp"
#include "rt/sweep_pool.hpp"

namespace lxd {
namespace {

constexpr std::size_t kSlots = 256;

// As large as an IMU sample (56 bytes) and as a LiDAR datagram's payload (1.4 kB).
template <std::size_t Bytes>
struct Element {
  std::array<std::byte, Bytes> bytes;
};

template <std::size_t Bytes>
void spsc_push_pop(benchmark::State& state) {
  std::vector<Element<Bytes>> storage(kSlots);
  SpscRing<Element<Bytes>> ring(storage);
  const Element<Bytes> element{};
  for (auto _ : state) {
    benchmark::DoNotOptimize(ring.push(element));
    benchmark::DoNotOptimize(ring.pop());
  }
}
BENCHMARK(spsc_push_pop<56>);
BENCHMARK(spsc_push_pop<1400>);

template <std::size_t Bytes>
void drop_oldest_push_pop(benchmark::State& state) {
  std::vector<AtomicRecord<Element<Bytes>>> storage(kSlots);
  SpscDropOldestRing<Element<Bytes>> ring(storage);
  const Element<Bytes> element{};
  for (auto _ : state) {
    ring.push(element);
    benchmark::DoNotOptimize(ring.pop());
  }
}
BENCHMARK(drop_oldest_push_pop<56>);
BENCHMARK(drop_oldest_push_pop<1400>);

void drop_oldest_push_into_full(benchmark::State& state) {
  std::vector<AtomicRecord<Element<56>>> storage(kSlots);
  SpscDropOldestRing<Element<56>> ring(storage);
  const Element<56> element{};
  for (auto _ : state) ring.push(element);
}
BENCHMARK(drop_oldest_push_into_full);

void fixed_pool_acquire_release(benchmark::State& state) {
  alignas(Arena::kAlignment) static std::array<std::byte, 1 << 16> block;
  Arena arena(block);
  FixedPool<double> pool(arena, "pool", 100);
  for (auto _ : state) {
    const auto index = pool.acquire();
    benchmark::DoNotOptimize(pool.release(*index));
  }
}
BENCHMARK(fixed_pool_acquire_release);

void sweep_pool_acquire_release(benchmark::State& state) {
  alignas(Arena::kAlignment) static std::array<std::byte, 1 << 16> block;
  Arena arena(block);
  SweepPool pool(arena, "sweeps", 4, 100);
  for (auto _ : state) {
    const auto index = pool.acquire();
    benchmark::DoNotOptimize(pool.release(*index));
  }
}
BENCHMARK(sweep_pool_acquire_release);

}  // namespace
}  // namespace lxd
