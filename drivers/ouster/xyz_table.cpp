// SPDX-License-Identifier: Apache-2.0
// See xyz_table.hpp and the README's derivation. Source: ouster-sdk 46b7bcee, ouster_core/src/xyzlut.cpp.
#include "drivers/ouster/xyz_table.hpp"

#include <cmath>
#include <numbers>

namespace lxd {

OusterXyzTable::OusterXyzTable(const OusterMetadata& metadata) {
  constexpr double kMetersPerMillimeter = 1e-3;
  const std::size_t rows = metadata.format.pixels_per_column;
  const Eigen::Matrix3d R = metadata.T_sensor_lidar.topLeftCorner<3, 3>();
  const Eigen::Vector3d t = metadata.T_sensor_lidar.topRightCorner<3, 1>();
  const Eigen::Vector3d beam = metadata.T_lidar_beam.topRightCorner<3, 1>();
  // Ranges are measured from the origin through it.
  const double beam_length = Eigen::Vector2d(beam.x(), beam.z()).norm();
  for (std::size_t column = 0; column < metadata.columns_per_frame; ++column) {
    const double turn = static_cast<double>(column) / metadata.columns_per_frame;
    const double encoder = 2 * std::numbers::pi * (1 - turn);  // the sensor spins clockwise seen from above
    for (std::size_t row = 0; row < rows; ++row) {
      const double azimuth = encoder - metadata.azimuth_rad[row];
      const double altitude = metadata.altitude_rad[row];
      const Eigen::Vector3d ray(std::cos(azimuth) * std::cos(altitude), std::sin(azimuth) * std::cos(altitude),
                                std::sin(altitude));
      const Eigen::Vector3d start(beam.x() * std::cos(encoder), beam.x() * std::sin(encoder), beam.z());
      direction_.push_back((R * ray * kMetersPerMillimeter).cast<float>());
      offset_.push_back((R * (start - beam_length * ray) + t).cast<float>());
    }
  }
}

}  // namespace lxd
