// SPDX-License-Identifier: Apache-2.0
#include "estimator/vision/front_end/corner_detector.hpp"

#include <algorithm>

#include <opencv2/imgproc.hpp>

namespace lxd {
namespace {

constexpr int kBlock_px = 5;  // over which a corner's gradients are summed
constexpr int kPeak_px = 5;   // a corner is the best of as many pixels around

struct Corner {
  float response;
  cv::Point place;
};

bool stronger(const Corner& a, const Corner& b) {
  if (a.response != b.response) return a.response > b.response;
  return a.place.y != b.place.y ? a.place.y < b.place.y : a.place.x < b.place.x;
}

// Which pixels are peaks of the response, above the threshold.
cv::Mat peaks_of(const cv::Mat& response, double threshold) {
  cv::Mat highest;
  cv::dilate(response, highest, cv::getStructuringElement(cv::MORPH_RECT, {kPeak_px, kPeak_px}));
  return (response == highest) & (response > threshold);
}

// Hands out places of one image and keeps those taken apart.
class Ground {
 public:
  Ground(cv::Size size, const CornerConfig& config) : config_(config), free_(size, CV_8U, cv::Scalar(0)) {
    const int border = config.border_px;
    const cv::Rect inside(border, border, size.width - 2 * border, size.height - 2 * border);
    if (inside.width > 0 && inside.height > 0) free_(inside).setTo(1);
  }
  void take(const cv::Point& place) { cv::circle(free_, place, config_.spacing_px, cv::Scalar(0), cv::FILLED); }
  [[nodiscard]] bool is_free(const cv::Point& place) const { return free_.at<std::uint8_t>(place) != 0; }

 private:
  const CornerConfig& config_;
  cv::Mat free_;
};

std::vector<Corner> corners_in(const cv::Mat& response, const cv::Mat& peaks, const cv::Rect& bucket) {
  std::vector<Corner> corners;
  for (int y = bucket.y; y < bucket.y + bucket.height; ++y)
    for (int x = bucket.x; x < bucket.x + bucket.width; ++x)
      if (peaks.at<std::uint8_t>(y, x) != 0) corners.push_back({response.at<float>(y, x), {x, y}});
  std::sort(corners.begin(), corners.end(), stronger);
  return corners;
}

}  // namespace

std::vector<cv::Point2f> new_corners(const cv::Mat& grey, const std::vector<cv::Point2f>& tracked,
                                     const CornerConfig& config) {
  Ground ground(grey.size(), config);
  for (const cv::Point2f& point : tracked) ground.take(point);
  cv::Mat response;
  cv::cornerMinEigenVal(grey, response, kBlock_px);
  double best = 0;
  cv::minMaxLoc(response, nullptr, &best);
  const cv::Mat peaks = peaks_of(response, std::max(config.quality * best, config.response_min));
  const int quota = (config.wanted + config.columns * config.rows - 1) / (config.columns * config.rows);
  std::vector<cv::Point2f> out;
  for (int i = 0; i < config.columns * config.rows; ++i) {
    const int column = i % config.columns, row = i / config.columns;
    const cv::Rect bucket(cv::Point(grey.cols * column / config.columns, grey.rows * row / config.rows),
                          cv::Point(grey.cols * (column + 1) / config.columns, grey.rows * (row + 1) / config.rows));
    auto room = quota - std::count_if(tracked.begin(), tracked.end(),
                                      [&](const cv::Point2f& p) { return bucket.contains(cv::Point(p)); });
    for (const Corner& corner : corners_in(response, peaks, bucket)) {
      if (room <= 0) break;
      if (!ground.is_free(corner.place)) continue;
      ground.take(corner.place);
      out.emplace_back(corner.place);
      --room;
    }
  }
  return out;
}

}  // namespace lxd
