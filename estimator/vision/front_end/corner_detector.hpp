// SPDX-License-Identifier: Apache-2.0
// New features where an image has too few: the best corners of each bucket (Shi & Tomasi 1994). Vision thread.
#pragma once

#include <vector>

#include <opencv2/core.hpp>

namespace lxd {

struct CornerConfig {
  int columns = 8, rows = 6;   // buckets of the image
  int wanted = 180;            // features of a whole image
  int spacing_px = 14;         // no nearer to another feature
  int border_px = 12;          // and to the image's edge
  double quality = 0.01;       // of the image's best corner
  double response_min = 4e-5;  // least eigenvalue of a corner, as OpenCV scales it: weaker ones are noise
};

// Corners to add to those that are tracked already, best first in each bucket.
std::vector<cv::Point2f> new_corners(const cv::Mat& grey, const std::vector<cv::Point2f>& tracked,
                                     const CornerConfig& config);

}  // namespace lxd
