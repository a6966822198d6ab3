// SPDX-License-Identifier: Apache-2.0
// Why a ROS 1 message is refused.
#pragma once

#include <cstdint>

namespace lxd {

enum class Ros1Fault : std::uint8_t {
  none,
  truncated,         // ends before its last field
  trailing_bytes,    // goes on behind it: another definition of the type
  big_endian,        // points or pixels, and more than one byte each
  bad_layout,        // steps, sizes or fields that do not fit the data
  no_coordinates,    // a cloud without x, y and z
  unknown_datatype,  // of a field that is needed
  bad_time,          // a stamp or points' times that cannot be: not finite, spread over more than a second
  unknown_encoding,  // of pixels
  non_finite,        // a reading that is no number
  empty,             // no points, no pixels, no text
};

// As counts name it: "trailing_bytes".
const char* name_of(Ros1Fault fault);

}  // namespace lxd
