// SPDX-License-Identifier: Apache-2.0
// After the prefault neither static memory, nor code never run before, nor a fresh part of the stack faults; before all
// that: the fault counter counts.
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <thread>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/mman.h>
#include <unistd.h>

#include "rt/memory_map.hpp"
#include "rt/page_faults.hpp"
#include "rt/prefault.hpp"
#include "tests/support/emulated.hpp"

namespace lxd::rt_prefault_test {
namespace {

constexpr std::size_t kArray_bytes = std::size_t{1} << 20;

std::size_t page_bytes() { return static_cast<std::size_t>(sysconf(_SC_PAGESIZE)); }

// Faults of the calling thread while work runs. Counts nothing of its own after the first use.
template <typename Work>
std::uint64_t faults_during(Work&& work) {
  const PageFaults before = thread_page_faults();
  work();
  return (thread_page_faults() - before).total();
}

void touch(volatile char* begin, std::size_t bytes) {
  for (std::size_t i = 0; i < bytes; i += page_bytes()) begin[i] = 1;
}

// Fresh private memory that the test gives back; not through malloc, which may reuse resident pages.
struct FreshMemory {
  explicit FreshMemory(std::size_t size)
      : bytes(size), begin(mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0)) {
    (void)madvise(begin, bytes, MADV_NOHUGEPAGE);
  }
  ~FreshMemory() { (void)munmap(begin, bytes); }
  FreshMemory(const FreshMemory&) = delete;
  FreshMemory& operator=(const FreshMemory&) = delete;
  [[nodiscard]] volatile char* data() const { return static_cast<volatile char*>(begin); }

  std::size_t bytes;
  void* begin;
};

PrefaultOptions without_lock() {
  PrefaultOptions options;
  options.lock = false;  // leave the limits of this test process alone
  return options;
}

class PrefaultTest : public ::testing::Test {
 protected:
  void SetUp() override {
#ifdef LXD_SANITIZED
    GTEST_SKIP() << "a sanitizer's shadow memory is not to be made resident";
#endif
  }
};

TEST(PageFaults, OneFreshPageIsOneFault) {
#ifdef LXD_SANITIZED
  GTEST_SKIP() << "a sanitizer's shadow memory faults as well";
#endif
  const FreshMemory memory(2 * page_bytes());
  const auto faults_of_page = [&](std::size_t page) {
    return faults_during([&] { touch(memory.data() + page * page_bytes(), page_bytes()); });
  };
  ASSERT_GE(faults_of_page(0), 1u);  // and perhaps those of code that runs for the first time
  EXPECT_EQ(faults_of_page(1), 1u);
  EXPECT_EQ(faults_of_page(1), 0u);
}

TEST(PageFaults, BelongToTheThreadThatTookThem) {
  const FreshMemory memory(64 * page_bytes());
  std::uint64_t theirs = 0;
  std::thread other([&] { theirs = faults_during([&] { touch(memory.data(), memory.bytes); }); });
  const std::uint64_t ours = faults_during([&] { other.join(); });
  EXPECT_GE(theirs, 64u);
  EXPECT_LT(ours, 64u);
}

TEST_F(PrefaultTest, GivenAPrefaultThenNeitherStaticNorFreshMemoryFaults) {
  if (test::emulated()) GTEST_SKIP() << "page faults are the emulator's";
  static std::array<char, kArray_bytes> array;
  const FreshMemory before(kArray_bytes), after(kArray_bytes);
  EXPECT_GE(faults_during([&] { touch(before.data(), kArray_bytes); }), kArray_bytes / page_bytes());
  const auto report = prefault_process(without_lock());
  ASSERT_TRUE(report.ok()) << report.error().message;
  EXPECT_EQ(faults_during([&] { touch(array.data(), kArray_bytes); }), 0u);
  EXPECT_EQ(faults_during([&] { touch(after.data(), kArray_bytes); }), 0u);
  EXPECT_GE(report->resident_bytes, 2 * kArray_bytes);
  EXPECT_GT(report->mappings, 5u);
}

TEST_F(PrefaultTest, GivenAPrefaultThenAFirstCallIntoASharedLibraryDoesNotFault) {
  if (test::emulated()) GTEST_SKIP() << "page faults are the emulator's";
  volatile double x = 2.5;
  volatile double y = 0;
  ASSERT_TRUE(prefault_process(without_lock()).ok());
  ASSERT_GT(prefault_stack(std::size_t{64} << 10), 0u);
  EXPECT_EQ(faults_during([&] { y = jn(7, x) + y0(x) + lgamma(x); }), 0u);  // bound lazily, here for the first time
  EXPECT_NE(y, 0);
}

TEST_F(PrefaultTest, GivenAPrefaultThenContentsAreAsTheyWere) {
  static std::array<unsigned char, kArray_bytes> array;
  for (std::size_t i = 0; i < kArray_bytes; ++i) array[i] = static_cast<unsigned char>(i * 7);
  ASSERT_TRUE(prefault_process(without_lock()).ok());
  for (std::size_t i = 0; i < kArray_bytes; ++i) ASSERT_EQ(array[i], static_cast<unsigned char>(i * 7));
}

TEST_F(PrefaultTest, GivenInaccessibleMemoryThenItIsLeftOut) {
  FreshMemory memory(64 * page_bytes());
  ASSERT_EQ(mprotect(memory.begin, memory.bytes, PROT_NONE), 0);
  const auto report = prefault_process(without_lock());
  ASSERT_TRUE(report.ok());
  EXPECT_GE(report->skipped, 1u);
  ASSERT_EQ(mprotect(memory.begin, memory.bytes, PROT_READ | PROT_WRITE), 0);
  EXPECT_GE(faults_during([&] { touch(memory.data(), memory.bytes); }), 64u);
}

TEST_F(PrefaultTest, GivenAnotherThreadsStackThenOnlyItsTopIsMadeResident) {
  std::atomic<bool> stop{false};
  std::thread sleeper([&] {
    while (!stop.load()) std::this_thread::yield();
  });
  const auto small = prefault_process(without_lock());
  PrefaultOptions whole = without_lock();
  whole.other_stack_bytes = std::size_t{1} << 40;
  const auto large = prefault_process(whole);
  stop.store(true);
  sleeper.join();
  ASSERT_TRUE(small.ok() && large.ok());
  EXPECT_GE(large->resident_bytes, small->resident_bytes + (std::size_t{1} << 20));
}

TEST_F(PrefaultTest, GivenALargeFileThenItStaysOut) {
  PrefaultOptions options = without_lock();
  options.file_limit_bytes = 1;
  const auto without_files = prefault_process(options), with_files = prefault_process(without_lock());
  ASSERT_TRUE(without_files.ok() && with_files.ok());
  EXPECT_GT(without_files->skipped, with_files->skipped);
}

// Runs work on a thread with a stack that nothing has touched (glibc would hand out a used one).
template <typename Work>
void on_fresh_stack_of(std::size_t bytes, Work&& work) {
  const FreshMemory stack(bytes);
  pthread_attr_t attributes;
  ASSERT_EQ(pthread_attr_init(&attributes), 0);
  ASSERT_EQ(pthread_attr_setstack(&attributes, stack.begin, bytes), 0);
  pthread_t thread{};
  const auto run = [](void* context) -> void* {
    (*static_cast<std::remove_reference_t<Work>*>(context))();
    return nullptr;
  };
  ASSERT_EQ(pthread_create(&thread, &attributes, run, &work), 0);
  ASSERT_EQ(pthread_join(thread, nullptr), 0);
  ASSERT_EQ(pthread_attr_destroy(&attributes), 0);
}

[[gnu::noinline]] void use_stack() {
  volatile char block[200'000];  // NOLINT(modernize-avoid-c-arrays): std::array has no volatile access
  touch(block, sizeof(block));
}

TEST_F(PrefaultTest, GivenAPrefaultedStackThenADeepCallDoesNotFault) {
  std::uint64_t before = 0, after = 0;
  on_fresh_stack_of(std::size_t{1} << 20, [&] { before = faults_during(use_stack); });
  on_fresh_stack_of(std::size_t{1} << 20, [&] {
    (void)prefault_stack(std::size_t{256} << 10);
    after = faults_during(use_stack);
  });
  EXPECT_GE(before, 40u) << "else this test shows nothing";
  EXPECT_EQ(after, 0u);
}

TEST_F(PrefaultTest, GivenMoreThanTheStackHasThenItTouchesWhatIsThereAndReturns) {
  std::size_t touched = 0;
  on_fresh_stack_of(std::size_t{512} << 10, [&] { touched = prefault_stack(std::size_t{1} << 30); });
  EXPECT_GT(touched, std::size_t{256} << 10);
  EXPECT_LT(touched, std::size_t{512} << 10);
}

TEST_F(PrefaultTest, ReportsWhetherItCouldLock) {
  const auto report = prefault_process();
  ASSERT_TRUE(report.ok());
  EXPECT_EQ(report->locked, report->lock_errno == 0);
  ASSERT_EQ(munlockall(), 0);
}

TEST(MemoryMap, ReadsEveryFieldOfALine) {
  const auto mapping = parse_mapping("7f00a000-7f00c000 rw-s 00002000 fe:00 247134                     /tmp/a file");
  ASSERT_TRUE(mapping.ok()) << mapping.error().message;
  EXPECT_EQ(mapping->begin, 0x7f00a000u);
  EXPECT_EQ(mapping->bytes(), 0x2000u);
  EXPECT_TRUE(mapping->readable && mapping->writable && mapping->shared);
  EXPECT_FALSE(mapping->executable);
  EXPECT_EQ(mapping->inode, 247134u);
  EXPECT_EQ(mapping->name, "/tmp/a file");
}

TEST(MemoryMap, ReadsALineWithoutAName) {
  const auto mapping = parse_mapping("7f00-7f01 ---p 00000000 00:00 0 ");
  ASSERT_TRUE(mapping.ok()) << mapping.error().message;
  EXPECT_EQ(mapping->name, "");
  EXPECT_FALSE(mapping->readable || mapping->writable || mapping->shared);
}

TEST(MemoryMap, RefusesALineThatIsNotOne) {
  for (const char* line : {"", "7f00", "7f00-", "zz-7f01 r--p 0 0:0 0", "7f02-7f01 r--p 0 0:0 0",
                           "7f00-7f01 r- 0 0:0 0", "7f00-7f01 r--p 0 0:0 x"}) {
    const auto mapping = parse_mapping(line);
    ASSERT_FALSE(mapping.ok()) << line;
    EXPECT_NE(mapping.error().message.find("/proc/self/maps"), std::string::npos);
  }
}

TEST(MemoryMap, FindsThisFunctionInExecutableMemory) {
  const auto map = read_memory_map();
  ASSERT_TRUE(map.ok());
  const auto here = reinterpret_cast<std::uintptr_t>(&use_stack);
  int found = 0;
  for (const Mapping& m : *map) found += here >= m.begin && here < m.end && m.executable ? 1 : 0;
  EXPECT_EQ(found, 1);
}

}  // namespace
}  // namespace lxd::rt_prefault_test
