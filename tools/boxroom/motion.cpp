// SPDX-License-Identifier: Apache-2.0
// Sums of slow sinusoids: every derivative is bounded and known, nothing repeats within a minute.
#include "tools/boxroom/motion.hpp"

#include <cmath>

#include <Eigen/Geometry>

namespace lxd::boxroom {
namespace {

constexpr double kBlend_s = 2.0;  // from rest to full speed

struct Wave {
  double amplitude;  // m or rad
  double rate;       // rad/s of path time

  [[nodiscard]] double at(double w_s) const { return amplitude * std::sin(rate * w_s); }
};

constexpr Wave kX_m{9.0, 0.22}, kY_m{6.0, 0.44}, kZ_m{0.25, 0.9};
constexpr double kHeight_m = 1.6;
constexpr Wave kYaw_rad{0.9, 0.31}, kPitch_rad{0.06, 0.8}, kRoll_rad{0.05, 1.1};
constexpr double kTurn_rad_s = 0.15;  // steady part of the yaw rate

}  // namespace

// A quartic blend: speed and acceleration are continuous when the motion begins and when it is at full speed.
double Motion::path_time_s(double t_s) const {
  if (t_s <= rest_s_) return 0.0;
  const double s = t_s - rest_s_;
  if (s >= kBlend_s) return kBlend_s * 0.5 + (s - kBlend_s);
  return s * s * s / (kBlend_s * kBlend_s) * (1 - 0.5 * s / kBlend_s);
}

Pose Motion::world_body(double t_s) const {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  const double w_s = path_time_s(t_s);
  const double turn_s = w_s * angular_speed_;
  const double yaw_rad = kYaw_rad.at(turn_s) + kTurn_rad_s * turn_s;
  Pose T_world_body;
  T_world_body.R = (AngleAxisd(yaw_rad, Vector3d::UnitZ()) * AngleAxisd(kPitch_rad.at(turn_s), Vector3d::UnitY()) *
                    AngleAxisd(kRoll_rad.at(turn_s), Vector3d::UnitX()))
                       .toRotationMatrix();
  T_world_body.p = Vector3d(kX_m.at(w_s), kY_m.at(w_s), kHeight_m + kZ_m.at(w_s));
  return T_world_body;
}

}  // namespace lxd::boxroom
