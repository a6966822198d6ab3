// SPDX-License-Identifier: Apache-2.0
// LAS 1.2 writer for clouds: the interchange format of surveying.
#pragma once

#include <filesystem>

#include "backend/cloud.hpp"
#include "rt/result.hpp"

namespace lxd {

// Point data format 1, of a coloured cloud 3: coordinates in millimetres about the middle of the cloud, 16-bit
// intensity, rig time in gps_time; the images that saw a point in user_data, 0 where none did; normal and variance of
// its surface in extra bytes. Intensities up to 1 are spread over 16 bits, larger ones are kept and cut off at 65535.
// Error: more than 2^32 - 1 points, wider than LAS's
// 32-bit millimetres (4294 km), writing.
Status write_las(CloudReader& cloud, const std::filesystem::path& out);

}  // namespace lxd
