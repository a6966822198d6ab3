// SPDX-License-Identifier: Apache-2.0
// The IMU of a recording, read back from its bytes.
#include <cmath>
#include <fstream>

#include <gtest/gtest.h>

#include "tests/support/imu_integration.hpp"
#include "tests/support/simulated_imu.hpp"
#include "tools/simulator/imu/imu_model.hpp"

namespace lxd::sim::simulator_imu_writer_test {
namespace {

using test::SimulatedImu;

constexpr double kDegree = std::numbers::pi / 180;

std::vector<std::string> lines_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

// Of all chunks of the file: bytes and receive times.
struct Delivery {
  std::size_t longest = 0, count = 0, whole_frames_only = 0;
  bool ordered = true;
};
Delivery delivery_of(const std::filesystem::path& path, std::size_t frame_bytes) {
  auto log = SerialLog::open(path);
  EXPECT_TRUE(log.ok());
  Delivery delivery;
  SerialChunk chunk;
  Rejections rejected;
  for (std::size_t total = 0; log->next(chunk, rejected); ++delivery.count) {
    total += chunk.bytes.size();
    delivery.longest = std::max(delivery.longest, chunk.bytes.size());
    if (total % frame_bytes == 0) ++delivery.whole_frames_only;
  }
  delivery.ordered = rejected.empty();
  return delivery;
}

TEST(SimulatorImuRecording, ReadsBackAsTheModelMeasuredIt) {
  SimulatedImu rig(2);
  const ImuWritten written = rig.write();
  const auto samples = rig.read();
  ASSERT_EQ(samples.size(), 401U);
  EXPECT_EQ(written.samples, 401U);
  EXPECT_EQ(written.bytes, 401U * 38);
  EXPECT_TRUE(rig.rejected.empty());
  ImuModel model(rig.config, rig.motion, rig.seed, "imu");
  for (const ImuSample& sample : samples) {
    const ImuModelSample wanted = model.next();
    EXPECT_EQ(sample.sensor_ns, rig.context().rig_time(wanted.t_s).ns());
    EXPECT_LT((sample.gyro_radps - wanted.measured.gyro_radps).norm(), 1e-6);
    EXPECT_LT((sample.accel_mps2 - wanted.measured.accel_mps2).norm(), 2e-6);
  }
}

TEST(SimulatorImuRecording, BytesOfASensorWithoutErrorsIntegrateToTheMotion) {
  SimulatedImu rig(10);
  rig.config = without_errors(rig.config);
  rig.config.T_body_sensor.p = {0.1, 0.05, -0.2};
  (void)rig.write();
  std::vector<Inertial> samples;
  for (const ImuSample& sample : rig.read()) samples.push_back({sample.gyro_radps, sample.accel_mps2});
  ASSERT_EQ(samples.size(), 2001U);
  test::DeadReckoning state = test::true_sensor_state(rig.motion, rig.config.T_body_sensor, 0);
  for (std::size_t k = 0; k + 2 < samples.size(); k += 2) {
    state = test::integrated(state, std::span(samples).subspan(k).first<3>(), 1 / rig.config.update_rate);
    if (k % 200 != 0) continue;  // all the way, not only at its end
    const auto truth = test::true_sensor_state(rig.motion, rig.config.T_body_sensor,
                                               static_cast<double>(k + 2) / rig.config.update_rate);
    EXPECT_LT((state.p_m - truth.p_m).norm(), 1e-3);
    EXPECT_LT(state.q_world_sensor.angularDistance(truth.q_world_sensor), 0.01 * kDegree);
  }
}

TEST(SimulatorImuRecording, AWitMotionReadsBackWithinItsNumberFormat) {
  SimulatedImu rig(2);
  rig.config = without_errors(rig.config);
  rig.config.protocol = ImuProtocol::kWitMotion;
  const ImuWritten written = rig.write();
  const auto samples = rig.read();
  ASSERT_EQ(samples.size(), 401U);
  EXPECT_EQ(written.bytes, 401U * 33);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const double t_s = static_cast<double>(k) / rig.config.update_rate;
    const Inertial truth = true_inertial(rig.motion, {}, t_s);
    EXPECT_LE((samples[k].gyro_radps - truth.gyro_radps).cwiseAbs().maxCoeff(), 0.51 * kWitMotionRateUnit_radps);
    EXPECT_LE((samples[k].accel_mps2 - truth.accel_mps2).cwiseAbs().maxCoeff(), 0.51 * kWitMotionAccelUnit_mps2);
    EXPECT_NEAR(static_cast<double>(*samples[k].sensor_ns - rig.context().rig_time(t_s).ns()), -0.5e6, 0.5e6);
  }
}

// Given any protocol, then a recording gives back what the model measured, to the steps of the protocol's numbers.
TEST(SimulatorImuRecording, EveryProtocolReadsBack) {
  for (const std::string_view name : kImuProtocolNames) {
    SimulatedImu rig(1);
    rig.config = without_errors(rig.config);
    rig.config.protocol = *find_imu_protocol(name);
    rig.config.line.baud_rate = 921'600;
    if (rig.config.protocol == ImuProtocol::kXsens) rig.config.clock.offset_s = -1'767'268'000;  // since power-up
    (void)rig.write();
    const auto samples = rig.read();
    ASSERT_EQ(samples.size(), 201U) << name;
    for (std::size_t k = 0; k < samples.size(); ++k) {
      const Inertial truth = true_inertial(rig.motion, {}, static_cast<double>(k) / rig.config.update_rate);
      EXPECT_LT((samples[k].gyro_radps - truth.gyro_radps).cwiseAbs().maxCoeff(), 0.51 * kWitMotionRateUnit_radps);
      EXPECT_LT((samples[k].accel_mps2 - truth.accel_mps2).cwiseAbs().maxCoeff(), 0.51 * kWitMotionAccelUnit_mps2);
    }
  }
}

// Given an Xsens whose clock has run for more than its counter can say, then the scenario is refused, with the bounds.
TEST(SimulatorImuRecording, AClockBeyondAProtocolsCounterIsRefused) {
  SimulatedImu rig(1);
  rig.config.protocol = ImuProtocol::kXsens;
  const Status sound = check_imu(rig.context(), rig.config);
  ASSERT_FALSE(sound.ok());
  EXPECT_NE(sound.error().message.find("wanted 0 to 429496 s"), std::string::npos) << sound.error().message;
}

// Given a port that knows nothing of frames, then its pieces do not end where frames do, and times hold all the same.
TEST(SimulatorImuRecording, PiecesAreThoseOfAPort) {
  for (const double timer_s : {1e-3, 16e-3}) {
    SimulatedImu rig(5);
    rig.config.clock.latency_s = 0.5e-3;
    rig.config.clock.latency_jitter_s = 0.2e-3;
    rig.config.line.chunk_timer_s = timer_s;
    (void)rig.write();
    const Delivery delivery = delivery_of(rig.folder / kImuSerialFile, 38);
    EXPECT_TRUE(delivery.ordered);
    EXPECT_LE(delivery.longest, 62U);
    EXPECT_LT(delivery.whole_frames_only, delivery.count / 2);
    double least_s = 1, most_s = 0;
    const auto samples = rig.read();
    for (std::size_t k = 0; k < samples.size(); ++k) {
      const RigTime sampled = rig.context().rig_time(static_cast<double>(k) / rig.config.update_rate);
      const double late_s = (samples[k].t - sampled).seconds();
      least_s = std::min(least_s, late_s);
      most_s = std::max(most_s, late_s);
      EXPECT_GT((samples[k].received - sampled).seconds(), 38 * 10 / rig.config.line.baud_rate);
    }
    EXPECT_GE(least_s, 0.5e-3);
    EXPECT_LT(least_s, 1.5e-3);
    EXPECT_LT(most_s, timer_s + 4e-3);
  }
}

TEST(SimulatorImuRecording, TheSensorsClockIsItsOwn) {
  SimulatedImu rig(10);
  rig.config.clock.offset_s = -1'767'268'000;
  rig.config.clock.skew_ppm = 100;
  (void)rig.write();
  const auto samples = rig.read();
  ASSERT_EQ(samples.size(), 2001U);
  EXPECT_EQ(samples.front().sensor_ns, 800 * kNanosPerSecond);
  // By its own clock every period is 5 ms; ten seconds of the host are 1 ms more of them.
  for (std::size_t k = 0; k < samples.size(); ++k)
    EXPECT_NEAR(static_cast<double>(*samples[k].sensor_ns - 800 * kNanosPerSecond), 5e6 * static_cast<double>(k), 2);
}

TEST(SimulatorImuRecording, SameSeedSameBytes) {
  SimulatedImu rig(1);
  rig.config.clock.jitter_s = 1e-4;
  rig.config.clock.latency_jitter_s = 1e-4;
  (void)rig.write();
  const std::string first = test::read_file(rig.folder / kImuSerialFile);
  (void)rig.write();
  EXPECT_EQ(test::read_file(rig.folder / kImuSerialFile), first);
  rig.seed = 2;
  (void)rig.write();
  EXPECT_NE(test::read_file(rig.folder / kImuSerialFile), first);
}

TEST(SimulatorImuRecording, TheTruthOfTheBiasesIsBesideIt) {
  SimulatedImu rig(2);
  (void)rig.write();
  const auto lines = lines_of(rig.folder / kImuTruthFile);
  ASSERT_EQ(lines.size(), 22U);  // a header, and 10 a second with both ends
  ImuModel model(rig.config, rig.motion, rig.seed, "imu");
  const ImuModelSample first = model.next();
  double t_s = 0, gx = 0;
  ASSERT_EQ(std::sscanf(lines[1].c_str(), "%lf,%lf", &t_s, &gx), 2);
  EXPECT_EQ(lines[1].substr(0, 20), "1767268800.000000000");
  EXPECT_NEAR(gx, first.bias.gyro_radps.x(), 1e-12);
}

TEST(SimulatorImuRecording, AGenericFolderHasItsSamplesAsText) {
  SimulatedImu rig(1);
  rig.config.clock.offset_s = -1000;  // not the text's: it is on the rig's clock
  const ImuWritten written = rig.write({.serial = false, .generic = true});
  EXPECT_EQ(written.samples, 201U);
  EXPECT_FALSE(std::filesystem::exists(rig.folder / kImuSerialFile));
  const auto lines = lines_of(rig.folder / kImuCsvFile);
  ASSERT_EQ(lines.size(), 202U);
  EXPECT_EQ(lines[0], "t,gx,gy,gz,ax,ay,az");
  EXPECT_EQ(lines[2].substr(0, 21), "1767268800.005000000,");
}

}  // namespace
}  // namespace lxd::sim::simulator_imu_writer_test
