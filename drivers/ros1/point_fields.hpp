// SPDX-License-Identifier: Apache-2.0
// The fields of a point of a sensor_msgs/PointCloud2: where in its bytes which number is, and of what type.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "drivers/ros1/wire_reader.hpp"

namespace lxd {

// The message's own numbers.
enum class Ros1Datatype : std::uint8_t {
  int8 = 1,
  uint8 = 2,
  int16 = 3,
  uint16 = 4,
  int32 = 5,
  uint32 = 6,
  float32 = 7,
  float64 = 8
};

struct Ros1Field {
  std::uint32_t offset = 0;  // bytes from the point's begin
  Ros1Datatype datatype = Ros1Datatype::float32;

  // As any of them can be told. Precondition: the field lies within the point.
  [[nodiscard]] double value(Ros1Reader::Bytes point) const;
};

struct Ros1PointFields {
  std::optional<Ros1Field> x, y, z, intensity, time;
};

// The array of fields at the reader; `point_bytes` is not known before it. What is no use to us is passed over; of two
// of a name the first holds. `unknown_datatype`: of one that is of use.
Ros1Fault read_ros1_point_fields(Ros1Reader& reader, Ros1PointFields& out);

// Do all fields that are there lie within a point of so many bytes?
bool fit_into(const Ros1PointFields& fields, std::uint32_t point_bytes);

}  // namespace lxd
