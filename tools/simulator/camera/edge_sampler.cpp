// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/camera/edge_sampler.hpp"

#include <algorithm>
#include <cmath>

#include "tools/simulator/camera/shading.hpp"

namespace lxd::sim {
namespace {

// In turn around the pixel: side k lies between corner k and the next.
constexpr std::array<std::array<float, 2>, 4> kCorners{{{-0.5F, -0.5F}, {0.5F, -0.5F}, {0.5F, 0.5F}, {-0.5F, 0.5F}}};
constexpr int kHalvings = 5;

constexpr std::size_t after(std::size_t corner) { return (corner + 1) % kCorners.size(); }

std::array<float, 2> on_side(std::size_t side, float part) {
  const auto &a = kCorners[side], &b = kCorners[after(side)];
  return {a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1])};
}

}  // namespace

std::span<const EdgeSampler::Result> EdgeSampler::sample(const View& view, const Sights& centres,
                                                         std::span<const std::uint32_t> pixels) {
  results_.clear();
  crossings_.clear();
  spread_.clear();
  cast_corners(view, pixels);
  for (std::size_t item = 0; item < pixels.size(); ++item) sort_out(centres, pixels[item], item);
  for (int i = 0; i < kHalvings; ++i) narrow(view, pixels);
  fill_crossed(centres, pixels);
  fill_spread(view);
  return results_;
}

Ray EdgeSampler::ray_beside(const View& view, std::uint32_t pixel, const Offset& offset) const {
  const auto width = static_cast<std::uint32_t>(table_.width());
  return view.ray(
      table_.beside(static_cast<int>(pixel % width), static_cast<int>(pixel / width), offset[0], offset[1]));
}

void EdgeSampler::cast_corners(const View& view, std::span<const std::uint32_t> pixels) {
  corners_.rays.clear();
  for (const std::uint32_t pixel : pixels) {
    for (const Offset& corner : kCorners) corners_.rays.push_back(ray_beside(view, pixel, corner));
  }
  corners_.cast(scene_);
}

// Nothing ends in the pixel, one edge crosses it, or neither.
void EdgeSampler::sort_out(const Sights& centres, std::uint32_t pixel, std::size_t item) {
  Crossing crossing{item, {}, {}};
  const std::size_t first = kCorners.size() * item;
  std::size_t beyond = 0, sides = 0, other = 0;
  bool simple = true;
  for (std::size_t k = 0; k < kCorners.size(); ++k) {
    crossing.beyond[k] = differ(centres, pixel, corners_, first + k);
    if (!crossing.beyond[k]) continue;
    if (beyond++ == 0) other = first + k;
    simple = simple && !differ(corners_, other, corners_, first + k);
  }
  if (beyond == 0) return;
  for (std::size_t k = 0; k < kCorners.size(); ++k) {
    if (crossing.beyond[k] == crossing.beyond[after(k)]) continue;
    if (sides < crossing.side.size()) crossing.side[sides] = k;
    ++sides;
  }
  if (simple && sides == crossing.side.size()) {
    crossings_.push_back(crossing);
  } else {
    spread_.push_back(pixel);
  }
}

void EdgeSampler::narrow(const View& view, std::span<const std::uint32_t> pixels) {
  fine_.rays.clear();
  for (const Crossing& c : crossings_) {
    for (std::size_t s = 0; s < c.side.size(); ++s)
      fine_.rays.push_back(ray_beside(view, pixels[c.item], on_side(c.side[s], (c.low[s] + c.high[s]) / 2)));
  }
  fine_.cast(scene_);
  std::size_t ray = 0;
  for (Crossing& c : crossings_) {
    for (std::size_t s = 0; s < c.side.size(); ++s, ++ray) {
      const bool past = differ(corners_, kCorners.size() * c.item + c.side[s], fine_, ray);
      (past ? c.high : c.low)[s] = (c.low[s] + c.high[s]) / 2;
    }
  }
}

// The area of the pixel beyond the edge: a polygon of its corners there and of the two points on its sides.
float EdgeSampler::part_beyond(const Crossing& crossing) {
  std::array<Offset, 6> polygon{};
  std::size_t count = 0, crossed = 0;
  for (std::size_t k = 0; k < kCorners.size(); ++k) {
    if (crossing.beyond[k]) polygon[count++] = kCorners[k];
    if (crossing.beyond[k] == crossing.beyond[after(k)]) continue;
    polygon[count++] = on_side(k, (crossing.low[crossed] + crossing.high[crossed]) / 2);
    ++crossed;
  }
  float twice = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto &a = polygon[i], &b = polygon[(i + 1) % count];
    twice += a[0] * b[1] - a[1] * b[0];
  }
  return std::abs(twice) / 2;
}

void EdgeSampler::fill_crossed(const Sights& centres, std::span<const std::uint32_t> pixels) {
  for (const Crossing& crossing : crossings_) {
    const std::uint32_t pixel = pixels[crossing.item];
    Eigen::Array3f here = light(centres, pixel), beyond = Eigen::Array3f::Zero();
    float rays_here = 1, rays_beyond = 0;
    for (std::size_t k = 0; k < kCorners.size(); ++k) {
      const Eigen::Array3f corner = light(corners_, kCorners.size() * crossing.item + k);
      (crossing.beyond[k] ? beyond : here) += corner;
      (crossing.beyond[k] ? rays_beyond : rays_here) += 1;
    }
    const float part = part_beyond(crossing);
    results_.push_back({pixel, (1 - part) * here / rays_here + part * beyond / rays_beyond});
  }
}

// No two points share a row or a column. Lattices are coarse along some slopes, so that every pixel has one of its own:
// what one errs by, the next does not.
std::array<EdgeSampler::Offset, EdgeSampler::kLattice> EdgeSampler::lattice(std::uint32_t pixel) {
  constexpr std::array<std::uint32_t, 4> kSteps{3, 5, 11, 13};
  const std::uint32_t chance = (pixel * 0x9E3779B1U) >> 26U;  // Knuth's multiplicative hash
  const std::uint32_t step = kSteps[chance % 4], first = chance / 4;
  const auto offset = [](std::uint32_t row) { return (static_cast<float>(row) + 0.5F) / kLattice - 0.5F; };
  std::array<Offset, kLattice> offsets{};
  for (std::uint32_t i = 0; i < kLattice; ++i) offsets[i] = {offset(i), offset((step * i + first) % kLattice)};
  return offsets;
}

void EdgeSampler::fill_spread(const View& view) {
  fine_.rays.clear();
  for (const std::uint32_t pixel : spread_) {
    for (const Offset& offset : lattice(pixel)) fine_.rays.push_back(ray_beside(view, pixel, offset));
  }
  fine_.cast(scene_);
  for (std::size_t i = 0; i < spread_.size(); ++i) {
    Eigen::Array3f sum = Eigen::Array3f::Zero();
    for (std::size_t k = kLattice * i; k < kLattice * (i + 1); ++k) sum += light(fine_, k);
    results_.push_back({spread_[i], sum / static_cast<float>(kLattice)});
  }
}

Eigen::Array3f EdgeSampler::light(const Sights& sights, std::size_t i) const {
  return radiance(scene_.world(), sights.hits[i], sights.rays[i].direction);
}

}  // namespace lxd::sim
