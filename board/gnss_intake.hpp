// SPDX-License-Identifier: Apache-2.0
// From what a receiver says to what the graph takes: fixes are turned into metres east, north and up of the first, and
// carried by the filter's path from their own time to the key frame before. One for each key frame.
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <string>

#include "backend/graph/gnss_track.hpp"
#include "drivers/gnss/enu.hpp"
#include "drivers/gnss/gnss_fix.hpp"

namespace lxd {

class GnssIntake {
 public:
  explicit GnssIntake(const Eigen::Vector3d& antenna_in_body_m) : antenna_m_(antenna_in_body_m) {}

  // In the order of their receive times, at most those up to the next sweep's end.
  void take(const GnssFix& fix, Duration shift);

  // The filter has gone from one pose to the next; `key_frame` is the last that was cut. What can be said of it now.
  std::optional<GnssMeasurement> advance(RigTime before, const Pose& T_world_before, RigTime now,
                                         const Pose& T_world_now, const KeyFrame& key_frame);

  // A new path begins.
  void begin_again();

  // Fixes that never reached the graph, by cause.
  [[nodiscard]] const std::map<std::string, std::uint64_t>& rejected() const { return rejected_; }

 private:
  struct Place {
    RigTime stamp;
    Eigen::Vector3d enu_m;
    Eigen::Matrix3d covariance_m2;
  };

  Eigen::Vector3d antenna_m_;
  std::optional<EnuFrame> frame_;
  std::deque<Place> waiting_;
  std::int64_t last_key_frame_ = -1;  // that has its fix
  std::map<std::string, std::uint64_t> rejected_;
};

}  // namespace lxd
