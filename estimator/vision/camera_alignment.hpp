// SPDX-License-Identifier: Apache-2.0
// By how much a camera's images are stamped later than the LiDAR's returns of the same instant, and how the camera is
// turned on its carrier against what the rig file says. The turn between two images, which their features tell, is held
// against that of the path between their instants: when the images are late it is the turn of a little earlier, and
// when the camera is mounted otherwise it is one about another axis. A body that rests tells nothing; one that turns
// steadily tells no delay, and about its axis no mount. README.md, "The camera's delay and its mount". Real-time
// thread.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "estimator/vision/attitude_track.hpp"
#include "estimator/vision/reprojection.hpp"
#include "estimator/vision/turn_meter.hpp"

namespace lxd {

// What the path's turn lacks to the images' (rad), and how much of that a second of delay and a radian of mount make:
// columns [delay, rotation (body)].
struct TurnRow {
  Eigen::Vector3d lacking;
  Eigen::Matrix<double, 3, 4> by;
};

// Between two images' instants: turns R_then_now of the body, by its path, by its path CameraAlignment::kEarlier
// before, and by the images as the camera is believed to be mounted.
TurnRow turn_row(const Eigen::Matrix3d& path, const Eigen::Matrix3d& path_earlier, const Eigen::Matrix3d& seen);

class CameraAlignment {
 public:
  static constexpr Duration kEarlier = Duration::from_ns(10'000'000);

  // Begins as the rig file says.
  explicit CameraAlignment(const MountedCamera& camera);

  [[nodiscard]] double delay_s() const { return delay_s_; }  // an instant's image is stamped so much later
  [[nodiscard]] double delay_sigma_s() const { return std::sqrt(P_(0, 0)); }
  [[nodiscard]] Duration delay() const { return Duration::from_seconds(delay_s_); }
  [[nodiscard]] const Eigen::Matrix3d& R_body_camera() const { return R_body_camera_; }
  // R_body_camera = Exp(turned) R_by_the_rig_file: in the body's axes, rad; and how sure that is.
  [[nodiscard]] Eigen::Vector3d turned_rad() const { return Log(R_body_camera_ * R_given_.transpose()); }
  [[nodiscard]] Eigen::Matrix3d turned_covariance_rad2() const { return P_.bottomRightCorner<3, 3>(); }
  // What the images' turns lack to the path's, over these: sums of squares. Near 1 the rig file is wrong altogether. 0:
  // too little has been turned to say.
  [[nodiscard]] double unlike() const;
  [[nodiscard]] bool known() const { return !delay_open() && !mount_open(); }  // exactly, by the rig file

  // Time has passed: clocks drift apart, and mounts bend.
  void pass(Duration span) noexcept;

  // path_turn(then, now) -> std::optional<Eigen::Matrix3d>: R_then_now of the body, between two instants.
  template <typename PathTurn>
  void compare(const ImageTurn& seen, PathTurn&& path_turn) noexcept {
    const RigTime then = seen.then - delay(), now = seen.now - delay();
    const auto path = path_turn(then, now), earlier = path_turn(then - kEarlier, now - kEarlier);
    const Eigen::Matrix3d& R = R_body_camera_;
    if (path && earlier)
      learn(turn_row(*path, *earlier, R * seen.R_then_now * R.transpose()), R * seen.covariance_rad2 * R.transpose());
  }

  // Where the LiDAR alone knows the path: the attitude at a sweep's end. The turn waits until the sweeps after it are
  // known.
  void follow(RigTime end, const Eigen::Matrix3d& R_world_body, const ImageTurn* seen) noexcept;
  void forget_path() {
    attitudes_.clear();
    waiting_count_ = 0;
  }

 private:
  static constexpr std::size_t kWaiting = 6;

  [[nodiscard]] bool delay_open() const { return P_(0, 0) > 0; }
  [[nodiscard]] bool mount_open() const { return P_(1, 1) > 0; }
  void compare_at_large(const TurnRow& row);
  void learn(TurnRow row, const Eigen::Matrix3d& covariance) noexcept;
  void correct(const Eigen::Vector4d& by);

  double delay_s_;
  Eigen::Matrix3d R_given_, R_body_camera_;
  Eigen::Matrix4d P_ = Eigen::Matrix4d::Zero();  // of [delay, rotation (body)]; zero: known exactly
  double misfit_ = 1;  // running mean of squared ratios of what neither explains; 1: as large as it should be
  double lacking_rad2_ = 0, turned_rad2_ = 0;  // sums, of turns that are worth it
  AttitudeTrack attitudes_;
  std::array<ImageTurn, kWaiting> waiting_;
  std::size_t waiting_count_ = 0;
};

}  // namespace lxd
