// SPDX-License-Identifier: Apache-2.0
// A spinning LiDAR in a box of planes, ray-cast exactly: sweeps of a carrier that moves as its state says, and an
// odometry small enough for a test.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "estimator/odometry.hpp"
#include "estimator/propagation.hpp"
#include "tests/support/estimator_states.hpp"
#include "tests/support/mapping_scene.hpp"

namespace lxd::test {

// Axis-aligned walls seen from inside; a wall can be left out, then rays leave there.
struct Room {
  Eigen::Vector3d low_m{-5, -4, -1.5}, high_m{5.2, 4.4, 1.7};
  std::array<bool, 6> open{};  // low x, y, z, high x, y, z

  // Way along the unit direction to the first wall.
  [[nodiscard]] std::optional<double> range_m(const Eigen::Vector3d& from, const Eigen::Vector3d& direction) const {
    double nearest = std::numeric_limits<double>::infinity();
    int wall = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (direction[axis] == 0) continue;
      const bool up = direction[axis] > 0;
      const double way = ((up ? high_m : low_m)[axis] - from[axis]) / direction[axis];
      if (way >= nearest) continue;
      nearest = way;
      wall = axis + (up ? 3 : 0);
    }
    if (open[wall]) return std::nullopt;
    return nearest;
  }
};

inline Room corridor_x() { return {{-200, -1.6, -1.5}, {200, 1.8, 1.4}, {}}; }

inline Room floor_only() { return {{-500, -500, -1.5}, {500, 500, 500}, {true, true, false, true, true, true}}; }

inline constexpr Duration kSweepSpan = Duration::from_ns(100'000'000);
inline constexpr int kBeams = 24, kColumns = 240;  // unless the test wants more
inline constexpr double kHighestBeam_rad = 0.6;    // and as low
inline constexpr double kRangeSigma_m = 0.01;

// Sweeps that a carrier on its way would see, one after the other; the body is the LiDAR.
class RoomSweeps {
 public:
  explicit RoomSweeps(const Room& walls = {}, unsigned seed = 1) : room(walls), chance_(seed) {}

  // The sweep that begins at `begin_ns` when the carrier's state then is `x`, and goes on steadily.
  const Sweep& next(const State& x, std::int64_t begin_ns) {
    return next_along([&](double offset_s) { return propagate(x, offset_s).pose(); }, begin_ns);
  }
  // Of a carrier whose pose is pose_at(seconds after the sweep's begin).
  template <typename PoseAt>
  const Sweep& next_along(PoseAt&& pose_at, std::int64_t begin_ns) {
    points_.clear();
    for (int column = 0; column < columns; ++column) {
      const auto offset_ns = static_cast<std::uint32_t>(kSweepSpan.ns() * column / (columns - 1));
      const Pose then = pose_at(offset_ns * 1e-9);
      const double azimuth = 2 * std::numbers::pi * column / columns;
      for (int beam = 0; beam < beams; ++beam) fire(then, azimuth, beam, offset_ns);
    }
    return finish(begin_ns);
  }

  // The same sweep with other points.
  const Sweep& with_points(std::vector<LidarPoint> points, std::int64_t begin_ns) {
    points_ = std::move(points);
    return finish(begin_ns);
  }
  [[nodiscard]] const std::vector<LidarPoint>& points() const { return points_; }

  Room room;
  double sigma_m = kRangeSigma_m;
  int beams = kBeams, columns = kColumns;

 private:
  void fire(const Pose& then, double azimuth, int beam, std::uint32_t offset_ns) {
    const double elevation = kHighestBeam_rad * (2.0 * beam / (beams - 1) - 1);
    const Eigen::Vector3d ray(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                              std::sin(elevation));
    const auto way = room.range_m(then.p, then.R * ray);
    if (!way) return;
    const Eigen::Vector3f q = ((*way + chance_.normal(sigma_m)) * ray).cast<float>();
    points_.push_back({q.x(), q.y(), q.z(), 1.0F, offset_ns});
  }
  const Sweep& finish(std::int64_t begin_ns) {
    sweep_.begin = RigTime::from_ns(begin_ns);
    sweep_.end = sweep_.stamp = sweep_.begin + kSweepSpan;
    sweep_.storage = points_;
    sweep_.count = static_cast<std::uint32_t>(points_.size());
    return sweep_;
  }

  StateChance chance_;
  std::vector<LidarPoint> points_;
  Sweep sweep_;
};

inline constexpr std::uint32_t kSweepPointsMax = kBeams * kColumns;

inline OdometrySetup small_setup(std::uint32_t points_max = kSweepPointsMax) {
  OdometrySetup setup;
  setup.estimator.range_sigma_m = kRangeSigma_m;
  setup.map.fine = {6000, 8000, 4000, points_max};
  setup.map.coarse = {1000, 1500, 1000, points_max};
  setup.registration_capacity = 4000;
  return setup;
}

// An odometry with its memory.
class OwnedOdometry {
 public:
  explicit OwnedOdometry(const OdometrySetup& setup = small_setup())
      : arena_(std::size_t{64} << 20), odometry(setup, *arena_) {}
  Odometry* operator->() { return &odometry; }

 private:
  OwnedArena arena_;

 public:
  Odometry odometry;
};

}  // namespace lxd::test
