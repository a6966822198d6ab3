// SPDX-License-Identifier: Apache-2.0
// From a LiDAR to the host's capture: datagrams in the order of their sending, with the wire's faults.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "drivers/replay/pcap_writer.hpp"
#include "tools/simulator/lidar/lidar_clock.hpp"
#include "tools/simulator/lidar/lidar_log.hpp"

namespace lxd::sim {

struct LidarDatagram {
  double begin_s = 0;  // when its first shot was fired, or its first sample taken
  double t_s = 0;      // when it was sent
  bool imu = false;
  std::vector<std::uint8_t> bytes;
};

class LidarWire {
 public:
  // Keeps references to clock and faults.
  LidarWire(PcapWriter pcap, const UdpRoute& points, const UdpRoute& imu, const LidarClock& clock,
            const LidarFaults& faults, Random random)
      : pcap_(std::move(pcap)), points_(points), imu_(imu), clock_(clock), faults_(faults), random_(random) {}

  // In the order of t_s.
  Status send(LidarDatagram datagram, LidarLog& log);
  Status close(LidarLog& log);

 private:
  Status send_points(LidarDatagram datagram, LidarLog& log);
  Status write(const LidarDatagram& datagram, std::uint64_t copies, bool loses_frame, LidarLog& log);
  Status write_held(LidarLog& log);

  PcapWriter pcap_;
  UdpRoute points_, imu_;
  const LidarClock& clock_;
  const LidarFaults& faults_;
  Random random_;
  std::optional<LidarDatagram> held_;  // will be overtaken by the next
};

// 192.168.1.1xx for the sensor, by the last digit of its name, and 192.168.1.5 for the host.
UdpRoute lidar_route(std::string_view sensor, std::uint16_t source_port, std::uint16_t destination_port);

}  // namespace lxd::sim
