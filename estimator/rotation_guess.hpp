// SPDX-License-Identifier: Apache-2.0
// Rotation between two consecutive sweeps from their range images (paper, "Range Image Shift Orientation Propagation"),
// sought around a prediction: yaw first, over a wide range, by shifting columns; then all three axes and the
// translation together by least squares on the image. One row shift for a whole image would be right for a narrow view
// only: over 360 degrees pitch and roll move the rows by a sinusoid of the azimuth (design 6.3), which the fit over
// rotations has.
//
// Work is bounded by constants; storage is taken at construction. estimator/README.md derives the rows of the fit.
#pragma once

#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "estimator/range_image.hpp"
#include "rt/arena.hpp"

namespace lxd {

// A return of the present sweep, where the prediction puts it.
struct GuessSample {
  Eigen::Vector3f p_m;  // in the LiDAR's frame at the previous sweep's end
  float elapsed;        // of the time between the two sweeps' ends: the share of the motion that had happened, 0..1
};

struct RotationGuessResult {
  bool valid = false;
  // The present sweep's end is predicted wrongly by Exp(rotation) on the left, then translation, both in the LiDAR's
  // frame at the previous sweep's end: rad and m.
  Eigen::Vector3d rotation_rad = Eigen::Vector3d::Zero();
  Eigen::Vector3d translation_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // of the rotation, rad^2
  double inlier_share = 0;                               // of all samples
};

using RangeErrorRow = Eigen::Matrix<float, 6, 1>;  // by rotation and translation, 1/rad and 1/m

// How much farther a return at x is than the previous sweep saw in its direction, relative to that: |x| I(x) - 1; and
// its derivative by a turn on the left and a translation, of which `elapsed` moves x. False: nothing was seen there.
bool range_error(const RangeImage& previous, const Eigen::Vector3f& x_m, float elapsed, float& error,
                 RangeErrorRow& row);

class RotationGuess {
 public:
  static constexpr std::size_t kSamplesMax = 768;
  static constexpr std::size_t kImagePointsMax = 20000;

  explicit RotationGuess(Arena& arena);

  [[nodiscard]] RangeImage& previous() { return previous_; }

  // How well the motion between the two sweeps is predicted. The yaw is sought over three sigmas of it, 24 degrees at
  // least: all round when nothing is known of it.
  struct Doubt {
    double translation_sigma_m, yaw_sigma_rad;
  };
  [[nodiscard]] RotationGuessResult seek(std::span<const GuessSample> samples, const Doubt& doubt) noexcept;

 private:
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  using Matrix6 = Eigen::Matrix<double, 6, 6>;

  // Sums of the weighted normal equations of one iteration; errors are relative, of the range.
  struct Fit {
    Eigen::Matrix<float, 6, 6> information = Eigen::Matrix<float, 6, 6>::Zero();
    RangeErrorRow gradient = RangeErrorRow::Zero();
    float weight = 0, scale = 0;  // scale: robust standard deviation of the errors
    std::size_t seen = 0, inliers = 0;
  };

  [[nodiscard]] double seek_yaw(std::span<const GuessSample> samples, int columns) const;
  Fit measure(std::span<const GuessSample> samples, const Eigen::Vector3d& rotation, const Eigen::Vector3d& translation,
              float kernel);
  bool step(const Fit& fit, double translation_sigma_m, RotationGuessResult& out);
  void judge(const Fit& fit, std::size_t samples, RotationGuessResult& out) const;

  RangeImage previous_;
  std::span<Spherical> polar_;
  std::span<float> errors_;
  Eigen::Matrix3d held_ = Eigen::Matrix3d::Zero();  // information on the rotation, translation marginalised
};

}  // namespace lxd
