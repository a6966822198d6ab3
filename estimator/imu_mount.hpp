// SPDX-License-Identifier: Apache-2.0
// How the IMU is turned on its carrier against what the rig file says of it and the LiDAR. The turn between two poses
// that the LiDAR holds is held against the gyroscope's: of an IMU that is mounted otherwise it is one about another
// axis. The body stays where the rig file has it against the LiDAR; it is the readings that are turned. The same filter
// as a camera's mount. README.md, "The IMU's mount". Real-time thread.
#pragma once

#include "estimator/vision/camera_alignment.hpp"

namespace lxd {

class ImuMount {
 public:
  // How sure the rig file is, about each axis; 0: exactly.
  explicit ImuMount(double rotation_sigma_rad = 0);

  [[nodiscard]] bool known() const { return alignment_.known(); }
  // Takes readings into the body's axes: near the identity.
  [[nodiscard]] const Eigen::Matrix3d& R_body_imu() const { return alignment_.R_body_camera(); }
  // Log(R_body_imu), and how sure that is.
  [[nodiscard]] Eigen::Vector3d turned_rad() const { return alignment_.turned_rad(); }
  [[nodiscard]] Eigen::Matrix3d covariance_rad2() const { return alignment_.turned_covariance_rad2(); }
  // CameraAlignment::unlike()
  [[nodiscard]] double unlike() const { return alignment_.unlike(); }

  // Turns R_then_now of the body: by the LiDAR; by readings as they are turned now, with its covariance.
  void compare(RigTime then, RigTime now, const Eigen::Matrix3d& by_lidar, const Eigen::Matrix3d& by_imu,
               const Eigen::Matrix3d& covariance_rad2) noexcept;

 private:
  CameraAlignment alignment_;
};

}  // namespace lxd
