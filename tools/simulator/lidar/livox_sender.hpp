// SPDX-License-Identifier: Apache-2.0
// Frames of a simulated Mid-360, and its IMU's samples, as datagrams on their way: headers, stamps and the faults that
// change what a packet says.
#pragma once

#include <optional>
#include <vector>

#include "tools/simulator/imu/imu_model.hpp"
#include "tools/simulator/lidar/lidar_clock.hpp"
#include "tools/simulator/lidar/lidar_log.hpp"
#include "tools/simulator/lidar/lidar_wire.hpp"
#include "tools/simulator/lidar/livox_encoder.hpp"

namespace lxd::sim {

class LivoxSender {
 public:
  // Keeps references to all but config.
  LivoxSender(const Context& context, const LivoxConfig& config, const LidarClock& clock, const LidarFaults& faults);

  // A frame's datagrams in order; what is wrong with them is added to `log`. Safe from many threads.
  [[nodiscard]] std::vector<LidarDatagram> send(const LivoxFrame& frame, LidarLog& log) const;
  [[nodiscard]] LivoxClock clock_type() const { return clock_type_; }

 private:
  const Context& context_;
  LivoxConfig config_;
  const LidarClock& clock_;
  const LidarFaults& faults_;
  LivoxClock clock_type_;
};

// The sensor's own IMU, at 200 Hz. Call from one thread, in order.
class LivoxImuSender {
 public:
  LivoxImuSender(const Context& context, const LivoxConfig& config, LivoxClock clock_type, const LidarClock& clock);

  // The next datagram, when it was made before end_s.
  std::optional<LidarDatagram> next(double end_s);

 private:
  bool enabled_;
  LivoxClock clock_type_;
  const LidarClock& clock_;
  Random jitter_;
  ImuModel model_;
  std::optional<ImuModelSample> ahead_;
  std::uint16_t packets_ = 0;
};

// Where the sensor's IMU sits, in the frame of its points; its axes are theirs.
Pose livox_T_sensor_imu();

}  // namespace lxd::sim
