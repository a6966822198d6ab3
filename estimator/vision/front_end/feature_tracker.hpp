// SPDX-License-Identifier: Apache-2.0
// The visual front-end: corners found in one image are followed through the next ones, and new ones take the places of
// those that are lost. Vision thread only; may allocate.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "estimator/vision/camera_model.hpp"
#include "estimator/vision/feature_frame.hpp"
#include "estimator/vision/feature_prediction.hpp"
#include "estimator/vision/front_end/corner_detector.hpp"
#include "estimator/vision/front_end/exposure.hpp"
#include "estimator/vision/front_end/optical_flow.hpp"
#include "rt/counters.hpp"
#include "rt/time.hpp"

namespace lxd {

// Eight bits a pixel; the pixels are the caller's.
struct GreyImage {
  RigTime stamp;
  std::uint32_t width = 0, height = 0;
  std::size_t stride = 0;  // bytes from row to row
  std::span<const std::uint8_t> pixels;
};

struct TrackerConfig {
  CornerConfig corners;
  FlowConfig flow;
  Duration gap_max = Duration::from_ns(kNanosPerSecond / 2);  // images farther apart are not compared
};

class FeatureTracker {
 public:
  FeatureTracker(const CameraModel& camera, const TrackerConfig& config);

  // The features of the next image: those followed first, oldest tracks first, then new ones. Predictions may be for
  // some features or none; the others are sought where they were. False: the image is not fit for use, which is
  // counted; tracks wait for the next one up to gap_max.
  bool track(const GreyImage& image, std::span<const PredictedPixel> predictions, FeatureFrame& frame);

  [[nodiscard]] const Counters<ImageFault>& faults() const { return faults_; }

  // Every track is forgotten.
  void clear();

 private:
  struct Track {
    std::uint32_t id, age;
    cv::Point2f pixel;
  };

  [[nodiscard]] ImageFault fault_of(const GreyImage& image) const;
  void follow_tracks(const FlowImage& now, std::span<const PredictedPixel> predictions);
  void thin_out();
  void add_new(const cv::Mat& grey);
  void publish(RigTime stamp, FeatureFrame& frame) const;

  CameraModel camera_;
  TrackerConfig config_;
  std::vector<Track> tracks_;
  std::optional<FlowImage> last_;
  std::optional<RigTime> last_stamp_;  // of the last image that was fit for use
  std::uint32_t next_id_ = 1;
  Counters<ImageFault> faults_;
};

}  // namespace lxd
