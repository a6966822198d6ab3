// SPDX-License-Identifier: Apache-2.0
#include "estimator/vision/front_end/feature_tracker.hpp"

#include <algorithm>

namespace lxd {
namespace {

std::vector<cv::Point2f> first_guesses(const std::vector<cv::Point2f>& from, std::span<const std::uint32_t> ids,
                                       std::span<const PredictedPixel> predictions) {
  std::vector<cv::Point2f> guesses = from;
  for (const PredictedPixel& predicted : predictions) {
    const auto at = std::find(ids.begin(), ids.end(), predicted.id);
    if (at != ids.end() && predicted.pixel.allFinite())
      guesses[static_cast<std::size_t>(at - ids.begin())] = {predicted.pixel.x(), predicted.pixel.y()};
  }
  return guesses;
}

}  // namespace

FeatureTracker::FeatureTracker(const CameraModel& camera, const TrackerConfig& config)
    : camera_(camera), config_(config) {
  config_.corners.wanted = std::min(config.corners.wanted, static_cast<int>(kFeaturesMax));
}

void FeatureTracker::clear() {
  tracks_.clear();
  last_.reset();
  last_stamp_.reset();
}

ImageFault FeatureTracker::fault_of(const GreyImage& image) const {
  if (image.width == 0 || image.height == 0 || image.stride < image.width ||
      image.pixels.size() < image.stride * (image.height - 1) + image.width)
    return ImageFault::empty;
  if (image.width != camera_.intrinsics().resolution[0] || image.height != camera_.intrinsics().resolution[1])
    return ImageFault::size_changed;
  const bool old = last_stamp_ && image.stamp <= *last_stamp_ && *last_stamp_ - image.stamp <= config_.gap_max;
  return old ? ImageFault::not_newer : ImageFault::kCount;
}

bool FeatureTracker::track(const GreyImage& image, std::span<const PredictedPixel> predictions, FeatureFrame& frame) {
  frame.stamp = image.stamp;
  frame.count = 0;
  ImageFault fault = fault_of(image);
  if (fault == ImageFault::kCount) {
    const cv::Mat lent(static_cast<int>(image.height), static_cast<int>(image.width), CV_8U,
                       const_cast<std::uint8_t*>(image.pixels.data()), image.stride);  // only read
    fault = exposure_fault(small_copy(lent));
    if (fault == ImageFault::kCount) {
      FlowImage now = flow_image(lent.clone(), config_.flow);
      if (last_stamp_ && (image.stamp < *last_stamp_ || image.stamp - *last_stamp_ > config_.gap_max)) clear();
      follow_tracks(now, predictions);
      thin_out();
      add_new(now.grey);
      last_ = std::move(now);
      last_stamp_ = image.stamp;
      publish(image.stamp, frame);
      return true;
    }
  }
  faults_.add(fault);
  return false;
}

void FeatureTracker::follow_tracks(const FlowImage& now, std::span<const PredictedPixel> predictions) {
  if (!last_) return;
  std::vector<cv::Point2f> from;
  std::vector<std::uint32_t> ids;
  for (const Track& track : tracks_) {
    from.push_back(track.pixel);
    ids.push_back(track.id);
  }
  std::vector<cv::Point2f> to = first_guesses(from, ids, predictions);
  std::vector<std::uint8_t> found;
  follow(*last_, now, config_.flow, from, to, found);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    Eigen::Vector3d bearing;
    const Eigen::Vector2d pixel(to[i].x, to[i].y);
    if (found[i] == 0 || !camera_.contains(pixel, config_.corners.border_px / 2.0) ||
        !camera_.unproject(pixel, bearing))
      continue;
    tracks_[kept++] = {ids[i], tracks_[i].age + 1, to[i]};
  }
  tracks_.resize(kept);
}

// Of tracks that have run together the oldest stays; they are in the order of their birth.
void FeatureTracker::thin_out() {
  const double spacing = config_.corners.spacing_px / 2.0;
  std::vector<Track> kept;
  for (const Track& track : tracks_) {
    const bool crowded = std::any_of(kept.begin(), kept.end(),
                                     [&](const Track& other) { return cv::norm(other.pixel - track.pixel) < spacing; });
    if (!crowded) kept.push_back(track);
  }
  tracks_ = std::move(kept);
}

void FeatureTracker::add_new(const cv::Mat& grey) {
  std::vector<cv::Point2f> tracked;
  for (const Track& track : tracks_) tracked.push_back(track.pixel);
  for (const cv::Point2f& corner : new_corners(grey, tracked, config_.corners)) {
    Eigen::Vector3d bearing;
    if (tracks_.size() == kFeaturesMax) return;
    if (camera_.unproject({corner.x, corner.y}, bearing)) tracks_.push_back({next_id_++, 0, corner});
  }
}

void FeatureTracker::publish(RigTime stamp, FeatureFrame& frame) const {
  frame.stamp = stamp;
  frame.count = 0;
  for (const Track& track : tracks_) {
    Eigen::Vector3d bearing;
    if (!camera_.unproject({track.pixel.x, track.pixel.y}, bearing)) continue;
    const Eigen::Vector3f b = bearing.cast<float>();
    frame.storage[frame.count++] = {track.id, track.age, {track.pixel.x, track.pixel.y}, {b.x(), b.y(), b.z()}};
  }
}

}  // namespace lxd
