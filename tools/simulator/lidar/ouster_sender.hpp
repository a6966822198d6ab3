// SPDX-License-Identifier: Apache-2.0
// Turns of a simulated Ouster, and its IMU's samples, as datagrams on their way: headers, stamps and the faults that
// change what a packet says.
#pragma once

#include <optional>
#include <vector>

#include "tools/simulator/imu/imu_model.hpp"
#include "tools/simulator/lidar/lidar_clock.hpp"
#include "tools/simulator/lidar/lidar_log.hpp"
#include "tools/simulator/lidar/lidar_wire.hpp"
#include "tools/simulator/lidar/ouster_imu_encoder.hpp"
#include "tools/simulator/lidar/ouster_scan.hpp"

namespace lxd::sim {

struct OusterIdentity {
  std::uint32_t frame_id = 0, init_id = 0;
  std::uint64_t serial = 0;
};

class OusterSender {
 public:
  // Keeps references to all but config and metadata.
  OusterSender(const Context& context, const OusterConfig& config, const OusterMetadata& metadata,
               const OusterScanner& scanner, const LidarClock& clock, const LidarFaults& faults);

  // A turn's datagrams in order; what is wrong with them is added to `log`. Safe from many threads.
  [[nodiscard]] std::vector<LidarDatagram> send(const OusterTurn& turn, LidarLog& log) const;

  // What a packet made at t_s of turn `number` says of its sender.
  [[nodiscard]] OusterIdentity identity(std::uint64_t number, double t_s) const;

 private:
  void count_faults(double t_s, const OusterTurn& turn, LidarLog& log) const;

  const Context& context_;
  OusterConfig config_;
  OusterPacketFormat format_, other_format_;
  std::size_t columns_;
  const OusterScanner& scanner_;
  const LidarClock& clock_;
  const LidarFaults& faults_;
  std::uint64_t serial_, other_serial_;
};

// The sensor's own IMU. Call from one thread, in order.
class OusterImuSender {
 public:
  OusterImuSender(const Context& context, const OusterConfig& config, const OusterSender& sender,
                  const LidarClock& clock);

  // The next datagram, when it was made before end_s.
  std::optional<LidarDatagram> next(double end_s);

 private:
  LidarDatagram make();

  OusterConfig config_;
  const OusterImuProfile* profile_ = nullptr;  // null: no IMU
  std::size_t records_ = 1;
  double rest_s_ = 0;  // from a datagram's first sample to its last
  const OusterSender& sender_;
  const LidarClock& clock_;
  Random jitter_;
  ImuModel model_;
  std::optional<ImuModelSample> ahead_;
  std::uint64_t packets_ = 0;
};

}  // namespace lxd::sim
