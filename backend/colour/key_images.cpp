// SPDX-License-Identifier: Apache-2.0
#include "backend/colour/key_images.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

namespace lxd {
namespace {

// One: as much is new as a key image is worth.
constexpr double kNewTurn_rad = 10 * std::numbers::pi / 180;
constexpr double kNewDistanceMin_m = 0.5, kNewDistanceMax_m = 2;

double novelty(const Pose& a, const Pose& b, double scene_m) {
  const double cosine = std::clamp(((a.R.transpose() * b.R).trace() - 1) / 2, -1.0, 1.0);
  const double new_distance_m = std::clamp(scene_m * std::tan(kNewTurn_rad), kNewDistanceMin_m, kNewDistanceMax_m);
  return (a.p - b.p).norm() / new_distance_m + std::acos(cosine) / kNewTurn_rad;
}

}  // namespace

bool KeyImages::wants(const Pose& T_world_camera, double scene_m, RigTime begin) const {
  return std::ranges::all_of(images_, [&](const KeyImage& image) {
    return image.stamp < begin || novelty(image.T_world_camera, T_world_camera, scene_m) >= 1;
  });
}

void KeyImages::add(KeyImage image) {
  bytes_ += image.rgb.size();
  images_.push_back(std::move(image));
  while (bytes_ > bytes_max_ && !images_.empty()) drop_least();
}

// Of the two that are most alike the later one.
void KeyImages::drop_least() {
  std::size_t least = images_.size() - 1;
  double least_novelty = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < images_.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) {
      const double now = novelty(images_[k].T_world_camera, images_[i].T_world_camera, images_[i].scene_m);
      if (now >= least_novelty) continue;
      least_novelty = now;
      least = i;
    }
  bytes_ -= images_[least].rgb.size();
  images_.erase(images_.begin() + static_cast<std::ptrdiff_t>(least));
  ++dropped_;
}

std::vector<KeyImage> KeyImages::take_until(RigTime last) {
  const auto end = std::ranges::find_if(images_, [&](const KeyImage& image) { return image.stamp > last; });
  std::vector<KeyImage> taken(std::make_move_iterator(images_.begin()), std::make_move_iterator(end));
  images_.erase(images_.begin(), end);
  for (const KeyImage& image : taken) bytes_ -= image.rgb.size();
  return taken;
}

void KeyImages::clear() {
  images_.clear();
  bytes_ = 0;
}

}  // namespace lxd
