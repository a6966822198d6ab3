// SPDX-License-Identifier: Apache-2.0
// A simulated Ouster, read back by the product's own parsers: every point where the surface is.
#include <cmath>
#include <cstring>

#include "drivers/ouster/imu_parser.hpp"
#include "drivers/ouster/xyz_table.hpp"
#include "drivers/replay/open.hpp"
#include "tests/support/decoded_ouster.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/simulator/lidar/ouster_metadata.hpp"

namespace lxd::test::simulator_ouster_test {
namespace {

using namespace sim;

struct Accuracy {
  const char* product;
  const char* profile;
  double worst_m;  // half a unit of the format, and what float costs
};

class SimulatedOusterPoints : public testing::TestWithParam<Accuracy> {};

TEST_P(SimulatedOusterPoints, LieOnTheSurfaceAtTheirOwnTime) {
  // given a sensor without errors that moves and turns
  LidarRig rig(0.3);
  OusterConfig config = small_ouster();
  config.product = GetParam().product;
  config.returns = without_errors(default_returns(config.product));
  config.profile = GetParam().profile;
  config.T_body_sensor = rig.T_body_sensor;
  const TemporaryFolder folder;
  // when its capture is decoded
  const LidarLog log = must_write(rig, config, folder.path());
  const DecodedOuster decoded = decode_ouster(folder / "lidar0.pcap");
  // then each point, taken to the world with the true pose at its own time, is on the surface
  const OusterXyzTable table(decoded.metadata);
  double worst_m = 0;
  for (const DecodedOuster::Pixel& pixel : decoded.pixels) {
    ASSERT_GT(pixel.range_mm, 0U);  // the hall is closed and lies within range
    const double t_s = Duration::from_ns(pixel.stamp_ns - rig.context.start.ns()).seconds();
    const auto p = table.point(pixel.column * config.beams + pixel.row, pixel.range_mm);
    worst_m = std::max(worst_m, surface_distance_m(rig.world, rig.to_world(t_s, p.cast<double>())));
  }
  EXPECT_EQ(decoded.pixels.size(), 3U * 512 * 16);
  EXPECT_EQ(log.returns, decoded.pixels.size());
  EXPECT_LT(worst_m, GetParam().worst_m);
  RecordProperty("worst_um", static_cast<int>(worst_m * 1e6));
}

INSTANTIATE_TEST_SUITE_P(Formats, SimulatedOusterPoints,
                         testing::Values(Accuracy{"OS1", "LEGACY", 0.00052}, Accuracy{"OS0", "LEGACY", 0.00052},
                                         Accuracy{"OS1", "RNG19_RFL8_SIG16_NIR16", 0.00052},
                                         Accuracy{"OS0", "RNG19_RFL8_SIG16_NIR16", 0.00052},
                                         Accuracy{"OS1", "RNG15_RFL8_NIR8", 0.00402}),
                         [](const auto& param) {
                           return std::string(param.param.product) + std::string(param.param.profile).substr(0, 5);
                         });

TEST(SimulatedOuster, MetadataOfEveryModelIsAccepted) {
  for (const auto product : kOusterProducts) {
    for (const std::uint32_t beams : {16U, 32U, 64U, 128U}) {
      for (const auto profile : kOusterSimulatedProfiles) {
        OusterConfig config;
        config.product = product;
        config.beams = beams;
        config.profile = profile;
        const auto metadata = ouster_metadata(config, 3);
        ASSERT_TRUE(metadata.ok()) << metadata.error().message;
        EXPECT_TRUE(metadata->notes.empty()) << metadata->notes.front();  // nothing was left to assume
        EXPECT_EQ(metadata->format.profile->name, profile);
        EXPECT_EQ(metadata->altitude_rad.size(), beams);
        EXPECT_EQ(metadata->init_id, ouster_init_id(config, 3, 0));
        EXPECT_EQ(metadata->serial, ouster_unit(config, 3).serial);
      }
    }
  }
}

TEST(SimulatedOuster, BytesDependOnTheSeedAndNotOnTheNumberOfWorkers) {
  LidarRig rig(0.5);
  OusterConfig config = small_ouster();
  config.returns = ReturnConfig{};
  config.imu_error_scale = 1;
  config.clock = {.jitter_s = 1e-6, .latency_s = 1e-4, .latency_jitter_s = 1e-4};
  const TemporaryFolder folder;
  std::vector<std::string> captures;
  for (const unsigned workers : {1U, 2U, 3U}) {
    must_write(rig, config, folder.path(), {.threads = workers});
    captures.push_back(read_file(folder / "lidar0.pcap"));
  }
  EXPECT_EQ(captures[0], captures[1]);
  EXPECT_EQ(captures[0], captures[2]);
  rig.context.seed = 8;
  must_write(rig, config, folder.path());
  EXPECT_NE(captures[0], read_file(folder / "lidar0.pcap"));
}

TEST(SimulatedOuster, ProductReplaysItsCaptureWithoutARejection) {
  const LidarRig rig(1.0);
  const TemporaryFolder folder;
  must_write(rig, small_ouster(), folder.path());
  auto source = open_recording(folder / "lidar0.pcap", {});
  ASSERT_TRUE(source.ok()) << source.error().message;
  std::vector<LidarPoint> storage(512 * 16);
  int sweeps = 0;
  for (;; ++sweeps) {
    Sweep sweep;
    sweep.storage = storage;
    const auto more = (*source)->next(sweep);
    if (!more.ok() || !*more) break;
    EXPECT_EQ(sweep.count, storage.size());
  }
  EXPECT_EQ(sweeps, 10);
  EXPECT_TRUE((*source)->rejected().empty());
}

TEST(SimulatedOuster, ScansOfAGenericFolderAreThePacketsPoints) {
  const LidarRig rig(0.2);
  const TemporaryFolder folder;
  must_write(rig, small_ouster(), folder.path());
  const DecodedOuster decoded = decode_ouster(folder / "lidar0.pcap");
  const LidarLog log = must_write(rig, small_ouster(), folder.path(), {.form = LidarForm::kScans});
  EXPECT_EQ(log.sweeps, 2U);
  const std::string bytes = read_file(folder.path() / "lidar0" / "000001.bin");
  std::vector<float> values(bytes.size() / sizeof(float));
  std::memcpy(values.data(), bytes.data(), bytes.size());
  ASSERT_EQ(values.size(), 5U * 512 * 16);
  const DecodedOuster::Pixel& last = decoded.pixels.back();
  const OusterXyzTable table(decoded.metadata);
  const auto p = table.point(last.column * 16 + last.row, last.range_mm);
  EXPECT_EQ(values[values.size() - 5], p.x());
  EXPECT_EQ(values[values.size() - 3], p.z());
  EXPECT_FLOAT_EQ(values.back(), 0.1F * 511 / 512);
  EXPECT_EQ(read_file(folder.path() / "lidar0" / "times.txt"), "1767268800.000000000\n1767268800.100000000\n");
}

TEST(SimulatedOuster, ClockOfItsOwnRunsAsConfigured) {
  // given a sensor on its own oscillator, 200 ppm fast, and a wire with delays
  const LidarRig rig(1.0);
  OusterConfig config = small_ouster();
  config.clock_source = "TIME_FROM_INTERNAL_OSC";
  config.clock = {.skew_ppm = 200, .latency_s = 2e-3, .latency_jitter_s = 1e-4};
  const TemporaryFolder folder;
  must_write(rig, config, folder.path());
  const DecodedOuster decoded = decode_ouster(folder / "lidar0.pcap");
  // then stamps begin with its uptime and gain 200 us a second
  EXPECT_EQ(decoded.pixels.front().stamp_ns, 60'000'000'000);
  const double last_s = 1 - 0.1 / 512;
  EXPECT_NEAR(static_cast<double>(decoded.pixels.back().stamp_ns - 60'000'000'000), last_s * 1e9 + last_s * 2e5, 2);
  // and nothing comes before it was sent, nor before what came before
  const auto& datagrams = decoded.capture.datagrams;
  for (std::size_t i = 1; i < decoded.capture.frames.size(); ++i) {
    EXPECT_LE(decoded.capture.frames[i - 1], decoded.capture.frames[i]);
  }
  const auto points = decoded.capture.to(7502);
  EXPECT_GE((points.back()->received - rig.context.start).seconds(), 1.0 + 2e-3);
  EXPECT_LT((points.back()->received - rig.context.start).seconds(), 1.0 + 5e-3);
  EXPECT_GT(datagrams.size(), points.size());  // its IMU's are between them
}

TEST(SimulatedOuster, ImuOfEitherProfileFeelsGravityAtRest) {
  const LidarRig rig(1.0, {}, hall(), false);
  for (const char* const profile : {"LEGACY", "ACCEL32_GYRO32_NMEA"}) {
    OusterConfig config = small_ouster();
    config.imu = profile;
    const TemporaryFolder folder;
    const LidarLog log = must_write(rig, config, folder.path());
    const bool legacy = std::string(profile) == "LEGACY";
    EXPECT_EQ(log.imu_datagrams, legacy ? 100U : 80U);
    const DecodedOuster decoded = decode_ouster(folder / "lidar0.pcap");
    OusterImuParser parser(legacy ? kOusterLegacyImu : kOusterAccelGyroNmea, decoded.metadata.init_id);
    OusterImuPacket packet;
    std::size_t samples = 0;
    for (const CapturedDatagram* const datagram : decoded.capture.to(7503)) {
      ASSERT_TRUE(parser.parse(datagram->bytes, packet));
      for (const OusterImuSample& sample : packet.samples()) {
        const double t_s = static_cast<double>(samples++) / (legacy ? 100 : 640);
        EXPECT_NEAR(static_cast<double>(static_cast<std::int64_t>(sample.gyro_ns) - rig.context.start.ns()), t_s * 1e9,
                    1);
        EXPECT_LT((sample.accel_mps2 - Eigen::Vector3d(0, 0, kGravity_mps2)).norm(), 1e-5);
        EXPECT_LT(sample.gyro_radps.norm(), 1e-9);
      }
    }
    EXPECT_EQ(samples, legacy ? 100U : 640U);
  }
}

TEST(SimulatedOuster, RefusesWhatCannotBeWritten) {
  const LidarRig rig(0.2);
  const TemporaryFolder folder;
  const auto missing = write_ouster(rig.context, small_ouster(), folder / "no_such");
  ASSERT_FALSE(missing.ok());
  EXPECT_NE(missing.error().message.find("no_such/lidar0"), std::string::npos) << missing.error().message;
  const LidarRig brief(0.05);
  EXPECT_FALSE(write_ouster(brief.context, small_ouster(), folder.path()).ok());
  OusterConfig early = small_ouster();
  early.clock_source = "TIME_FROM_INTERNAL_OSC";
  early.clock.offset_s = -61;
  const auto refused = write_ouster(rig.context, early, folder.path());
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find("clock's zero"), std::string::npos);
}

// Given a clock of its own that has run for 60 s, when a fault sets it back by more than that, or by more than a
// restart left of it, then no stamp can be written.
TEST(SimulatedOuster, ClockThatAFaultSetsBeforeItsZeroIsRefused) {
  const auto sound = [](const std::vector<Fault>& plan) {
    const LidarRig rig(2, FaultPlan(plan));
    OusterConfig config = small_ouster();
    config.clock_source = "TIME_FROM_INTERNAL_OSC";
    return check_ouster(rig.context, config).ok();
  };
  EXPECT_TRUE(sound({{"lidar0_time_step", 0.5, 1.2, -60}}));
  EXPECT_FALSE(sound({{"lidar0_time_step", 0.5, 1.2, -61}})) << "in the middle only";
  EXPECT_TRUE(sound({{"lidar0_restart", 0.5, 1, 0}}));
  EXPECT_FALSE(sound({{"lidar0_restart", 0.5, 1, 0}, {"lidar0_time_step", 1.2, 9, -1}}));
}

}  // namespace
}  // namespace lxd::test::simulator_ouster_test
