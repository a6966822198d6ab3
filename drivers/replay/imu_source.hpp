// SPDX-License-Identifier: Apache-2.0
// The IMU of a recording on the rig's clock: imu.serial of a rig recording through the live rig's parser and clock
// model, or imu.csv of a generic folder, whose times are rig times already.
#pragma once

#include <filesystem>
#include <memory>

#include "drivers/imu/imu_protocol.hpp"
#include "drivers/replay/rejections.hpp"
#include "rt/imu_sample.hpp"
#include "rt/result.hpp"

namespace lxd {

inline constexpr const char* kImuSerialFile = "imu.serial";
inline constexpr const char* kImuTextFile = "imu.csv";

class ImuSource {
 public:
  virtual ~ImuSource() = default;
  // The next sample, its `t` on the rig's clock. False: the recording has ended. Damage is counted and passed over.
  virtual bool next(ImuSample& sample) = 0;
  [[nodiscard]] virtual Rejections rejected() const = 0;
};

// pulsed: the clock of a serial IMU goes by the pulses of pps.csv. Errors: the folder holds neither file, or it cannot
// be read.
Result<std::unique_ptr<ImuSource>> open_imu_source(const std::filesystem::path& recording, ImuProtocol protocol,
                                                   double baud_rate, bool pulsed = false);

}  // namespace lxd
