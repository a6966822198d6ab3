// SPDX-License-Identifier: Apache-2.0
// livox_ros_driver/CustomMsg and livox_ros_driver2/CustomMsg, which are the same bytes.
#pragma once

#include "drivers/ros1/scan.hpp"

namespace lxd {

// The header's stamp is that of `timebase` on the host's clock, as far as the driver knows it: points are placed by
// the stamp and their offsets; timebase alone, the sensor's own clock, is not used.
Ros1Fault read_ros1_livox_points(Ros1Reader::Bytes message, Ros1Scan& out);

}  // namespace lxd
