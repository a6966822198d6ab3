// SPDX-License-Identifier: Apache-2.0
// The hook fires for every way to allocate, only on the thread that does it; first of all, that it fires.
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <new>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <malloc.h>

#include "rt/allocation_guard.hpp"

namespace lxd::rt_allocation_guard_test {
namespace {

class AllocationGuardTest : public ::testing::Test {
 protected:
  void SetUp() override {
#ifdef LXD_SANITIZED
    ASSERT_FALSE(AllocationGuard::active());
    GTEST_SKIP() << "the sanitizer has an allocator of its own";
#else
    ASSERT_TRUE(AllocationGuard::active()) << "this executable does not link lxd_alloc_hook";
#endif
  }
};

// Keeps the compiler from dropping an allocation that nobody reads.
void use(void* block) { asm volatile("" : : "r"(block) : "memory"); }

struct alignas(128) Wide {
  char bytes[128];
};

TEST_F(AllocationGuardTest, CountsEveryWayToAllocateOnce) {
  const auto counts_one = [](const char* what, auto&& allocate) {
    const AllocationGuard guard;
    void* const block = allocate();
    use(block);
    EXPECT_EQ(guard.count(), 1u) << what;
    EXPECT_EQ(guard.frees(), 0u) << what;
    std::free(block);
    EXPECT_EQ(guard.frees(), 1u) << what;
  };
  counts_one("malloc", [] { return std::malloc(10); });
  counts_one("calloc", [] { return std::calloc(3, 10); });
  counts_one("realloc", [] { return std::realloc(nullptr, 10); });
  counts_one("aligned_alloc", [] { return std::aligned_alloc(64, 128); });
  counts_one("memalign", [] { return memalign(64, 100); });
  counts_one("valloc", [] { return valloc(100); });
  counts_one("posix_memalign", [] {
    void* block = nullptr;
    EXPECT_EQ(posix_memalign(&block, 64, 100), 0);
    return block;
  });
}

TEST_F(AllocationGuardTest, CountsEveryOperatorNewOnce) {
  const AllocationGuard guard;
  void* const block = ::operator new(10);
  use(block);
  ::operator delete(block);
  void* const array = ::operator new[](10, std::align_val_t{128}, std::nothrow);
  use(array);
  ::operator delete[](array, std::align_val_t{128});
  EXPECT_EQ(guard.count(), 2u);
  EXPECT_EQ(guard.frees(), 2u);
}

TEST_F(AllocationGuardTest, CountsWhatTheLanguageAndTheLibraryAllocate) {
  const AllocationGuard guard;
  {
    const auto wide = std::make_unique<Wide>();
    use(wide.get());
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(wide.get()) % alignof(Wide), 0u);
    const std::string text(100, 'x');
    use(const_cast<char*>(text.data()));
    const std::vector<int> numbers(10);
    use(const_cast<int*>(numbers.data()));
  }
  EXPECT_EQ(guard.count(), 3u);
  EXPECT_EQ(guard.frees(), 3u);
}

TEST_F(AllocationGuardTest, MemoryKeepsWhatCAndPosixPromise) {
  int* const zeroes = static_cast<int*>(std::calloc(100, sizeof(int)));
  ASSERT_NE(zeroes, nullptr);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(zeroes[i], 0);
  zeroes[99] = 7;
  int* const grown = static_cast<int*>(std::realloc(zeroes, 100'000 * sizeof(int)));
  ASSERT_NE(grown, nullptr);
  EXPECT_EQ(grown[99], 7);
  std::free(grown);
  void* block = nullptr;
  EXPECT_EQ(posix_memalign(&block, 3, 100), EINVAL);
  EXPECT_EQ(posix_memalign(&block, 0, 100), EINVAL);
  EXPECT_EQ(posix_memalign(&block, 64, std::size_t{1} << 62), ENOMEM);
  EXPECT_EQ(block, nullptr);
}

TEST_F(AllocationGuardTest, GivenWorkWithoutAllocationThenTheCountIsZero) {
  const AllocationGuard guard;
  int sum = 0;
  for (int i = 0; i < 1000; ++i) sum += i;
  use(&sum);
  std::free(nullptr);
  EXPECT_EQ(guard.count() + guard.frees(), 0u);
}

TEST_F(AllocationGuardTest, GivenAllocationsOfAnotherThreadThenTheyAreNotOurs) {
  std::uint64_t theirs = 0;
  std::thread other([&] {
    const AllocationGuard guard;
    for (int i = 0; i < 5; ++i) use(std::make_unique<int>(i).get());
    theirs = guard.count();
  });
  const AllocationGuard guard;
  other.join();
  EXPECT_EQ(theirs, 5u);
  EXPECT_EQ(guard.count(), 0u);
}

TEST_F(AllocationGuardTest, AskingWhetherItIsActiveLeavesTheCountAlone) {
  const AllocationGuard guard;
  EXPECT_TRUE(AllocationGuard::active());
  EXPECT_EQ(guard.count() + guard.frees(), 0u);
}

}  // namespace
}  // namespace lxd::rt_allocation_guard_test
