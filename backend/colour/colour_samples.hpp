// SPDX-License-Identifier: Apache-2.0
// What images say of the vertices of one sub-mesh: the best few of each vertex, of fixed size.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace lxd {

struct ColourSample {
  std::array<std::uint8_t, 3> rgb;  // as the image has it
  std::uint8_t weight = 0;          // 0: none
  std::uint8_t image = 0;           // its number
  std::uint8_t radius = 0;          // from the image's middle to its farthest corner, 0 .. 255
};
static_assert(sizeof(ColourSample) == 6);

inline constexpr std::size_t kSamplesPerVertex = 5;
inline constexpr std::size_t kImagesPerSubMesh = 256;

class ColourSamples {
 public:
  explicit ColourSamples(std::size_t vertices) : samples_(vertices * kSamplesPerVertex) {}

  [[nodiscard]] std::size_t vertices() const { return samples_.size() / kSamplesPerVertex; }

  // Nothing lighter is kept of this vertex any more; 0: anything is.
  [[nodiscard]] int weight_min(std::size_t vertex) const {
    const int lightest = samples_[(vertex + 1) * kSamplesPerVertex - 1].weight;
    return lightest == 0 ? 0 : lightest + 1;
  }
  // Heaviest first.
  void add(std::size_t vertex, ColourSample sample) {
    for (ColourSample& kept : std::span(samples_).subspan(vertex * kSamplesPerVertex, kSamplesPerVertex))
      if (sample.weight > kept.weight) std::swap(sample, kept);
  }

  [[nodiscard]] std::span<const ColourSample> of(std::size_t vertex) const {
    const auto all = std::span(samples_).subspan(vertex * kSamplesPerVertex, kSamplesPerVertex);
    const auto end = std::ranges::find(all, 0, &ColourSample::weight);
    return all.first(static_cast<std::size_t>(end - all.begin()));
  }

 private:
  std::vector<ColourSample> samples_;
};

}  // namespace lxd
