// SPDX-License-Identifier: Apache-2.0
// By how much each image must be brightened so that what two of them show looks alike (README, "Colour").
#pragma once

#include <optional>
#include <span>

#include <Eigen/Core>

#include "backend/colour/colour_samples.hpp"

namespace lxd {

struct ImageGain {
  Eigen::Array3d log_gain = Eigen::Array3d::Zero();  // of red, green, blue; e-fold
  std::optional<double> log_exposure;                // where the camera told it
  bool settled = false;                              // stays as it is
};

// Light that a lens loses towards the corners, the same in all images: log_loss times the squared radius (0 .. 1).
struct LensFalloff {
  Eigen::Array3d log_loss = Eigen::Array3d::Zero();
  bool known = false;  // from an earlier sub-mesh
};

// images: those that the samples number.
void settle_gains(const ColourSamples& samples, std::span<ImageGain> images, LensFalloff& falloff);

// What a sample's light is multiplied by.
Eigen::Array3f compensation(const ColourSample& sample, const ImageGain& gain, const LensFalloff& falloff);

}  // namespace lxd
