// SPDX-License-Identifier: Apache-2.0
#include "drivers/ros1/inertial.hpp"

namespace lxd {
namespace {

constexpr std::size_t kQuaternionBytes = 4 * sizeof(double);
constexpr std::size_t kCovariance3Bytes = 9 * sizeof(double);

Eigen::Vector3d read_vector3(Ros1Reader& reader) {
  Eigen::Vector3d vector;
  for (double& component : vector) component = reader.number<double>();
  return vector;
}

}  // namespace

Ros1Fault read_ros1_inertial(Ros1Reader::Bytes message, Ros1Inertial& out) {
  Ros1Reader reader(message);
  out.header = read_ros1_header(reader);
  reader.bytes(kQuaternionBytes + kCovariance3Bytes);
  out.gyro_radps = read_vector3(reader);
  reader.bytes(kCovariance3Bytes);
  out.accel_mps2 = read_vector3(reader);
  reader.bytes(kCovariance3Bytes);
  if (const Ros1Fault fault = reader.finish(); fault != Ros1Fault::none) return fault;
  return out.gyro_radps.allFinite() && out.accel_mps2.allFinite() ? Ros1Fault::none : Ros1Fault::non_finite;
}

}  // namespace lxd
