// SPDX-License-Identifier: Apache-2.0
// Points of one image found again in the next: pyramidal Lucas-Kanade (Bouguet 2000) there and back. Vision thread.
#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

namespace lxd {

struct FlowConfig {
  int window_px = 21;          // edge of the patch that is compared
  int levels = 3;              // halvings of the image above the full one
  double round_trip_px = 0.5;  // a point that does not come back so near is lost
  double difference = 25;      // grey levels that a patch may differ from itself on average
};

// An image as the flow wants it.
struct FlowImage {
  cv::Mat grey;
  std::vector<cv::Mat> pyramid;
  cv::Mat small;  // small_copy
};

FlowImage flow_image(const cv::Mat& grey, const FlowConfig& config);

// `to` comes with a first guess for each of `from` and leaves with the place found; found[i] 0: lost. Images of
// different exposure are brought to the brighter one's first.
void follow(const FlowImage& before, const FlowImage& now, const FlowConfig& config,
            const std::vector<cv::Point2f>& from, std::vector<cv::Point2f>& to, std::vector<std::uint8_t>& found);

}  // namespace lxd
