// SPDX-License-Identifier: Apache-2.0
#include "board/live_vision.hpp"

#include "rt/so3.hpp"

namespace lxd {
namespace {

constexpr Duration kReadingsAwaited = Duration::from_ns(10'000'000);  // for readings that are on their way
constexpr Duration kReadingsGap = Duration::from_ns(50'000'000);      // more is no turn that is known

}  // namespace

LiveVision::LiveVision(const Rig& rig, const MountedCamera& camera, bool inertial, SensorWatch& watch,
                       const HostClock& clock)
    : watch_(watch),
      clock_(clock),
      images_(rig),
      follower_(camera),
      inertial_(inertial),
      history_block_(kHistoryBytes),
      history_arena_(history_block_),
      history_(history_arena_),
      reading_slots_(kReadings),
      readings_(reading_slots_),
      frame_slots_(kFrames),
      frames_(frame_slots_) {}

void LiveVision::take(const Chunk& chunk) {
  watch_.heard(LiveChannel::camera0, chunk.received);
  images_.take(chunk);
}

void LiveVision::turn() {
  while (const auto sample = readings_.pop()) history_.add({sample->t, sample->gyro_radps, sample->accel_mps2});
  const RigTime now = clock_.now();
  while (const CameraImage* const image = images_.front(now)) {
    if (too_early(*image, now)) return;
    if (follower_.follow(image->pixels, image->instant, turned(follower_.frame().stamp, image->instant))) {
      if (sight_images_ != nullptr) sight_images_->offer(image->pixels, image->instant);
      no_room_ += !frames_.push(follower_.frame());
    }
    if (const ColourPixels* const pixels = images_.front_colour()) keep_colours(*image, *pixels);
    images_.drop_front();
  }
}

void LiveVision::show_colours(const ColourCamera& camera) {
  colour_camera_ = &camera;
  images_.want_colour();
}

// What the writing thread did not fetch in time makes room.
void LiveVision::keep_colours(const CameraImage& image, const ColourPixels& pixels) {
  ColourOffer offer{image.instant, image.exposure, image.gain,
                    [rgb = colour_camera_->key_pixels(pixels)] { return rgb; }};
  const std::lock_guard lock(colours_mutex_);
  if (colours_.size() == kColoursMax) colours_.pop_front();
  colours_.push_back(std::move(offer));
}

std::optional<ColourOffer> LiveVision::pop_colours() {
  const std::lock_guard lock(colours_mutex_);
  if (colours_.empty()) return std::nullopt;
  ColourOffer offer = std::move(colours_.front());
  colours_.pop_front();
  return offer;
}

bool LiveVision::too_early(const CameraImage& image, RigTime now) const {
  if (!inertial_ || history_.size() == 0 || now - *image.received > kReadingsAwaited) return false;
  return history_.newest().t < image.instant;
}

std::optional<Eigen::Matrix3d> LiveVision::turned(RigTime then, RigTime now) {
  if (history_.size() == 0 || then >= now || !history_.covers(then, now, kReadingsGap)) return std::nullopt;
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  for (const InertialSpan& span : history_.spans(then, now)) R = R * Exp(span.rate_radps * span.span_s);
  return R;
}

Rejections LiveVision::rejected() const {
  Rejections rejected = images_.rejected();
  follower_.report(rejected);
  count_rejected(rejected, "features_no_room", no_room_);
  return rejected;
}

}  // namespace lxd
