// SPDX-License-Identifier: Apache-2.0
#include "drivers/ros1/truth_pose.hpp"

#include <cmath>

namespace lxd {
namespace {

constexpr std::size_t kCovariance6Bytes = 36 * sizeof(double);
constexpr std::size_t kTwistBytes = 6 * sizeof(double);
constexpr double kNormTolerance = 0.01;  // of a quaternion that was one: float32 is far within

void read_place(Ros1Reader& reader, Ros1TruthPose& out) {
  for (double& component : out.p) component = reader.number<double>();
  for (double& component : out.q.coeffs()) component = reader.number<double>();  // x, y, z, w
}

Ros1Fault finish_pose(const Ros1Reader& reader, Ros1TruthPose& out) {
  if (const Ros1Fault fault = reader.finish(); fault != Ros1Fault::none) return fault;
  const double norm = out.q.norm();
  if (!out.p.allFinite() || !(std::abs(norm - 1) <= kNormTolerance)) return Ros1Fault::non_finite;
  out.q.coeffs() /= norm;
  return Ros1Fault::none;
}

}  // namespace

Ros1Fault read_ros1_pose(Ros1Reader::Bytes message, Ros1TruthPose& out) {
  Ros1Reader reader(message);
  out.header = read_ros1_header(reader);
  read_place(reader, out);
  return finish_pose(reader, out);
}

Ros1Fault read_ros1_transform(Ros1Reader::Bytes message, Ros1TruthPose& out) {
  Ros1Reader reader(message);
  out.header = read_ros1_header(reader);
  (void)reader.text();  // the child's frame
  read_place(reader, out);
  return finish_pose(reader, out);
}

Ros1Fault read_ros1_odometry(Ros1Reader::Bytes message, Ros1TruthPose& out) {
  Ros1Reader reader(message);
  out.header = read_ros1_header(reader);
  (void)reader.text();
  read_place(reader, out);
  reader.bytes(kCovariance6Bytes + kTwistBytes + kCovariance6Bytes);
  return finish_pose(reader, out);
}

}  // namespace lxd
