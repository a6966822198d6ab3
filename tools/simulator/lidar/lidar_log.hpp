// SPDX-License-Identifier: Apache-2.0
// What a simulated LiDAR did to its packets, so that a driver's counters can be held against it.
#pragma once

#include <cstdint>

namespace lxd::sim {

struct LidarLog {
  std::uint64_t sweeps = 0;
  std::uint64_t shots = 0;    // pixels or points, with or without a return
  std::uint64_t returns = 0;  // of the shots
  // Datagrams of points.
  std::uint64_t datagrams = 0;   // that reached the host whole, copies included
  std::uint64_t lost = 0;        // of which one Ethernet frame (the only one, if it has one) never came
  std::uint64_t reordered = 0;   // overtaken by the next
  std::uint64_t duplicated = 0;  // that came twice
  std::uint64_t silenced = 0;    // not sent: off, or restarting
  std::uint64_t other_profile = 0, other_serial = 0, other_init_id = 0;  // of the datagrams sent, by what is wrong
  std::uint64_t emptied = 0;  // sent without valid columns (Ouster) or points (Livox)
  // Datagrams of inertial data that reached the host.
  std::uint64_t imu_datagrams = 0;

  LidarLog& operator+=(const LidarLog& o) {
    sweeps += o.sweeps, shots += o.shots, returns += o.returns;
    datagrams += o.datagrams, lost += o.lost, reordered += o.reordered, duplicated += o.duplicated;
    silenced += o.silenced, other_profile += o.other_profile, other_serial += o.other_serial;
    other_init_id += o.other_init_id, emptied += o.emptied, imu_datagrams += o.imu_datagrams;
    return *this;
  }
};

}  // namespace lxd::sim
