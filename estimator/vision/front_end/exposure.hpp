// SPDX-License-Identifier: Apache-2.0
// Is there anything to see in an image, and how much brighter is it than another? Vision thread.
#pragma once

#include <cstdint>

#include <opencv2/core.hpp>

namespace lxd {

enum class ImageFault : std::uint8_t {
  empty,         // no pixels
  size_changed,  // another size than the camera has
  not_newer,     // its stamp is not after the last one's (one from long before it begins anew)
  dark,          // under-exposed: nearly all pixels at the lower end
  bright,        // over-exposed: nearly all at the upper end
  flat,          // no contrast
  kCount
};

// About 1/8 of the size, each pixel the mean of those it covers.
cv::Mat small_copy(const cv::Mat& grey);

// dark, bright, flat; kCount: sound.
ImageFault exposure_fault(const cv::Mat& small);

// How many times brighter `now` is than `before`, by pixels that are saturated in neither; 1 when there are too few.
// Both small: what the camera moved by is little there.
double relative_gain(const cv::Mat& before, const cv::Mat& now);

}  // namespace lxd
