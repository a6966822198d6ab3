// SPDX-License-Identifier: Apache-2.0
// One camera's images through the visual front-end, whoever reads them: sought where the gyroscope says that features
// have gone. One thread; allocates.
#pragma once

#include <memory>
#include <optional>

#include "board/rig.hpp"
#include "board/star.hpp"
#include "drivers/replay/camera_folder.hpp"
#include "estimator/odometry.hpp"
#include "estimator/vision/front_end/feature_tracker.hpp"

namespace lxd {

class ImageFollower {
 public:
  explicit ImageFollower(const MountedCamera& camera);

  // turn: of the body since frame().stamp, R_then_now; nothing: not known. True: the image was fit for use, and
  // frame() has its features.
  bool follow(const GreyPixels& pixels, RigTime stamp, const std::optional<Eigen::Matrix3d>& turn);

  // Of the last image that was fit for use.
  [[nodiscard]] const FeatureFrame& frame() const { return frame_; }
  // Images that were not, by cause.
  void report(Rejections& rejected) const;

 private:
  MountedCamera camera_;
  std::unique_ptr<FeatureTracker> tracker_;
  FeatureFrame frame_;
};

// The camera in use, as its rig file has it; nothing: none is.
std::optional<MountedCamera> camera_of(const Rig& rig, const Star& star);

}  // namespace lxd
