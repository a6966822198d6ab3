// SPDX-License-Identifier: Apache-2.0
// How the camera was found to be mounted, in the axes in which the rig file says it; and a sentence for the user when
// that is not what it says.
#pragma once

#include <optional>
#include <string>

#include "board/star.hpp"
#include "estimator/vision/camera_alignment.hpp"

namespace lxd {

struct FoundMount {
  Pose T_reference_camera;     // as found
  Eigen::Vector3d turned_deg;  // takes the rig file's rotation to it, on its left: about the reference's axes
  Eigen::Matrix3d covariance_deg2;
  double unlike = 0;  // CameraAlignment::unlike()
};

// star: with a camera.
FoundMount found_mount(const CameraAlignment& alignment, const Star& star);

class MountHint {
 public:
  // What is known by now. The first time: what the rig file says, and how sure it is.
  void note(const FoundMount& mount);

  // Empty: nothing is amiss.
  [[nodiscard]] std::string sentence() const;

 private:
  std::optional<double> claimed_deg_;
  FoundMount found_;
};

}  // namespace lxd
