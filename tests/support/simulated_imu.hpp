// SPDX-License-Identifier: Apache-2.0
// A walk of a rig with nothing but an IMU, recorded into a folder and read back.
#pragma once

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/replay/imu_log.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/walking_motion.hpp"
#include "tools/simulator/imu/imu_writer.hpp"

namespace lxd::test {

struct SimulatedImu {
  explicit SimulatedImu(double seconds, std::vector<sim::Fault> plan = {})
      : motion(walking_motion(seconds + 1)), faults(std::move(plan)), duration_s(seconds) {}

  [[nodiscard]] sim::Context context() const {
    return {scene, motion, faults, seed, RigTime::from_seconds(1'767'268'800), duration_s};
  }
  [[nodiscard]] sim::ImuWritten write(const sim::ImuFiles& files = {}) const {
    const auto written = sim::write_imu(context(), config, folder.path(), files);
    EXPECT_TRUE(written.ok()) << (written.ok() ? "" : written.error().message);
    return written.ok() ? *written : sim::ImuWritten{};
  }
  [[nodiscard]] std::vector<ImuSample> read() {
    auto log = ImuLog::open(folder / sim::kImuSerialFile, config.protocol, config.line.baud_rate);
    EXPECT_TRUE(log.ok());
    std::vector<ImuSample> samples;
    for (ImuSample sample; log->next(sample);) samples.push_back(sample);
    rejected = log->rejected();
    return samples;
  }

  TemporaryFolder folder;
  sim::World world;
  sim::Scene scene{world};
  sim::Trajectory motion;
  sim::FaultPlan faults;
  sim::ImuConfig config;
  std::uint64_t seed = 1;
  double duration_s;
  Rejections rejected;
};

}  // namespace lxd::test
