// SPDX-License-Identifier: Apache-2.0
// Threads place themselves; what is not permitted is told and costs nothing else. The lock lends urgency.
#include <atomic>
#include <cerrno>
#include <mutex>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <linux/capability.h>
#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "board/default/threads.hpp"
#include "board/placement_text.hpp"
#include "rt/priority_mutex.hpp"
#include "rt/thread_placement.hpp"

namespace lxd::rt_thread_placement_test {
namespace {

// Of the calling thread alone; what root may beyond others.
void give_up_privileges() {
  __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
  __user_cap_data_struct none[_LINUX_CAPABILITY_U32S_3]{};
  ASSERT_EQ(syscall(SYS_capset, &header, none), 0);
}

template <typename Body>
void in_own_thread(Body&& body) {
  std::thread(std::forward<Body>(body)).join();
}

// What /proc says of the calling thread's scheduler.
int policy_of_this_thread() {
  int policy = 0;
  sched_param parameter{};
  pthread_getschedparam(pthread_self(), &policy, &parameter);
  return policy;
}

bool fifo_is_permitted() {
  bool permitted = false;
  in_own_thread([&] { permitted = place_this_thread({.name = "probe", .fifo_priority = 1}).as_wanted(); });
  return permitted;
}

TEST(ThreadPlacement, GivesNameAndCpuAndTouchesTheStack) {
  in_own_thread([] {
    cpu_set_t before;
    ASSERT_EQ(pthread_getaffinity_np(pthread_self(), sizeof before, &before), 0);
    int first = 0;
    while (!CPU_ISSET(first, &before)) ++first;
    const std::uint64_t cpu = std::uint64_t{1} << static_cast<unsigned>(first);
    constexpr std::size_t kStack_bytes = 64 * 1024;
    const auto report =
        place_this_thread({.name = "a_name_that_is_too_long", .cpus = cpu, .stack_bytes = kStack_bytes});
    EXPECT_TRUE(report.as_wanted());
    EXPECT_EQ(report.cpus, cpu);
    EXPECT_EQ(report.stack_bytes, kStack_bytes);
    EXPECT_EQ(sched_getcpu(), first);
    char name[16];
    pthread_getname_np(pthread_self(), name, sizeof name);
    EXPECT_EQ(std::string(name), "a_name_that_is_");
  });
}

TEST(ThreadPlacement, WithoutPrivilegesTheOrdinarySchedulerStaysAndTheReasonIsTold) {
  rlimit limit{};
  getrlimit(RLIMIT_RTPRIO, &limit);
  if (limit.rlim_cur > 0) GTEST_SKIP() << "the real-time priority limit is not 0";
  in_own_thread([] {
    give_up_privileges();
    const auto report = place_this_thread(threads::kFilter);
    EXPECT_EQ(report.fifo_priority, 0);
    EXPECT_EQ(report.scheduler_errno, EPERM);
    EXPECT_EQ(policy_of_this_thread(), SCHED_OTHER);
    EXPECT_GT(report.stack_bytes, 0U) << "what is permitted is done";
    const std::string text = placement_text(threads::kFilter, report);
    EXPECT_NE(text.find("SCHED_FIFO 45 was refused (Operation not permitted)"), std::string::npos) << text;
    EXPECT_NE(text.find("lxd-slam doctor"), std::string::npos) << text;
  });
}

TEST(ThreadPlacement, WherePermittedTheThreadRunsUnderFifo) {
  if (!fifo_is_permitted()) GTEST_SKIP() << "SCHED_FIFO is not permitted here";
  in_own_thread([] {
    const auto report = place_this_thread(threads::kInput);
    EXPECT_EQ(report.fifo_priority, threads::kInput.fifo_priority);
    EXPECT_EQ(policy_of_this_thread(), SCHED_FIFO);
  });
}

TEST(ThreadPlacement, CpusThatAreNotThereAreAny) {
  in_own_thread([] {
    const std::uint64_t last = std::uint64_t{1} << 63U;
    const auto report = place_this_thread({.name = "nowhere", .cpus = last});
    if ((report.cpus & last) != 0) GTEST_SKIP() << "this machine has 64 CPUs";
    EXPECT_EQ(report.affinity_errno, EINVAL);
    EXPECT_NE(report.cpus, 0U);
  });
}

TEST(ThreadPlacement, TheProfileIsInTheOrderOfUrgency) {
  for (const ThreadPlacement& thread : threads::kAll) {
    EXPECT_LE(std::string(thread.name).size(), 15U) << thread.name;
    EXPECT_TRUE(thread.fifo_priority == 0 || thread.nice == 0) << thread.name;
  }
  EXPECT_GT(threads::kInput.fifo_priority, threads::kFilter.fifo_priority);
  EXPECT_LT(threads::kFilter.fifo_priority, 50) << "interrupts of PREEMPT_RT must get through";
}

TEST(PlacementText, CpusAreWrittenAsTheKernelDoes) {
  EXPECT_EQ(cpu_list(0), "none");
  EXPECT_EQ(cpu_list(0b1000), "3");
  EXPECT_EQ(cpu_list(0b100111), "0-2,5");
  EXPECT_EQ(cpu_list(~std::uint64_t{0}), "0-63");
}

TEST(PriorityMutexThread, IsALock) {
  PriorityMutex mutex;
  EXPECT_TRUE(mutex.inherits());
  int sum = 0;
  const auto add = [&] {
    for (int i = 0; i < 1000; ++i) {
      const std::lock_guard lock(mutex);
      ++sum;
    }
  };
  std::thread other(add);
  add();
  other.join();
  EXPECT_EQ(sum, 2000);
  const std::lock_guard lock(mutex);
  in_own_thread([&] { EXPECT_FALSE(mutex.try_lock()); });
}

// The kernel's own word on a thread's priority, as it is lent: field 18 of its stat file (-1 - FIFO priority).
int kernel_priority(pid_t thread) {
  std::FILE* const file = std::fopen(("/proc/self/task/" + std::to_string(thread) + "/stat").c_str(), "r");
  if (file == nullptr) return 0;
  int priority = 0;
  (void)std::fscanf(file, "%*d (%*[^)]) %*c %*d %*d %*d %*d %*d %*u %*u %*u %*u %*u %*u %*u %*d %*d %d", &priority);
  std::fclose(file);
  return priority;
}

TEST(PriorityMutexThread, LendsItsHolderTheWaitersUrgency) {
  if (!fifo_is_permitted()) GTEST_SKIP() << "SCHED_FIFO is not permitted here";
  PriorityMutex mutex;
  const pid_t holder = gettid();
  mutex.lock();
  EXPECT_GE(kernel_priority(holder), 0);
  std::thread urgent([&] {
    (void)place_this_thread({.name = "urgent", .fifo_priority = 30});
    const std::lock_guard lock(mutex);
  });
  int lent = 0;
  for (int i = 0; i < 5000 && lent != -31; ++i) {
    lent = kernel_priority(holder);
    usleep(1000);
  }
  mutex.unlock();
  urgent.join();
  EXPECT_EQ(lent, -31);
}

}  // namespace
}  // namespace lxd::rt_thread_placement_test
