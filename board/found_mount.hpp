// SPDX-License-Identifier: Apache-2.0
// How the camera, or the IMU against the LiDAR, was found to be mounted, in the axes in which the rig file says it; and
// a sentence for the user when that is not what it says.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "board/star.hpp"
#include "estimator/imu_mount.hpp"
#include "estimator/vision/camera_alignment.hpp"

namespace lxd {

struct FoundMount {
  std::string_view section;    // of the rig file, where it is said
  Pose T_reference_sensor;     // there, as found
  Eigen::Vector3d turned_deg;  // takes the rig file's rotation to it, on its left: about the reference's axes
  Eigen::Matrix3d covariance_deg2;
  double unlike = 0;  // CameraAlignment::unlike()
};

// star: with a camera.
FoundMount found_mount(const CameraAlignment& alignment, const Star& star);

// Of the IMU, which is the body. T_reference_sensor is the IMU's; where that is the reference itself, the LiDAR's.
FoundMount found_mount(const ImuMount& mount, double unlike, const Star& star);

class MountHint {
 public:
  // sensor: its section in the rig file; unlike: what to look at when its turns
  // have nothing to do with the rig's.
  MountHint(std::string_view sensor, std::string_view unlike) : sensor_(sensor), unlike_(unlike) {}

  // What is known by now. The first time: what the rig file says, and how sure it is.
  void note(const FoundMount& mount);

  // Empty: nothing is amiss.
  [[nodiscard]] std::string sentence() const;

 private:
  std::string_view sensor_, unlike_;
  std::optional<double> claimed_deg_;
  FoundMount found_;
};

}  // namespace lxd
