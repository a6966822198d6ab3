// SPDX-License-Identifier: Apache-2.0
// The camera of a recording: its images through the visual front-end, as features on the rig's clock. Runs in the
// thread that reads.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "board/mutes.hpp"
#include "board/rig.hpp"
#include "board/star.hpp"
#include "drivers/replay/camera_folder.hpp"
#include "estimator/odometry.hpp"
#include "estimator/vision/front_end/feature_tracker.hpp"

namespace lxd {

class CameraStream {
 public:
  // Error: the recording has no images, or they cannot be read.
  static Result<CameraStream> open(const std::filesystem::path& recording, const MountedCamera& camera);

  // All images up to `until`; the IMU's readings, which tell where features are sought, come before. `shift` is added
  // to the stamps.
  void feed(Odometry& odometry, const Mutes& mutes, RigTime until, Duration shift);

  // Of the files and of the images, by cause.
  [[nodiscard]] Rejections rejected() const;

 private:
  CameraStream(CameraFolder folder, const MountedCamera& camera);
  [[nodiscard]] bool read();
  void follow(Odometry& odometry, RigTime stamp);

  CameraFolder folder_;
  MountedCamera camera_;
  std::unique_ptr<FeatureTracker> tracker_;
  std::optional<CameraImage> next_;  // read, and not yet handed over
  FeatureFrame frame_;               // of the last image that was fit for use
  bool ended_ = false;
};

// The camera in use, as its rig file has it; nothing: none is.
std::optional<MountedCamera> camera_of(const Rig& rig, const Star& star);

}  // namespace lxd
