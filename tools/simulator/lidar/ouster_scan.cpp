// SPDX-License-Identifier: Apache-2.0
// Geometry: ouster-sdk 46b7bcee, ouster_core/src/xyzlut.cpp; derivation in the README. With n the length of the beam
// origin's offset b, a point at range r is (r - n) ray + b: the ray leaves from b, where r is n.
#include "tools/simulator/lidar/ouster_scan.hpp"

#include <cmath>
#include <numbers>

namespace lxd::sim {
namespace {

Eigen::Vector3d ray_of(double azimuth_rad, double altitude_rad) {
  return {std::cos(azimuth_rad) * std::cos(altitude_rad), std::sin(azimuth_rad) * std::cos(altitude_rad),
          std::sin(altitude_rad)};
}

constexpr double kReachBeyond_m = 5;  // noise may bring a surface beyond the range limit back into it

}  // namespace

OusterScanner::OusterScanner(const Context& context, const OusterConfig& config, const OusterMetadata& metadata)
    : context_(context),
      config_(config),
      returns_(config.returns, context.scene.world()),
      columns_(metadata.columns_per_frame),
      rows_(metadata.format.pixels_per_column),
      beam_origin_m_(std::hypot(metadata.T_lidar_beam(0, 3), metadata.T_lidar_beam(2, 3))),
      reach_m_(config.returns.range_max_m + kReachBeyond_m) {
  const Eigen::Matrix3d R = metadata.T_sensor_lidar.topLeftCorner<3, 3>();
  const Eigen::Vector3d t = metadata.T_sensor_lidar.topRightCorner<3, 1>();
  for (std::size_t column = 0; column < columns_; ++column) {
    const double encoder = -2 * std::numbers::pi * static_cast<double>(column) / static_cast<double>(columns_);
    const Eigen::AngleAxisd turn(encoder, Eigen::Vector3d::UnitZ());
    origins_.emplace_back(R * (turn * Eigen::Vector3d(metadata.T_lidar_beam.topRightCorner<3, 1>())) + t);
    for (std::size_t row = 0; row < rows_; ++row) {
      directions_.emplace_back(R * ray_of(encoder - metadata.azimuth_rad[row], metadata.altitude_rad[row]));
    }
  }
}

OusterTurn OusterScanner::scan(std::uint64_t number, ShotFault fault) const {
  Random random(context_.seed, config_.sensor + "/turn", number);
  OusterTurn turn{number, fault, std::vector<Return>(columns_ * rows_)};
  std::vector<Ray> rays(rows_);
  std::vector<Hit> hits(rows_);
  std::vector<Shot> before, now(rows_);
  for (std::size_t column = 0; column < columns_; ++column) {
    aim(column_s(number, column), column, rays);
    context_.scene.cast(rays, hits);
    for (std::size_t row = 0; row < rows_; ++row) now[row] = {rays[row], hits[row]};
    for (std::size_t row = 0; row < rows_; ++row) {
      const Shot* const neighbour = before.empty() ? nullptr : &before[row];
      const std::size_t pixel = column * rows_ + row;
      turn.pixels[pixel] = fault == ShotFault::kOneVoxel ? plate_return(directions_[pixel])
                                                         : returns_.measure(now[row], neighbour, fault, random);
    }
    before = now;
  }
  return turn;
}

void OusterScanner::aim(double t_s, std::size_t column, std::vector<Ray>& rays) const {
  const Pose T_world_sensor = context_.motion.pose(t_s) * config_.T_body_sensor;
  const Eigen::Vector3f origin = (T_world_sensor * origins_[column]).cast<float>();
  for (std::size_t row = 0; row < rows_; ++row) {
    const Eigen::Vector3d direction = T_world_sensor.R * directions_[column * rows_ + row];
    rays[row] = {origin, direction.cast<float>(), static_cast<float>(t_s), static_cast<float>(reach_m_)};
  }
}

}  // namespace lxd::sim
