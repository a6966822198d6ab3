// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/lidar/lidar_wire.hpp"

#include <cctype>

namespace lxd::sim {

Status LidarWire::send(LidarDatagram datagram, LidarLog& log) {
  if (faults_.silent(datagram.begin_s, datagram.t_s)) {
    if (!datagram.imu) ++log.silenced;
    return success();
  }
  if (!datagram.imu) return send_points(std::move(datagram), log);
  ++log.imu_datagrams;
  return pcap_.write(imu_, datagram.bytes, clock_.received(datagram.t_s, random_));
}

Status LidarWire::send_points(LidarDatagram datagram, LidarLog& log) {
  const double t_s = datagram.t_s;
  const bool lost = random_.chance(faults_.value(LidarFault::kLoss, t_s));
  const bool twice = random_.chance(faults_.value(LidarFault::kDuplicate, t_s));
  const bool overtaken = random_.chance(faults_.value(LidarFault::kReorder, t_s));
  if (overtaken && !lost && !held_) {
    held_ = std::move(datagram);
    return success();
  }
  const Status written = write(datagram, twice && !lost ? 2 : 1, lost, log);
  if (!written || lost || !held_) return written;
  ++log.reordered;
  return write_held(log);
}

Status LidarWire::write(const LidarDatagram& datagram, std::uint64_t copies, bool loses_frame, LidarLog& log) {
  std::optional<std::uint64_t> lost_frame;
  if (loses_frame) lost_frame = random_.bits();
  for (std::uint64_t copy = 0; copy < copies; ++copy) {
    const RigTime received = clock_.received(datagram.t_s, random_);
    const Status written = pcap_.write(points_, datagram.bytes, received, lost_frame);
    if (!written) return written;
  }
  loses_frame ? ++log.lost : log.datagrams += copies;
  log.duplicated += copies - 1;
  return success();
}

Status LidarWire::write_held(LidarLog& log) {
  const LidarDatagram datagram = std::move(*held_);
  held_.reset();
  return write(datagram, 1, false, log);
}

Status LidarWire::close(LidarLog& log) {
  if (held_) {  // nothing came that could overtake it
    const Status written = write_held(log);
    if (!written) return written;
  }
  return pcap_.close();
}

UdpRoute lidar_route(std::string_view sensor, std::uint16_t source_port, std::uint16_t destination_port) {
  constexpr std::uint8_t kFirstSensor = 120, kHost = 5;
  const char last = sensor.empty() ? '0' : sensor.back();
  const auto digit = static_cast<std::uint8_t>(std::isdigit(static_cast<unsigned char>(last)) != 0 ? last - '0' : 0);
  const auto address = static_cast<std::uint8_t>(kFirstSensor + digit);
  return {{{192, 168, 1, address}, source_port}, {{192, 168, 1, kHost}, destination_port}};
}

}  // namespace lxd::sim
