// SPDX-License-Identifier: Apache-2.0
// See enu.hpp.
#include "drivers/gnss/enu.hpp"

#include <cmath>

#include <fmt/format.h>

namespace lxd {

Result<EnuFrame> EnuFrame::at(const Geodetic& origin) {
  const bool sound =
      std::abs(origin.latitude_deg) <= 90 && std::abs(origin.longitude_deg) <= 180 && std::isfinite(origin.height_m);
  if (!sound)
    return Error{fmt::format("origin: found latitude {}, longitude {}, height {}, wanted degrees within +-90 and +-180",
                             origin.latitude_deg, origin.longitude_deg, origin.height_m)};
  return EnuFrame(origin);
}

Eigen::Vector3d EnuFrame::to_enu(const Geodetic& place) const {
  Eigen::Vector3d enu;
  frame_.Forward(place.latitude_deg, place.longitude_deg, place.height_m, enu.x(), enu.y(), enu.z());
  return enu;
}

Geodetic EnuFrame::to_geodetic(const Eigen::Vector3d& enu_m) const {
  Geodetic place;
  frame_.Reverse(enu_m.x(), enu_m.y(), enu_m.z(), place.latitude_deg, place.longitude_deg, place.height_m);
  return place;
}

}  // namespace lxd
