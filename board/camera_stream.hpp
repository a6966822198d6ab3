// SPDX-License-Identifier: Apache-2.0
// The camera of a recording: its images through the visual front-end, as features on the rig's clock. Runs in the
// thread that reads.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include "board/image_follower.hpp"
#include "board/mutes.hpp"
#include "drivers/replay/camera_folder.hpp"
#include "estimator/odometry.hpp"

namespace lxd {

class CameraStream {
 public:
  // Error: the recording has no images, or they or the edges that triggered them cannot be read.
  static Result<CameraStream> open(const std::filesystem::path& recording, const Rig& rig, const MountedCamera& camera);

  // All images that are stamped up to `until`; the IMU's readings, which tell where features are sought, come before.
  // `shift` is added to the stamps.
  void feed(Odometry& odometry, const Mutes& mutes, RigTime until, Duration shift);
  // Who else sees the images, at their shifted instants, before the features are handed over.
  using Listener = std::function<void(const CameraImage&, RigTime)>;
  void listen(Listener listener) { listener_ = std::move(listener); }

  // Of the files and of the images, by cause.
  [[nodiscard]] Rejections rejected() const;

 private:
  CameraStream(CameraFolder folder, const MountedCamera& camera) : folder_(std::move(folder)), follower_(camera) {}
  [[nodiscard]] bool read();

  CameraFolder folder_;
  ImageFollower follower_;
  Listener listener_;
  std::optional<CameraImage> next_;  // read, and not yet handed over
  bool ended_ = false;
};

// The images of a recording, of the instants that its rig file says: the middle of their exposures, or told by their
// triggers. Errors as above.
Result<CameraFolder> open_timed_camera(const std::filesystem::path& recording, const Rig& rig);

// What its rig file says of the camera's triggers.
TriggerTiming trigger_timing_of(const Rig& rig);

}  // namespace lxd
