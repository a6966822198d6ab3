// SPDX-License-Identifier: Apache-2.0
// Pulses and edges from a made kernel: each given once, what is missed counted, pulled out and back; and they hold a
// sensor's clock.
#include <cerrno>
#include <cstring>

#include <gtest/gtest.h>
#include <linux/pps.h>

#include "drivers/sync/clock_model.hpp"
#include "drivers/sync/gpio_edges.hpp"
#include "drivers/sync/libgpiod_line.hpp"
#include "drivers/sync/pps_source.hpp"
#include "tests/support/made_pps.hpp"

namespace lxd::drivers_sync_devices_test {
namespace {

using test::MadePps;

constexpr std::int64_t kMillisecond_ns = 1'000'000;

class Pps : public testing::Test {
 protected:
  void tend() { source_.tend(now_ = now_ + Duration::from_seconds(3)); }

  HostClock clock_;
  MadePps kernel_;
  PpsSource source_{"/dev/pps0", PpsSource::Edge::assert, clock_, kernel_};
  RigTime now_ = RigTime::from_ns(0);
};

TEST_F(Pps, GivesEachPulseOnceWithItsStamp) {
  kernel_.pulse(clock_.now());  // before we came
  tend();
  EXPECT_FALSE(source_.fetch(Duration::from_ns(0)));
  const RigTime edge = clock_.now();
  kernel_.pulse(edge);
  const auto pulse = source_.fetch(Duration::from_ns(0));
  ASSERT_TRUE(pulse);
  EXPECT_EQ(pulse->sequence, 2U);
  EXPECT_LT(std::abs((pulse->edge - edge).ns()), kMillisecond_ns);
  EXPECT_FALSE(source_.fetch(Duration::from_ns(0))) << "the same pulse";
  EXPECT_FALSE(source_.fetch(Duration::from_ns(kMillisecond_ns))) << "none came while it waited";
  EXPECT_TRUE(source_.there());
}

TEST_F(Pps, CountsWhatNobodyAskedForAndLeavesOutWhatHasNoStamp) {
  tend();
  for (int i = 0; i < 4; ++i) kernel_.pulse(clock_.now());
  EXPECT_TRUE(source_.fetch(Duration::from_ns(0)));
  EXPECT_EQ(source_.counts().missed, 3U);
  kernel_.pulse(RigTime::from_ns(0));
  EXPECT_FALSE(source_.fetch(Duration::from_ns(0)));
  EXPECT_EQ(source_.counts().unsound, 1U);
  EXPECT_EQ(source_.counts().pulses, 1U);
}

TEST_F(Pps, ComesBackAndBeginsItsCountAnew) {
  tend();
  kernel_.present = false;
  EXPECT_FALSE(source_.fetch(Duration::from_ns(0)));
  EXPECT_EQ(source_.trouble(), "/dev/pps0: No such device");
  EXPECT_EQ(kernel_.open_files, 0);
  tend();
  EXPECT_FALSE(source_.there());
  kernel_.present = true;
  kernel_.sequence = 100;
  tend();
  kernel_.pulse(clock_.now());
  EXPECT_TRUE(source_.fetch(Duration::from_ns(0)));
  EXPECT_EQ(source_.counts().missed, 0U);
  EXPECT_EQ(source_.counts().departures, 1U);
}

TEST_F(Pps, AsksForTheEdgeAndSaysWhenThereIsNoSuch) {
  PpsSource falling("/dev/pps0", PpsSource::Edge::clear, clock_, kernel_);
  falling.tend(now_);
  EXPECT_EQ(falling.trouble().find("/dev/pps0: found abilities 0x1101, wanted to stamp the clear edge"), 0U)
      << falling.trouble();
  kernel_.able |= PPS_CAPTURECLEAR;
  falling.tend(now_ + Duration::from_seconds(3));
  EXPECT_TRUE(falling.there());
  EXPECT_NE(kernel_.mode & PPS_CAPTURECLEAR, 0);
}

TEST_F(Pps, HoldsASensorsClock) {
  tend();
  ClockModel model({});
  // A sensor 40 s behind; its packets take 2 ms, which the pairs alone cannot know.
  const Duration behind = Duration::from_seconds(40);
  const RigTime begin = RigTime::from_ns((clock_.now().ns() / kNanosPerSecond - 8) * kNanosPerSecond);
  for (int i = 0; i < 70; ++i) {
    const RigTime t = begin + Duration::from_ns(i * 100 * kMillisecond_ns);
    (void)model.add((t - behind).ns(), t + Duration::from_ns(2 * kMillisecond_ns));
    if (i % 10 == 5) kernel_.pulse(RigTime::from_ns(t.ns() - t.ns() % kNanosPerSecond));
    if (const auto pulse = source_.fetch(Duration::from_ns(0))) (void)model.add_edge(pulse->edge);
  }
  EXPECT_TRUE(model.pulse_locked());
  EXPECT_EQ(source_.counts().pulses, 7U);
  const RigTime end = begin + Duration::from_seconds(7);
  EXPECT_LT(std::abs((model.to_rig((end - behind).ns()) - end).ns()), kMillisecond_ns);
}

class MadeChip final : public GpioApi {
 public:
  bool present = true;
  std::vector<GpioEvent> waiting;
  int held = 0;

  int request(const std::string&, unsigned) override {
    if (!present) return errno = ENOENT, -1;
    ++held;
    return 1000;
  }
  int read(int, std::span<GpioEvent> events) override {
    if (!present) return errno = ENODEV, -1;
    if (waiting.empty()) return errno = EAGAIN, -1;
    const std::size_t count = std::min(events.size(), waiting.size());
    std::copy_n(waiting.begin(), count, events.begin());
    waiting.erase(waiting.begin(), waiting.begin() + static_cast<std::ptrdiff_t>(count));
    return static_cast<int>(count);
  }
  void release() override { held = 0; }
};

class EdgeSink final : public ChunkSink {
 public:
  void take(const Chunk& chunk) override {
    stamps.push_back(chunk.received);
    edges.push_back(static_cast<GpioEdge>(chunk.bytes[0]));
  }
  std::vector<RigTime> stamps;
  std::vector<GpioEdge> edges;
};

TEST(Gpio, GivesEdgesWithTheKernelsStampsAndComesBack) {
  const HostClock clock;
  MadeChip chip;
  GpioEdges line({.chip = "gpiochip0", .line = 6, .channel = 1}, clock, chip);
  line.tend(RigTime::from_ns(0));
  EXPECT_EQ(line.fd(), 1000);
  chip.waiting = {{5'000, true}, {6'000, false}};
  EdgeSink sink;
  line.read(sink);
  line.read(sink);
  EXPECT_EQ(sink.edges, (std::vector{GpioEdge::rising, GpioEdge::falling}));
  EXPECT_EQ(sink.stamps[0], clock.of_monotonic(5'000));
  chip.present = false;
  line.read(sink);
  EXPECT_EQ(line.fd(), -1);
  EXPECT_EQ(chip.held, 0);
  EXPECT_EQ(line.trouble(), "gpiochip0 line 6: No such device");
  line.tend(RigTime::from_ns(0) + Duration::from_seconds(1));
  EXPECT_EQ(line.trouble(), "gpiochip0 line 6: cannot be had: No such file or directory");
  chip.present = true;
  line.tend(RigTime::from_ns(0) + Duration::from_seconds(9));
  EXPECT_EQ(line.counts().openings, 2U);
}

TEST(Gpio, AChipThatIsNotThereIsTold) {
  LibgpiodLine line;
  EXPECT_EQ(line.request("no_such_chip", 0), -1);
  EXPECT_NE(errno, 0);
}

}  // namespace
}  // namespace lxd::drivers_sync_devices_test
