// SPDX-License-Identifier: Apache-2.0
// sensor_msgs/PointCloud2 of any layout of fields: coordinates and intensity of any numeric type.
//
// A point's time is in the first of the fields `t`, `offset_time`, `time`, `timestamp`, `time_stamp` that there is: as
// a whole number of 32 bits nanoseconds after the header's stamp (two's complement: drivers subtract), as a
// floating-point number seconds after it, seconds since 1970, or nanoseconds since 1970, told apart by the size of the
// greatest.
#pragma once

#include "drivers/ros1/scan.hpp"

namespace lxd {

Ros1Fault read_ros1_point_cloud(Ros1Reader::Bytes message, Ros1Scan& out);

}  // namespace lxd
