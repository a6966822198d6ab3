// SPDX-License-Identifier: Apache-2.0
// sensor_msgs/NavSatFix as a fix of ours, and nmea_msgs/Sentence, which is one line of a receiver.
#pragma once

#include <string_view>

#include "drivers/gnss/gnss_fix.hpp"
#include "drivers/ros1/header.hpp"

namespace lxd {

struct Ros1SatelliteFix {
  Ros1Header header;
  GnssFix fix;  // position, quality and, where the message knows a covariance, sigmas; heights above the ellipsoid
};
Ros1Fault read_ros1_satellite_fix(Ros1Reader::Bytes message, Ros1SatelliteFix& out);

struct Ros1Sentence {
  Ros1Header header;
  std::string_view text;  // valid as long as the message
};
Ros1Fault read_ros1_sentence(Ros1Reader::Bytes message, Ros1Sentence& out);

}  // namespace lxd
