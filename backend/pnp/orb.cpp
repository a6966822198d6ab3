// SPDX-License-Identifier: Apache-2.0
#include "backend/pnp/orb.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

namespace lxd {
namespace {

constexpr int kLevels = 8;
constexpr float kScale = 1.2F;         // between levels of the pyramid, as ORB has it
constexpr int kPatch_px = 31;          // at its level
constexpr int kRadius_px = 15;         // of the orientation's disc
constexpr int kBorder_px = 20;         // the turned patch and its smoothing stay within
constexpr float kReference_m = 12.0F;  // a thing this far away or farther is described at the full image

// Nearer things are seen larger and described at a coarser level.
int level_of(float distance_m) {
  if (!(distance_m > 0)) return 0;
  return std::clamp(static_cast<int>(std::lround(std::log(kReference_m / distance_m) / std::log(kScale))), 0,
                    kLevels - 1);
}

// Direction from the centre of the patch to its centre of brightness (Rosin), degrees.
float orientation_deg(const cv::Mat& level, int x, int y) {
  int mx = 0, my = 0;
  for (int dy = -kRadius_px; dy <= kRadius_px; ++dy) {
    const auto* row = level.ptr<std::uint8_t>(y + dy);
    const int reach = static_cast<int>(std::sqrt(kRadius_px * kRadius_px - dy * dy));
    for (int dx = -reach; dx <= reach; ++dx) {
      mx += dx * row[x + dx];
      my += dy * row[x + dx];
    }
  }
  return cv::fastAtan2(static_cast<float>(my), static_cast<float>(mx));
}

std::vector<cv::Mat> pyramid_of(const cv::Mat& image) {
  std::vector<cv::Mat> out{image};
  for (int i = 1; i < kLevels; ++i) {
    const double shrink = 1 / std::pow(static_cast<double>(kScale), i);
    cv::Mat level;
    cv::resize(image, level, {}, shrink, shrink, cv::INTER_LINEAR);
    out.push_back(level);
  }
  return out;
}

bool inside(const cv::Mat& level, int x, int y) {
  return x >= kBorder_px && y >= kBorder_px && x < level.cols - kBorder_px && y < level.rows - kBorder_px;
}

cv::KeyPoint key_point(const OrbPoint& point, const std::vector<cv::Mat>& pyramid, int index) {
  int octave = level_of(point.distance_m);
  const auto at = [&](float x) { return static_cast<int>(std::lround(x / std::pow(kScale, octave))); };
  while (octave > 0 && !inside(pyramid[static_cast<std::size_t>(octave)], at(point.pixel.x()), at(point.pixel.y())))
    --octave;
  const cv::Mat& level = pyramid[static_cast<std::size_t>(octave)];
  const int x = at(point.pixel.x()), y = at(point.pixel.y());
  const float turn_deg = inside(level, x, y) ? orientation_deg(level, x, y) : 0;
  const float size_px = static_cast<float>(kPatch_px) * std::pow(kScale, static_cast<float>(octave));
  return {point.pixel.x(), point.pixel.y(), size_px, turn_deg, 1, octave, index};
}

}  // namespace

std::vector<std::optional<OrbDescriptor>> describe(const OrbImage& image, std::span<const OrbPoint> points) {
  std::vector<std::optional<OrbDescriptor>> out(points.size());
  if (image.width <= 2 * kBorder_px || image.height <= 2 * kBorder_px) return out;
  // OpenCV has no matrix of constant pixels; it does not write to what it describes.
  const cv::Mat full(image.height, image.width, CV_8U, const_cast<std::uint8_t*>(image.pixels),
                     static_cast<std::size_t>(image.stride));
  const std::vector<cv::Mat> pyramid = pyramid_of(full);
  std::vector<cv::KeyPoint> key_points;
  for (std::size_t i = 0; i < points.size(); ++i)
    key_points.push_back(key_point(points[i], pyramid, static_cast<int>(i)));
  cv::Mat descriptors;
  const auto orb = cv::ORB::create(static_cast<int>(points.size()), kScale, kLevels, kPatch_px, 0, 2,
                                   cv::ORB::HARRIS_SCORE, kPatch_px);
  orb->compute(full, key_points, descriptors);
  for (std::size_t row = 0; row < key_points.size(); ++row) {
    OrbDescriptor& d = out[static_cast<std::size_t>(key_points[row].class_id)].emplace();
    std::copy_n(descriptors.ptr<std::uint8_t>(static_cast<int>(row)), d.size(), d.begin());
  }
  return out;
}

}  // namespace lxd
