// SPDX-License-Identifier: Apache-2.0
// The returns that take part in a sweep: those of the primary LiDAR's sweep, and those that an extra one fired
// meanwhile. Each is looked at where it lies; nothing is copied.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "rt/pose.hpp"
#include "rt/sweep.hpp"

namespace lxd {

// What a LiDAR is to the filter.
struct LidarModel {
  Pose T_body_lidar;
  double range_min_m, range_max_m;  // nearer returns are the carrier itself
  double range_sigma_m;             // of one range
  double bearing_sigma_rad;         // of a beam's direction and spread
};

// A usable return on its way into the body's frame.
struct Return {
  Eigen::Vector3f p_body_m;  // at its own firing time
  std::uint32_t offset_ns;   // since the path's begin
  float variance_m2;         // of the range and the beam's spread
  float intensity;
};

// Returns of one LiDAR whose offsets are `shift_ns` short of the path's begin.
class LidarReturns {
 public:
  LidarReturns() = default;
  LidarReturns(const LidarModel& model, std::span<const LidarPoint> points, std::uint32_t shift_ns)
      : points_(points),
        shift_ns_(shift_ns),
        min_square_(static_cast<float>(model.range_min_m * model.range_min_m)),
        max_square_(static_cast<float>(model.range_max_m * model.range_max_m)),
        range_variance_(static_cast<float>(model.range_sigma_m * model.range_sigma_m)),
        bearing_variance_(static_cast<float>(model.bearing_sigma_rad * model.bearing_sigma_rad)),
        R_(model.T_body_lidar.R.cast<float>()),
        p_(model.T_body_lidar.p.cast<float>()) {}

  // f(return) for each usable return until f says false; false then.
  template <typename F>
  bool for_each(F&& f) const {
    for (const LidarPoint& point : points_) {
      const Eigen::Vector3f q(point.x_m, point.y_m, point.z_m);
      const float square = q.squaredNorm();
      if (!(square >= min_square_ && square <= max_square_)) continue;  // nor NaN
      if (!f(Return{R_ * q + p_, point.offset_ns + shift_ns_, range_variance_ + bearing_variance_ * square,
                    point.intensity}))
        return false;
    }
    return true;
  }

  [[nodiscard]] bool has(std::uint32_t wanted) const {
    std::uint32_t count = 0;
    return wanted == 0 || !for_each([&](const Return&) { return ++count < wanted; });
  }

 private:
  std::span<const LidarPoint> points_;
  std::uint32_t shift_ns_ = 0;
  float min_square_ = 0, max_square_ = 0, range_variance_ = 0, bearing_variance_ = 0;
  Eigen::Matrix3f R_ = Eigen::Matrix3f::Identity();
  Eigen::Vector3f p_ = Eigen::Vector3f::Zero();
};

}  // namespace lxd
