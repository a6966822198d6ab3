// SPDX-License-Identifier: Apache-2.0
#include "estimator/vision/front_end/optical_flow.hpp"

#include <opencv2/video/tracking.hpp>

#include "estimator/vision/front_end/exposure.hpp"

namespace lxd {
namespace {

constexpr double kGainTolerance = 0.03;  // exposures that differ less are as good as equal
constexpr double kTextureMin = 1e-4;     // least eigenvalue of a patch, as OpenCV scales it
constexpr int kIterations = 30;
constexpr double kStep_px = 0.005;

std::vector<cv::Mat> pyramid_of(const cv::Mat& grey, const FlowConfig& config) {
  std::vector<cv::Mat> pyramid;
  cv::buildOpticalFlowPyramid(grey, pyramid, {config.window_px, config.window_px}, config.levels);
  return pyramid;
}

std::vector<cv::Mat> brighter(const FlowImage& image, double gain, const FlowConfig& config) {
  if (gain < 1 + kGainTolerance) return image.pyramid;
  cv::Mat scaled;
  image.grey.convertTo(scaled, CV_8U, gain);
  return pyramid_of(scaled, config);
}

void lucas_kanade(const std::vector<cv::Mat>& a, const std::vector<cv::Mat>& b, const FlowConfig& config,
                  const std::vector<cv::Point2f>& from, std::vector<cv::Point2f>& to, std::vector<std::uint8_t>& found,
                  std::vector<float>& difference) {
  cv::calcOpticalFlowPyrLK(a, b, from, to, found, difference, {config.window_px, config.window_px}, config.levels,
                           {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, kIterations, kStep_px},
                           cv::OPTFLOW_USE_INITIAL_FLOW, kTextureMin);
}

}  // namespace

FlowImage flow_image(const cv::Mat& grey, const FlowConfig& config) {
  return {grey, pyramid_of(grey, config), small_copy(grey)};
}

void follow(const FlowImage& before, const FlowImage& now, const FlowConfig& config,
            const std::vector<cv::Point2f>& from, std::vector<cv::Point2f>& to, std::vector<std::uint8_t>& found) {
  found.clear();
  if (from.empty()) return;
  const double gain = relative_gain(before.small, now.small);
  const auto a = brighter(before, gain, config), b = brighter(now, 1 / gain, config);
  std::vector<float> difference, ignored;
  lucas_kanade(a, b, config, from, to, found, difference);
  std::vector<cv::Point2f> back = from;
  std::vector<std::uint8_t> returned;
  lucas_kanade(b, a, config, to, back, returned, ignored);
  for (std::size_t i = 0; i < from.size(); ++i) {
    const double way = cv::norm(back[i] - from[i]);
    const bool sound = returned[i] != 0 && way < config.round_trip_px && difference[i] < config.difference;
    found[i] = static_cast<std::uint8_t>(found[i] != 0 && sound);
  }
}

}  // namespace lxd
