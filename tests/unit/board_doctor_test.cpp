// SPDX-License-Identifier: Apache-2.0
// The doctor, before made-up machines: folders with the kernel's files in them.
#include <algorithm>
#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

#include "board/default/capacities.hpp"
#include "board/default/threads.hpp"
#include "board/doctor/diagnosis.hpp"
#include "tests/support/temporary_folder.hpp"

namespace lxd::board_doctor_test {
namespace {

namespace fs = std::filesystem;

class Doctor : public testing::Test {
 protected:
  void SetUp() override { be_a_good_board(); }

  void say(const std::string& path, const std::string& content) {
    const fs::path file = machine_ / path;
    fs::create_directories(file.parent_path());
    test::write_file(file, content + "\n");
  }
  void limits(const std::string& locked, const std::string& priority) {
    say("proc/self/limits",
        "Limit                     Soft Limit           Hard Limit           Units     \n"
        "Max locked memory         " +
            locked +
            "              unlimited            bytes     \n"
            "Max realtime priority     " +
            priority + "                   99                   ");
  }
  void status(const std::string& uid, const std::string& groups, const std::string& capabilities) {
    say("proc/self/status", "Name:\tlxd-slam\nUid:\t" + uid + "\t0\t0\t0\nGid:\t1000\t1000\t1000\t1000\nGroups:\t" +
                                groups + " \nCapInh:\t0000000000000000\nCapEff:\t" + capabilities);
  }
  void cpu(int number, const std::string& governor) {
    const std::string folder = "sys/devices/system/cpu/cpu" + std::to_string(number);
    say(folder + "/cpufreq/scaling_governor", governor);
  }
  void idle_state(int number, const std::string& name, int latency_us, bool disabled) {
    const std::string folder = "sys/devices/system/cpu/cpu0/cpuidle/state" + std::to_string(number);
    say(folder + "/name", name);
    say(folder + "/latency", std::to_string(latency_us));
    say(folder + "/disable", disabled ? "1" : "0");
  }

  void be_a_good_board() {
    say("proc/sys/kernel/osrelease", "6.12.9-rt-arm64");
    say("proc/version", "Linux version 6.12.9-rt-arm64 (gcc) #1 SMP PREEMPT_RT Debian");
    say("proc/sys/net/core/rmem_max", "8388608");
    say("proc/sys/kernel/sched_rt_runtime_us", "950000");
    say("proc/meminfo", "MemTotal:        8000000 kB\nMemAvailable:    6000000 kB");
    limits("unlimited", "95");
    status("1000", "20 44 46 997", "0000000000000000");
    say("etc/group", "root:x:0:\nxdialout:x:1:\ndialout:x:20:rig\nvideo:x:44:rig\nplugdev:x:46:\ngpio:x:997:");
    for (int i = 0; i < 4; ++i) cpu(i, "performance");
    say("sys/devices/system/cpu/online", "0-3");
    say("sys/devices/system/cpu/isolated", "3");
    say("sys/devices/system/clocksource/clocksource0/current_clocksource", "arch_sys_counter");
    say("sys/kernel/mm/transparent_hugepage/enabled", "always [madvise] never");
    idle_state(0, "WFI", 1, false);
    idle_state(1, "cpu-sleep", 900, true);
    say("dev/pps0", "");
  }

  [[nodiscard]] std::vector<Finding> findings() const {
    return diagnose(read_machine_facts(machine_.path()), needs_of_this_profile());
  }
  [[nodiscard]] Finding finding(const std::string& subject) const {
    const auto all = findings();
    const auto found = std::ranges::find(all, subject, &Finding::subject);
    EXPECT_NE(found, all.end()) << subject;
    return found == all.end() ? Finding{} : *found;
  }
  // Says of this subject what is wanted, and how to mend it; all else is good.
  void expect_only(Verdict verdict, const std::string& subject, const std::string& found, const std::string& mend) {
    for (const Finding& each : findings()) {
      EXPECT_EQ(each.verdict, each.subject == subject ? verdict : Verdict::good) << each.subject << ": " << each.found;
      EXPECT_EQ(each.mend.empty(), each.verdict == Verdict::good) << each.subject;
    }
    EXPECT_NE(finding(subject).found.find(found), std::string::npos) << finding(subject).found;
    EXPECT_NE(finding(subject).mend.find(mend), std::string::npos) << finding(subject).mend;
  }

  test::TemporaryFolder machine_;
};

TEST_F(Doctor, FindsNothingOnABoardThatIsSetUp) {
  for (const Finding& each : findings()) EXPECT_EQ(each.verdict, Verdict::good) << each.subject << ": " << each.found;
  EXPECT_NE(diagnosis_text(findings()).find("0 lacking, 0 advised"), std::string::npos);
}

TEST_F(Doctor, SeesSmallSocketBuffers) {
  say("proc/sys/net/core/rmem_max", "212992");
  expect_only(Verdict::lack, "socket buffers", "rmem_max 212992; wanted at least 8388608",
              "sysctl -w net.core.rmem_max=8388608");
}

TEST_F(Doctor, SeesLimitsThatAreTooLow) {
  limits("65536", "95");
  expect_only(Verdict::lack, "locked memory", "limit 65536 bytes", "limits.d");
  limits("unlimited", "50");
  expect_only(Verdict::lack, "real-time priority", "limit 50; wanted at least 90", "limits.d");
}

TEST_F(Doctor, CapabilitiesStandForLimits) {
  limits("65536", "0");
  status("1000", "20 44 46 997", "0000000000804000");  // CAP_SYS_NICE and CAP_IPC_LOCK
  EXPECT_EQ(finding("locked memory").verdict, Verdict::good);
  EXPECT_EQ(finding("real-time priority").verdict, Verdict::good);
}

TEST_F(Doctor, SeesKernelsThatAreNotForRealTimeOrTooOld) {
  say("proc/version", "Linux version 6.1.0-18-amd64 (gcc) #1 SMP PREEMPT_DYNAMIC Debian");
  expect_only(Verdict::advice, "kernel", "without PREEMPT_RT", "linux-image-rt");
  say("proc/sys/kernel/osrelease", "5.10.0-28-amd64");
  expect_only(Verdict::lack, "kernel", "5.10.0-28-amd64; wanted 5.14", "kernel");
  say("proc/sys/kernel/osrelease", "4.99.0");
  EXPECT_EQ(finding("kernel").verdict, Verdict::lack);
}

TEST_F(Doctor, SeesOneSlowCpuOfFour) {
  cpu(2, "schedutil");
  expect_only(Verdict::lack, "CPU frequency", "governor schedutil on 1 of 4 CPUs", "performance");
}

TEST_F(Doctor, SeesWhatIdleHugePagesAndClockCost) {
  idle_state(1, "cpu-sleep", 900, false);
  expect_only(Verdict::advice, "idle states", "cpu-sleep wakes in 900 us", "cpupower idle-set -D 100");
  idle_state(1, "cpu-sleep", 900, true);
  say("sys/kernel/mm/transparent_hugepage/enabled", "[always] madvise never");
  expect_only(Verdict::advice, "huge pages", "always", "madvise");
  say("sys/kernel/mm/transparent_hugepage/enabled", "always madvise [never]");
  say("sys/devices/system/clocksource/clocksource0/current_clocksource", "hpet");
  expect_only(Verdict::lack, "clock source", "hpet", "clocksource=tsc");
}

TEST_F(Doctor, SeesASmallBoard) {
  say("sys/devices/system/cpu/isolated", "");
  expect_only(Verdict::advice, "CPUs", "none isolated", "isolcpus=3");
  fs::remove_all(machine_ / "sys/devices/system/cpu/cpu3");
  expect_only(Verdict::advice, "CPUs", "wanted 4", "board");
  say("sys/devices/system/cpu/cpu3/online", "1");
  say("sys/devices/system/cpu/isolated", "3");
  say("proc/meminfo", "MemAvailable:    1000 kB");
  expect_only(Verdict::lack, "memory", "1024000 bytes available", "budget");
}

TEST_F(Doctor, SeesWithoutPulsesAndWithoutRights) {
  fs::remove(machine_ / "dev/pps0");
  expect_only(Verdict::advice, "pulse per second", "no /dev/pps*", "pps-gpio");
  say("dev/pps0", "");
  status("1000", "20 46 997", "0000000000000000");
  expect_only(Verdict::lack, "group video", "not a member", "adduser $USER video");
  status("0", "0", "0000000000000000");
  EXPECT_EQ(finding("group video").verdict, Verdict::good);
  status("1000", "20 44 46", "0000000000000000");
  say("etc/group", "dialout:x:20:\nvideo:x:44:\nplugdev:x:46:");
  expect_only(Verdict::advice, "group gpio", "does not exist", "groupadd --system gpio");
}

TEST_F(Doctor, SurvivesAMachineThatSaysNothing) {
  const test::TemporaryFolder* const emptied = &machine_;
  for (const auto& entry : fs::directory_iterator(emptied->path())) fs::remove_all(entry);
  EXPECT_EQ(finding("socket buffers").verdict, Verdict::lack);
  EXPECT_EQ(finding("kernel").verdict, Verdict::lack);
  EXPECT_EQ(finding("group dialout").verdict, Verdict::advice);
}

// The files that the product brings mend what the doctor finds.
TEST(SystemFiles, GiveWhatTheDoctorWants) {
  const fs::path folder = fs::path(LXD_TEST_DATA) / "../../board/system";
  const MachineNeeds needs = needs_of_this_profile();
  const std::string sysctl = test::read_file(folder / "60-lxd-slam-sysctl.conf");
  EXPECT_NE(sysctl.find("net.core.rmem_max = " + std::to_string(needs.receive_buffer_bytes) + "\n"), std::string::npos);
  const auto number_behind = [](const std::string& text, const std::string& key) {
    const auto at = text.find(key);
    return at == std::string::npos ? 0UL : std::stoul(text.substr(at + key.size()));
  };
  EXPECT_GE(number_behind(test::read_file(folder / "60-lxd-slam-limits.conf"), " rtprio "), needs.real_time_priority);
  EXPECT_GE(number_behind(test::read_file(folder / "lxd-slam@.service.in"), "\nLimitRTPRIO="),
            needs.real_time_priority);
}

// What systemd says of the unit, once its program is one that is there.
TEST(SystemFiles, TheUnitIsSound) {
  if (std::system("command -v systemd-analyze > /dev/null") != 0) GTEST_SKIP() << "systemd-analyze is missing";
  const test::TemporaryFolder folder;
  std::string unit = test::read_file(fs::path(LXD_TEST_DATA) / "../../board/system/lxd-slam@.service.in");
  const std::string program = "@CMAKE_INSTALL_FULL_BINDIR@/lxd-slam";
  ASSERT_NE(unit.find(program), std::string::npos);
  unit.replace(unit.find(program), program.size(), "/bin/true");
  test::write_file(folder / "lxd-slam@hall.service", unit);
  const std::string verdict = (folder / "verdict").string();
  const std::string command = "systemd-analyze verify " + (folder / "lxd-slam@hall.service").string() + " > " + verdict;
  EXPECT_EQ(std::system((command + " 2>&1").c_str()), 0);
  EXPECT_EQ(test::read_file(verdict), "");
}

}  // namespace
}  // namespace lxd::board_doctor_test
