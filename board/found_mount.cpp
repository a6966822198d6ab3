// SPDX-License-Identifier: Apache-2.0
#include "board/found_mount.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "board/rig_text.hpp"

namespace lxd {
namespace {

constexpr double kDegree_rad = std::numbers::pi / 180;
// Calibrations by hand are good to some tenths of a degree; more, more than was claimed, and surely so, is worth being
// written down.
constexpr double kTurned_deg = 0.3, kTurnedSigmas = 5;
// A mount that is off by a third of a radian lacks so much of its turns' squares: no calibration is.
constexpr double kUnlike = 0.1;
constexpr double kDecimals = 1e8;  // steps to one: a rotation so rounded is still one to who reads the rig file

Pose rounded(const Pose& T) {
  return {(kDecimals * T.R).array().round() / kDecimals, (kDecimals * T.p).array().round() / kDecimals};
}

}  // namespace

FoundMount found_mount(const CameraAlignment& alignment, const Star& star) {
  const Eigen::Matrix3d R = star.T_body_reference.R.transpose() / kDegree_rad;
  Pose T = star.T_body_reference.inverse() * *star.T_body_camera0;
  T.R = star.T_body_reference.R.transpose() * alignment.R_body_camera();
  return {"camera0", T, R * alignment.turned_rad(), R * alignment.turned_covariance_rad2() * R.transpose(),
          alignment.unlike()};
}

FoundMount found_mount(const ImuMount& mount, double unlike, const Star& star) {
  const Eigen::Matrix3d R = star.T_body_reference.R.transpose() / kDegree_rad;
  Pose T = star.T_body_reference.inverse();
  T.R = star.T_body_reference.R.transpose() * mount.R_body_imu();
  if (star.body_is_reference) {
    T = star.T_body_lidar0;
    T.R = mount.R_body_imu().transpose() * star.T_body_lidar0.R;
  }
  return {star.body_is_reference ? "lidar0" : "imu", T, R * mount.turned_rad(),
          R * mount.covariance_rad2() * R.transpose(), unlike};
}

void MountHint::note(const FoundMount& mount) {
  if (!claimed_deg_) claimed_deg_ = std::sqrt(mount.covariance_deg2.diagonal().maxCoeff());
  found_ = mount;
}

std::string MountHint::sentence() const {
  if (!claimed_deg_) return {};
  if (found_.unlike > kUnlike) return fmt::format("{}: {}", sensor_, unlike_);
  const Eigen::Vector3d& turned = found_.turned_deg;
  const double off_deg = turned.norm(), worth_deg = std::max(kTurned_deg, *claimed_deg_);
  const double sigma_deg = std::sqrt(turned.dot(found_.covariance_deg2 * turned)) / std::max(off_deg, worth_deg);
  if (off_deg < worth_deg || off_deg < kTurnedSigmas * sigma_deg) return {};
  return fmt::format(
      "{}: it is turned by {:.2f} degrees against what the rig file says ({:.2f}, {:.2f}, {:.2f} about the reference's "
      "axes): put {}.T_reference_sensor: {} there",
      sensor_, off_deg, turned.x(), turned.y(), turned.z(), found_.section,
      transform_text(rounded(found_.T_reference_sensor)));
}

}  // namespace lxd
