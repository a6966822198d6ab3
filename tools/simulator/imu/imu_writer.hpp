// SPDX-License-Identifier: Apache-2.0
// The IMU of a recording: the bytes of its serial line (imu.serial), the biases it had (imu_truth.csv), and where it is
// asked for its samples as text (imu.csv of the generic folder).
#pragma once

#include <cstdint>
#include <filesystem>

#include "rt/result.hpp"
#include "tools/simulator/context.hpp"
#include "tools/simulator/imu/imu_config.hpp"
#include "tools/simulator/imu/imu_faults.hpp"

namespace lxd::sim {

inline constexpr const char* kImuSerialFile = "imu.serial";
inline constexpr const char* kImuTruthFile = "imu_truth.csv";
inline constexpr const char* kImuCsvFile = "imu.csv";

struct ImuFiles {
  bool serial = true;    // imu.serial: rig recording
  bool generic = false;  // imu.csv: generic folder
};

struct ImuWritten {
  std::uint64_t samples = 0;  // sent
  std::uint64_t bytes = 0;    // on the line
  ImuFaultCounts faults;
};

// What can be known before the work: the line is too slow for the samples, the clock is before its own epoch.
Status check_imu(const Context& context, const ImuConfig& config);

// Errors: check_imu's, and files that cannot be written.
Result<ImuWritten> write_imu(const Context& context, const ImuConfig& config, const std::filesystem::path& folder,
                             const ImuFiles& files = {});

}  // namespace lxd::sim
