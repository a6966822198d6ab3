// SPDX-License-Identifier: Apache-2.0
#include "drivers/ros1/livox_points.hpp"

namespace lxd {
namespace {

constexpr std::uint32_t kLivoxPointBytes = 19;  // uint32 offset_time, float32 x y z, uint8 reflectivity tag line
constexpr std::size_t kReservedBytes = 3;

}  // namespace

Ros1Fault read_ros1_livox_points(Ros1Reader::Bytes message, Ros1Scan& out) {
  Ros1Reader reader(message);
  out.points.clear();
  out.no_return = out.non_finite = 0;
  out.has_times = true;
  out.header = read_ros1_header(reader);
  (void)reader.number<std::uint64_t>();                 // timebase
  (void)reader.number<std::uint32_t>();                 // the number of points; the array has its own
  reader.bytes(sizeof(std::uint8_t) + kReservedBytes);  // which LiDAR
  Ros1Reader points(reader.array(kLivoxPointBytes));
  if (const Ros1Fault fault = reader.finish(); fault != Ros1Fault::none) return fault;
  while (points.finish() == Ros1Fault::trailing_bytes) {
    Ros1Point point;
    point.offset_ns = points.number<std::uint32_t>();
    point.x_m = points.number<float>();
    point.y_m = points.number<float>();
    point.z_m = points.number<float>();
    point.intensity = points.number<std::uint8_t>();
    points.bytes(2);  // tag, line
    push_ros1_point(out, point);
  }
  return count_from_first(out);
}

}  // namespace lxd
