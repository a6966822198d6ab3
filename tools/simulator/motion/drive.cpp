// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/motion/drive.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/simulator/motion/wander.hpp"

namespace lxd::sim {
namespace {

constexpr double kCell_m = 0.05;
constexpr double kLeastSpeed_mps = 0.02;  // round the sharpest corner
constexpr double kArrived_m = 1e-4;
constexpr double kPause_s = 0.1;  // beside what the smoothing takes
constexpr double kSpeedLow_hz = 0.02, kSpeedHigh_hz = 0.2;
constexpr double kWanderReach = 2;  // of its deviation; beyond it is cut off

double bend_speed(const RoutePath::Point& point, const CourseLimits& limits) {
  const double bend = std::abs(point.bend_per_m());
  const double slide = std::sqrt(limits.across_mps2 / std::max(point.d2.norm() / point.d1.squaredNorm(), 1e-9));
  const double swing = limits.turn_radps / std::max(bend, 1e-9);
  return std::clamp(std::min(slide, swing), kLeastSpeed_mps, limits.speed_mps);
}

// What the ride is doing.
class Rider {
 public:
  Rider(const RoutePath& path, const CourseLimits& limits, bool moving, Random& random)
      : path_(path),
        limits_(limits),
        table_(path, limits),
        wander_(random, kSpeedLow_hz, kSpeedHigh_hz),
        speed_mps_(moving ? table_.forth_mps(0) : 0) {}

  void step(double t_s) {
    if (pause_s_ > 0) return pause();
    if (std::abs(turn_left_rad_) > 0) return turn();
    go(t_s);
  }
  [[nodiscard]] double u_m() const { return u_m_; }
  [[nodiscard]] double turned_rad() const { return turned_rad_; }

 private:
  void pause() { pause_s_ -= Course::kStep_s; }

  void turn() {
    const double step = std::min(turn_left_rad_, limits_.turn_radps / 2 * Course::kStep_s);
    turn_left_rad_ -= step;
    turned_rad_ += (forth_ ? -1 : 1) * step;
    if (turn_left_rad_ > 0) return;
    turned_rad_ = forth_ ? 0 : std::numbers::pi;
    pause_s_ = limits_.easing_s + kPause_s;
  }

  void go(double t_s) {
    const double slower = limits_.speed_change * (1 + std::clamp(wander_(t_s) / kWanderReach, -1.0, 1.0)) / 2;
    const double wanted = (1 - slower) * (forth_ ? table_.forth_mps(u_m_) : table_.back_mps(u_m_));
    speed_mps_ = std::min(wanted, speed_mps_ + limits_.along_mps2 * Course::kStep_s);
    u_m_ += (forth_ ? 1 : -1) * speed_mps_ * Course::kStep_s / table_.pace(u_m_);
    if (!path_.closed() && (forth_ ? path_.length_m() - u_m_ : u_m_) < kArrived_m) arrive();
  }

  void arrive() {
    u_m_ = forth_ ? path_.length_m() : 0;
    speed_mps_ = 0;
    if (!limits_.turns_on_the_spot) {
      pause_s_ = std::numeric_limits<double>::infinity();
      return;
    }
    forth_ = !forth_;
    pause_s_ = limits_.easing_s + kPause_s;
    turn_left_rad_ = std::numbers::pi;
  }

  const RoutePath& path_;
  const CourseLimits& limits_;
  SpeedTable table_;
  Wander wander_;
  double speed_mps_;
  double u_m_ = 0;
  double turned_rad_ = 0;
  double turn_left_rad_ = 0;
  double pause_s_ = 0;
  bool forth_ = true;
};

}  // namespace

SpeedTable::SpeedTable(const RoutePath& path, const CourseLimits& limits)
    : closed_(path.closed()), length_m_(path.length_m()) {
  const double cells = std::ceil(length_m_ / kCell_m);
  cell_m_ = length_m_ / cells;
  std::vector<double> bends;
  for (double i = 0; i <= cells; ++i) {
    const RoutePath::Point point = path.at(i * cell_m_);
    pace_.push_back(std::max(point.d1.norm(), kCell_m));
    bends.push_back(bend_speed(point, limits));
  }
  forth_ = back_ = bends;
  brake(forth_, true, limits.along_mps2);
  brake(back_, false, limits.along_mps2);
}

// From the far end of the way back to its start, as fast as braking allows. A round is braked for twice: for the
// bends after its end.
void SpeedTable::brake(std::vector<double>& speeds, bool forth, double along_mps2) const {
  const std::size_t cells = speeds.size() - 1;
  const auto place = [&](std::size_t i) { return forth ? cells - i : i; };
  if (!closed_) speeds[place(0)] = 0;
  for (int round = 0; round < (closed_ ? 2 : 1); ++round) {
    if (round > 0) speeds[place(0)] = std::min(speeds[place(0)], speeds[place(cells)]);
    for (std::size_t i = 1; i <= cells; ++i) {
      const double next = speeds[place(i - 1)];
      speeds[place(i)] =
          std::min(speeds[place(i)], std::sqrt(next * next + 2 * along_mps2 * cell_m_ * pace_[place(i)]));
    }
  }
}

double SpeedTable::between(const std::vector<double>& values, double u_m) const {
  const double u = closed_ ? u_m - length_m_ * std::floor(u_m / length_m_) : std::clamp(u_m, 0.0, length_m_);
  const std::size_t cell = std::min(static_cast<std::size_t>(u / cell_m_), values.size() - 2);
  const double part = u / cell_m_ - static_cast<double>(cell);
  return (1 - part) * values[cell] + part * values[cell + 1];
}

Ride ride(const RoutePath& path, const CourseLimits& limits, std::size_t resting, std::size_t count, Random& random) {
  Rider rider(path, limits, resting == 0, random);
  Ride ride;
  for (std::size_t i = 0; i < count; ++i) {
    ride.u_m.push_back(rider.u_m());
    ride.turned_rad.push_back(rider.turned_rad());
    if (i >= resting) rider.step(static_cast<double>(i) * Course::kStep_s);
  }
  return ride;
}

}  // namespace lxd::sim
