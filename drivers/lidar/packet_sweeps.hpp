// SPDX-License-Identifier: Apache-2.0
// One LiDAR's datagrams in, sweeps on the rig's clock out: the same object below a replayed capture and below a live
// port.
#pragma once

#include <cstdint>
#include <span>

#include "drivers/replay/rejections.hpp"
#include "rt/imu_sample.hpp"
#include "rt/sweep.hpp"
#include "rt/time.hpp"

namespace lxd {

class PacketSweeps {
 public:
  virtual ~PacketSweeps() = default;

  // Whether the datagram is a sound packet of points of this kind of sensor; otherwise it is counted.
  virtual bool parse(std::span<const std::uint8_t> datagram) = 0;
  // Takes the packet that parse() found, whose bytes are still there. True: it ended a sweep, which `sweep` (lent
  // empty) now holds; false: `sweep` is as empty as before, or without meaning.
  virtual bool take(RigTime received, Sweep& sweep) = 0;
  // The sweep under way, when nothing follows. True: there was one.
  virtual bool flush(Sweep& sweep) = 0;

  // The samples of an inertial packet of the sensor's own IMU, `t` on the rig's clock; valid until the next call. None:
  // it is no such packet, or too little of the sensor has been heard to know its clock.
  virtual std::span<const ImuSample> inertial(std::span<const std::uint8_t> datagram, RigTime received) = 0;

  // A pulse at a whole second of the sensor's clock.
  virtual void add_pulse(RigTime edge) = 0;

  // What was refused since the start, by cause.
  virtual void report(Rejections& rejected) const = 0;
  // Likewise of inertial packets.
  virtual void report_inertial(Rejections& rejected) const = 0;
};

}  // namespace lxd
