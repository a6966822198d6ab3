// SPDX-License-Identifier: Apache-2.0
#include "backend/loops/scan_context.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace lxd {
namespace {

constexpr float kNothing = -std::numeric_limits<float>::infinity();
constexpr float kCeilingNormal = -0.7F;  // z of normals that look down: ceilings, which all rooms have

struct Grid {
  std::array<float, kContextBins> top_m;  // relative to the key frame; kNothing: no surface
  std::array<float, kContextBins> confidence_pm2;
};

// Which ring and sector a place relative to the key frame lies in.
class PolarBins {
 public:
  explicit PolarBins(const ContextConfig& config)
      : min2_m2_(config.radius_min_m * config.radius_min_m),
        max2_m2_(config.radius_max_m * config.radius_max_m),
        rings_per_log_(kContextRings / std::log(max2_m2_ / min2_m2_)) {}

  [[nodiscard]] bool find(const Eigen::Vector3d& d_m, std::size_t& bin) const {
    const double r2 = d_m.head<2>().squaredNorm();
    if (!(r2 < max2_m2_)) return false;
    const int ring = r2 <= min2_m2_ ? 0 : static_cast<int>(std::log(r2 / min2_m2_) * rings_per_log_);
    const double turns = std::atan2(d_m.y(), d_m.x()) / (2 * std::numbers::pi) + 1;
    const int sector = static_cast<int>(turns * kContextSectors) % kContextSectors;
    bin = ScanContext::bin(std::min(ring, kContextRings - 1), sector);
    return true;
  }

 private:
  double min2_m2_, max2_m2_, rings_per_log_;
};

Grid project(std::span<const Surfel> surfels, const Eigen::Vector3d& place_m, const ContextConfig& config) {
  Grid grid;
  grid.top_m.fill(kNothing);
  grid.confidence_pm2.fill(0);
  const PolarBins bins(config);
  for (const Surfel& s : surfels) {
    if (s.normal.z() < kCeilingNormal) continue;
    const Eigen::Vector3d d = s.position_m.cast<double>() - place_m;
    std::size_t bin = 0;
    if (!bins.find(d, bin)) continue;
    grid.top_m[bin] = std::max(grid.top_m[bin], static_cast<float>(d.z()));
    grid.confidence_pm2[bin] += s.confidence_pm2;
  }
  return grid;
}

std::uint8_t to_byte(double x) { return static_cast<std::uint8_t>(std::clamp(std::lround(x), 0L, 255L)); }

void describe_bin(const Grid& grid, std::size_t bin, double ground_m, const ContextConfig& config, ScanContext& out) {
  const double above_m = static_cast<double>(grid.top_m[bin]) - ground_m;
  const double octaves = std::log2(1 + static_cast<double>(grid.confidence_pm2[bin])) - ScanContext::kDensityOffset;
  out.height[bin] = to_byte(above_m / ScanContext::kHeightStep_m);
  out.density[bin] = to_byte(octaves / ScanContext::kDensityStep);
  out.visibility[bin] = above_m > config.obstacle_min_m ? Visibility::occupied : Visibility::free;
}

// The 2.5-D ray of one sector, from outside inwards: what lies before a surface that was met is free.
void cast_sector(const Grid& grid, int sector, double ground_m, const ContextConfig& config, ScanContext& out) {
  bool met = false;
  for (int ring = kContextRings - 1; ring >= 0; --ring) {
    const std::size_t bin = ScanContext::bin(ring, sector);
    if (grid.top_m[bin] > kNothing) {
      describe_bin(grid, bin, ground_m, config, out);
      met = true;
    } else if (met) {
      out.visibility[bin] = Visibility::free;
    }
  }
}

}  // namespace

double height_above_ground_m(std::span<const Surfel> surfels, const Eigen::Vector3d& place_m) {
  constexpr double kNear_m = 8, kPercentile = 0.1;  // low, but not of the few that are below the ground
  std::vector<double> depths_m;
  for (const Surfel& s : surfels) {
    const Eigen::Vector3d d = s.position_m.cast<double>() - place_m;
    if (d.head<2>().squaredNorm() < kNear_m * kNear_m && d.z() < 0) depths_m.push_back(-d.z());
  }
  if (depths_m.empty()) return 0;
  const auto rank =
      depths_m.begin() + static_cast<std::ptrdiff_t>((1 - kPercentile) * static_cast<double>(depths_m.size() - 1));
  std::nth_element(depths_m.begin(), rank, depths_m.end());
  return *rank;
}

ScanContext make_scan_context(std::span<const Surfel> surfels, const Eigen::Vector3d& place_m,
                              const ContextConfig& config) {
  const Grid grid = project(surfels, place_m, config);
  const double ground_m = -height_above_ground_m(surfels, place_m);
  ScanContext out;
  for (int sector = 0; sector < kContextSectors; ++sector) cast_sector(grid, sector, ground_m, config, out);
  return out;
}

Visibility visibility_at(const ScanContext& context, const Eigen::Vector3d& d_m, const ContextConfig& config) {
  std::size_t bin = 0;
  return PolarBins(config).find(d_m, bin) ? context.visibility[bin] : Visibility::unknown;
}

RingKey ring_key(const ScanContext& context) {
  RingKey key{};
  for (int ring = 0; ring < kContextRings; ++ring) {
    int sum = 0, seen = 0;
    for (int sector = 0; sector < kContextSectors; ++sector) {
      const std::size_t bin = ScanContext::bin(ring, sector);
      if (context.visibility[bin] == Visibility::unknown) continue;
      sum += context.height[bin];
      ++seen;
    }
    const double mean_m = seen > 0 ? ScanContext::kHeightStep_m * sum / seen : 0.0;
    key[static_cast<std::size_t>(ring)] = static_cast<float>(mean_m);
  }
  return key;
}

}  // namespace lxd
