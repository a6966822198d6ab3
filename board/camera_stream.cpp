// SPDX-License-Identifier: Apache-2.0
#include "board/camera_stream.hpp"

#include <array>

#include "drivers/replay/camera_source.hpp"

namespace lxd {
namespace {

constexpr std::array<std::pair<ImageFault, const char*>, 6> kImageFaultNames{{{ImageFault::empty, "empty_image"},
                                                                              {ImageFault::size_changed, "image_size"},
                                                                              {ImageFault::not_newer, "time_backwards"},
                                                                              {ImageFault::dark, "dark_image"},
                                                                              {ImageFault::bright, "bright_image"},
                                                                              {ImageFault::flat, "flat_image"}}};

Distortion distortion_of(const CameraRig& rig) {
  if (rig.distortion_model == "equidistant") return Distortion::equidistant;
  return rig.distortion_model == "none" ? Distortion::none : Distortion::radtan;
}

}  // namespace

std::optional<MountedCamera> camera_of(const Rig& rig, const Star& star) {
  if (!star.T_body_camera0) return std::nullopt;
  const CameraRig& camera = *rig.camera0;
  CameraIntrinsics intrinsics;
  intrinsics.resolution = camera.resolution;
  intrinsics.focal_px = {camera.intrinsics[0], camera.intrinsics[1]};
  intrinsics.centre_px = {camera.intrinsics[2], camera.intrinsics[3]};
  intrinsics.distortion = distortion_of(camera);
  intrinsics.coefficients = camera.distortion_coeffs;
  return MountedCamera{CameraModel(intrinsics), *star.T_body_camera0};
}

Result<CameraStream> CameraStream::open(const std::filesystem::path& recording, const MountedCamera& camera) {
  auto folder = open_camera(recording);
  if (!folder) return folder.error();
  return CameraStream(std::move(*folder), camera);
}

CameraStream::CameraStream(CameraFolder folder, const MountedCamera& camera)
    : folder_(std::move(folder)),
      camera_(camera),
      tracker_(std::make_unique<FeatureTracker>(camera.model, TrackerConfig{})) {}

bool CameraStream::read() {
  if (next_ || ended_) return !ended_;
  next_.emplace();
  ended_ = !folder_.next(*next_);
  return !ended_;
}

void CameraStream::feed(Odometry& odometry, const Mutes& mutes, RigTime until, Duration shift) {
  while (read()) {
    const RigTime stamp = next_->instant + shift;
    if (stamp > until) return;
    if (!mutes.silent("camera0", stamp)) follow(odometry, stamp);
    next_.reset();
  }
}

void CameraStream::follow(Odometry& odometry, RigTime stamp) {
  std::array<PredictedPixel, kFeaturesMax> predictions;
  std::size_t count = 0;
  const Eigen::Matrix3d& R = camera_.T_body_camera.R;
  if (const auto turn = odometry.turn(frame_.stamp, stamp))
    count = predict_by_turn(frame_, R.transpose() * turn->transpose() * R, camera_.model, predictions);
  const GreyPixels& pixels = next_->pixels;
  const GreyImage image{stamp, pixels.width, pixels.height, pixels.width, pixels.data};
  if (tracker_->track(image, std::span(predictions).first(count), frame_)) odometry.add(frame_);
}

Rejections CameraStream::rejected() const {
  Rejections rejected = folder_.rejected();
  for (const auto& [fault, name] : kImageFaultNames) count_rejected(rejected, name, tracker_->faults()[fault]);
  return rejected;
}

}  // namespace lxd
