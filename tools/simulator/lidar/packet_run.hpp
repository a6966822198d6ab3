// SPDX-License-Identifier: Apache-2.0
// Made sweeps to their files, in order: packets with those of the sensor's own IMU between them, or scans.
#pragma once

#include <algorithm>
#include <vector>

#include "tools/recording/scan_folder_writer.hpp"
#include "tools/simulator/lidar/lidar_log.hpp"
#include "tools/simulator/lidar/lidar_run.hpp"
#include "tools/simulator/lidar/lidar_wire.hpp"

namespace lxd::sim {

struct MadePackets {
  LidarLog log;
  std::vector<LidarDatagram> datagrams;
};

struct MadeScan {
  LidarLog log;  // without a sweep: the sensor was silent
  WrittenScan scan;
};

// imu.next(end_s): an optional datagram, made before end_s.
template <typename Imu>
Status send_imu(double end_s, LidarWire& wire, Imu& imu, LidarLog& log) {
  while (auto datagram = imu.next(end_s)) {
    const Status sent = wire.send(std::move(*datagram), log);
    if (!sent) return sent;
  }
  return success();
}

// make(i): the packets of sweep i.
template <typename Make, typename Imu>
Status run_packets(const Context& context, std::uint64_t sweeps, const LidarOutput& output, const Make& make,
                   LidarWire& wire, Imu& imu, LidarLog& log) {
  const Status sent = run_sweeps<MadePackets>(sweeps, output, make, [&](MadePackets made) {
    log += made.log;
    for (LidarDatagram& datagram : made.datagrams) {
      const Status before = send_imu(std::min(datagram.t_s, context.duration_s), wire, imu, log);
      if (!before) return before;
      const Status own = wire.send(std::move(datagram), log);
      if (!own) return own;
    }
    return success();
  });
  if (!sent) return sent;
  const Status rest = send_imu(context.duration_s, wire, imu, log);
  return rest ? wire.close(log) : rest;
}

// make(i): the scan of sweep i.
template <typename Make>
Status run_scans(std::uint64_t sweeps, const LidarOutput& output, const Make& make, ScanFolderWriter& scans,
                 LidarLog& log) {
  const Status written = run_sweeps<MadeScan>(sweeps, output, make, [&](const MadeScan& made) {
    log += made.log;
    return made.log.sweeps > 0 ? scans.write(made.scan) : success();
  });
  return written ? scans.close() : written;
}

}  // namespace lxd::sim
