// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/camera/camera_faults.hpp"

#include <algorithm>
#include <array>

namespace lxd::sim {
namespace {

constexpr std::array<KnownFault, 4> kFaults{{
    {kCameraExposureJump, 2, 8, "times", "the camera's images are so many times as bright"},
    {kCameraCorrupt, 2, 0.5, "part", "so many of the camera's frames are broken off, and flagged corrupt"},
    {kCameraDrop, 10, 0.3, "part", "so many of the camera's frames are lost; their sequence numbers are missing"},
    {kCameraUnplugged, 5, 0, "", "no camera: no frames, then its sequence begins again"},
}};

constexpr double kSoundAtLeast = 0.3, kSoundAtMost = 0.6;  // of the rows
constexpr double kStripeRows = 12;
constexpr double kNoiseStripes = 0.5;

}  // namespace

std::span<const KnownFault> camera_faults() { return kFaults; }

void corrupt(PixelImage& image, Random random) {
  const std::size_t stride = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.channels);
  const auto height = static_cast<std::size_t>(image.height);
  auto row = static_cast<std::size_t>(image.height * random.uniform(kSoundAtLeast, kSoundAtMost));
  while (row < height) {
    const std::size_t end = std::min(height, row + 1 + static_cast<std::size_t>(random.uniform(0, kStripeRows)));
    const bool noise = random.chance(kNoiseStripes);
    const std::size_t shift = random.bits() % stride;
    for (; row < end; ++row) {
      std::uint8_t* const out = &image.data[row * stride];
      if (noise) {
        std::generate_n(out, stride, [&] { return static_cast<std::uint8_t>(random.bits()); });
      } else {
        const std::uint8_t* const above = &image.data[(row / 2) * stride];
        std::rotate_copy(above, above + shift, above + stride, out);
      }
    }
  }
}

}  // namespace lxd::sim
