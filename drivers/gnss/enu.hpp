// SPDX-License-Identifier: Apache-2.0
// A local tangent frame on the WGS-84 ellipsoid: x east, y north, z up, metres.
#pragma once

#include <optional>

#include <Eigen/Core>
#include <GeographicLib/LocalCartesian.hpp>

#include "rt/result.hpp"

namespace lxd {

struct Geodetic {
  double latitude_deg = 0;
  double longitude_deg = 0;
  double height_m = 0;  // above the ellipsoid
};

class EnuFrame {
 public:
  // Error: the origin is no place (latitude beyond +-90 degrees, longitude beyond +-180, a value not finite).
  static Result<EnuFrame> at(const Geodetic& origin);

  // Neither throws nor allocates; of values that are not finite nothing finite comes back.
  [[nodiscard]] Eigen::Vector3d to_enu(const Geodetic& place) const;
  [[nodiscard]] Geodetic to_geodetic(const Eigen::Vector3d& enu_m) const;

 private:
  explicit EnuFrame(const Geodetic& origin) : frame_(origin.latitude_deg, origin.longitude_deg, origin.height_m) {}

  GeographicLib::LocalCartesian frame_;
};

}  // namespace lxd
