// SPDX-License-Identifier: Apache-2.0
// Pulses hold a sensor's clock, live and replayed alike: to the nanosecond the same times, whenever the live rig came
// to read the pulse.
#include <random>

#include <gtest/gtest.h>

#include "board/recording_stream.hpp"
#include "drivers/imu/imu_stream.hpp"
#include "drivers/replay/pps_log.hpp"
#include "drivers/replay/rig_clock.hpp"
#include "drivers/sync/pulse_wire.hpp"
#include "tests/support/temporary_folder.hpp"

namespace lxd::board_recorded_pulses_test {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
const RigTime kStart = RigTime::from_ns(1'700'000'000'300'000'000);
constexpr double kSkew = 80e-6;
constexpr int kRate_hz = 200, kSeconds = 30;

// The sensor's clock began at its start, and runs fast.
std::int64_t sensor_ns(RigTime t) {
  return 5 * kSecond_ns + static_cast<std::int64_t>(static_cast<double>((t - kStart).ns()) * (1 + kSkew));
}
// When it shows a whole second.
RigTime second(std::int64_t number) {
  const auto since = static_cast<double>(number * kSecond_ns - 5 * kSecond_ns) / (1 + kSkew);
  return kStart + Duration::from_ns(static_cast<std::int64_t>(since));
}

struct Heard {
  RigTime truth;
  ImuSample sample;
};

// Stamps reach the host 3 ms late and more.
std::vector<Heard> samples() {
  std::mt19937 random(7);
  std::exponential_distribution<double> delay(1e3);
  std::vector<Heard> all;
  for (int i = 0; i < kRate_hz * kSeconds; ++i) {
    Heard heard{kStart + Duration::from_ns(i * (kSecond_ns / kRate_hz)), {}};
    heard.sample.sensor_ns = sensor_ns(heard.truth);
    heard.sample.t = heard.sample.received = heard.truth + Duration::from_seconds(3e-3 + delay(random));
    all.push_back(heard);
  }
  return all;
}

std::vector<std::uint8_t> count_bytes(std::uint32_t sequence) {
  return {static_cast<std::uint8_t>(sequence), static_cast<std::uint8_t>(sequence >> 8U),
          static_cast<std::uint8_t>(sequence >> 16U), static_cast<std::uint8_t>(sequence >> 24U)};
}

class RecordedPulses : public testing::Test {
 protected:
  RecordedPulses() {
    rig_.pps.emplace().device = "/dev/pps0";
    auto file = create_chunk_file(LiveChannel::pps, rig_, folder_.path());
    EXPECT_TRUE(file) << file.error().message;
    stream_.emplace(LiveChannel::pps, std::move(*file));
  }
  void pulse(RigTime edge, std::uint32_t sequence, ImuClock& clock) {
    const auto bytes = count_bytes(sequence);
    const Chunk chunk{edge, {}, 0, bytes};
    stream_->put(chunk);
    EXPECT_TRUE(stream_->write());
    if (const auto read = reader_.read(chunk)) clock.add_pulse(read->edge);
  }

  test::TemporaryFolder folder_;
  Rig rig_;
  std::optional<RecordingStream> stream_;
  PulseReader reader_{GpioEdge::rising};
};

TEST_F(RecordedPulses, GiveTheSameTimesLiveAndReplayedAndTrueOnes) {
  ImuClock live, alone;
  std::vector<RigTime> heard;
  double error_s = 0, error_alone_s = 0;
  std::int64_t next = 6;
  std::mt19937 random(3);
  for (auto& [truth, sample] : samples()) {
    // The source is asked up to a tenth of a second after its pulse.
    const Duration read_after = Duration::from_ns(static_cast<std::int64_t>(random() % 100'000'000));
    if (second(next) + read_after <= sample.received) {
      if (next != 17) pulse(second(next), static_cast<std::uint32_t>(next), live);  // one is lost
      ++next;
    }
    ImuSample by_pulses = sample, by_arrival = sample;
    ASSERT_TRUE(live.place(by_pulses));
    ASSERT_TRUE(alone.place(by_arrival));
    heard.push_back(by_pulses.t);
    if ((truth - kStart).seconds() < 10) continue;
    error_s = std::max(error_s, std::abs((by_pulses.t - truth).seconds()));
    error_alone_s = std::max(error_alone_s, std::abs((by_arrival.t - truth).seconds()));
  }
  EXPECT_LT(error_s, 50e-6);
  EXPECT_GT(error_alone_s, 2e-3) << "nothing tells the least latency without pulses";

  stream_->close();
  auto pulses = recorded_pulses(folder_.path(), true);
  ASSERT_TRUE(pulses) << pulses.error().message;
  EXPECT_EQ(pulses->size(), static_cast<std::size_t>(next - 7));
  ImuClock replayed(std::move(*pulses));
  std::size_t i = 0;
  for (auto& [truth, sample] : samples()) {
    ASSERT_TRUE(replayed.place(sample));
    ASSERT_EQ(sample.t, heard[i++]);
  }
}

// A LiDAR's clock likewise; one that does not count the pulses is left alone.
TEST_F(RecordedPulses, HoldALidarsClockThatGoesByThem) {
  std::vector<RigTime> pulses;
  for (std::int64_t number = 6; number < 30; ++number) pulses.push_back(second(number));
  RigClock by_pulses({}, pulses), by_arrival({});
  for (const auto& [truth, sample] : samples()) {
    by_pulses.observe(*sample.sensor_ns, sample.received);
    by_arrival.observe(*sample.sensor_ns, sample.received);
  }
  const RigTime end = kStart + Duration::from_seconds(kSeconds);
  const RigTime stamp = RigTime::from_ns(sensor_ns(end));
  EXPECT_LT(std::abs((*by_pulses.rig_time(stamp) - end).seconds()), 50e-6);
  EXPECT_GT((*by_arrival.rig_time(stamp) - end).seconds(), 2e-3);
  EXPECT_EQ(by_pulses.counts().edges, 22U) << "all but the first two, with which the third locks it";
  EXPECT_EQ(by_pulses.counts().glitches, 0U);
}

TEST_F(RecordedPulses, CountOnWhenTheSourceCountsAnew) {
  ImuClock clock;
  for (const std::uint32_t sequence : {40U, 41U, 43U, 1U, 2U})
    pulse(kStart + Duration::from_seconds(sequence), sequence, clock);
  stream_->close();
  const auto log = read_pps_log(folder_.path() / kPpsLogFile);
  ASSERT_TRUE(log) << log.error().message;
  std::vector<std::uint32_t> counts;
  for (const PpsEdge& edge : log->edges) counts.push_back(edge.sequence);
  EXPECT_EQ(counts, (std::vector<std::uint32_t>{1, 2, 4, 5, 6}));
  EXPECT_EQ(log->lost, 1U);
}

TEST_F(RecordedPulses, OfAGpioLineAreItsRisingEdges) {
  const std::vector<std::uint8_t> rising{1}, falling{2};
  EXPECT_TRUE(reader_.read({kStart, {}, 0, rising}));
  EXPECT_FALSE(reader_.read({kStart, {}, 0, falling}));
  EXPECT_EQ(reader_.read({kStart, {}, 0, rising})->sequence, 2U);
}

}  // namespace
}  // namespace lxd::board_recorded_pulses_test
