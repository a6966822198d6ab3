// SPDX-License-Identifier: Apache-2.0
// The light of pixels in which surfaces end: how much of the pixel each of them fills. Where one edge crosses a pixel,
// it is found on the pixel's sides by bisection; where more happens, rays are spread over the pixel.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tools/simulator/camera/ray_table.hpp"
#include "tools/simulator/camera/sights.hpp"

namespace lxd::sim {

// Keeps its working memory; scene and table must outlive it.
class EdgeSampler {
 public:
  struct Result {
    std::uint32_t pixel;
    Eigen::Array3f radiance;
  };

  EdgeSampler(const Scene& scene, const RayTable& table) : scene_(scene), table_(table) {}

  // `centres` are of all pixels. Pixels that turn out to be of one surface are not among the results, which are valid
  // until the next call.
  std::span<const Result> sample(const View& view, const Sights& centres, std::span<const std::uint32_t> pixels);

 private:
  using Offset = std::array<float, 2>;  // from a pixel's centre, pixels
  // One edge through a pixel: it crosses two sides, each between `low` and `high`, parts of the side.
  struct Crossing {
    std::size_t item;  // of the pixels at hand
    std::array<bool, 4> beyond;
    std::array<std::size_t, 2> side;
    std::array<float, 2> low{0, 0}, high{1, 1};
  };
  static constexpr std::size_t kLattice = 16;
  static std::array<Offset, kLattice> lattice(std::uint32_t pixel);

  [[nodiscard]] Ray ray_beside(const View& view, std::uint32_t pixel, const Offset& offset) const;
  void cast_corners(const View& view, std::span<const std::uint32_t> pixels);
  void sort_out(const Sights& centres, std::uint32_t pixel, std::size_t item);
  void narrow(const View& view, std::span<const std::uint32_t> pixels);
  [[nodiscard]] static float part_beyond(const Crossing& crossing);
  void fill_crossed(const Sights& centres, std::span<const std::uint32_t> pixels);
  void fill_spread(const View& view);
  [[nodiscard]] Eigen::Array3f light(const Sights& sights, std::size_t i) const;

  const Scene& scene_;
  const RayTable& table_;
  Sights corners_, fine_;
  std::vector<Crossing> crossings_;
  std::vector<std::uint32_t> spread_;
  std::vector<Result> results_;
};

}  // namespace lxd::sim
