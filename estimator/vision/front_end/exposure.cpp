// SPDX-License-Identifier: Apache-2.0
#include "estimator/vision/front_end/exposure.hpp"

#include <algorithm>

#include <opencv2/imgproc.hpp>

namespace lxd {
namespace {

constexpr int kShrink = 8;
constexpr double kLowest = 8, kHighest = 247;  // grey levels between which a pixel is no end of the scale
constexpr double kBlindShare = 0.95;           // of all pixels at one end
constexpr double kContrastMin = 1.5;           // standard deviation, grey levels
constexpr double kGainShareMin = 0.1;          // of all pixels that must be sound in both images
constexpr double kGainMax = 8;

double share(const cv::Mat& mask) { return cv::countNonZero(mask) / static_cast<double>(mask.total()); }

cv::Mat sound_pixels(const cv::Mat& image) {
  cv::Mat mask;
  cv::inRange(image, kLowest, kHighest, mask);
  return mask;
}

}  // namespace

cv::Mat small_copy(const cv::Mat& grey) {
  cv::Mat out;
  cv::resize(grey, out, {std::max(1, grey.cols / kShrink), std::max(1, grey.rows / kShrink)}, 0, 0, cv::INTER_AREA);
  return out;
}

ImageFault exposure_fault(const cv::Mat& small) {
  if (share(small < kLowest) > kBlindShare) return ImageFault::dark;
  if (share(small > kHighest) > kBlindShare) return ImageFault::bright;
  cv::Scalar mean, deviation;
  cv::meanStdDev(small, mean, deviation);
  return deviation[0] < kContrastMin ? ImageFault::flat : ImageFault::kCount;
}

double relative_gain(const cv::Mat& before, const cv::Mat& now) {
  const cv::Mat both = sound_pixels(before) & sound_pixels(now);
  if (share(both) < kGainShareMin) return 1;
  return std::clamp(cv::mean(now, both)[0] / cv::mean(before, both)[0], 1 / kGainMax, kGainMax);
}

}  // namespace lxd
