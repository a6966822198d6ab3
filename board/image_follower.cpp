// SPDX-License-Identifier: Apache-2.0
#include "board/image_follower.hpp"

#include <array>
#include <numbers>

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
  return MountedCamera{CameraModel(intrinsics), *star.T_body_camera0, camera.delay_s, camera.delay_sigma_s,
                       camera.rotation_sigma_deg * std::numbers::pi / 180};
}

ImageFollower::ImageFollower(const MountedCamera& camera)
    : camera_(camera), tracker_(std::make_unique<FeatureTracker>(camera.model, TrackerConfig{})) {}

bool ImageFollower::follow(const GreyPixels& pixels, RigTime stamp, const std::optional<Eigen::Matrix3d>& turn) {
  std::array<PredictedPixel, kFeaturesMax> predictions;
  std::size_t count = 0;
  const Eigen::Matrix3d& R = camera_.T_body_camera.R;
  if (turn) count = predict_by_turn(frame_, R.transpose() * turn->transpose() * R, camera_.model, predictions);
  const GreyImage image{stamp, pixels.width, pixels.height, pixels.width, pixels.data};
  return tracker_->track(image, std::span(predictions).first(count), frame_);
}

void ImageFollower::report(Rejections& rejected) const {
  for (const auto& [fault, name] : kImageFaultNames) count_rejected(rejected, name, tracker_->faults()[fault]);
}

}  // namespace lxd
