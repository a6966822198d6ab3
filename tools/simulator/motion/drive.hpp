// SPDX-License-Identifier: Apache-2.0
// The speed at every place of a path, and the ride along it step by step in time.
#pragma once

#include <vector>

#include "tools/simulator/motion/course.hpp"

namespace lxd::sim {

// How fast a carrier may be so that every bend and stop ahead can still be met.
class SpeedTable {
 public:
  SpeedTable(const RoutePath& path, const CourseLimits& limits);

  [[nodiscard]] double forth_mps(double u_m) const { return between(forth_, u_m); }
  [[nodiscard]] double back_mps(double u_m) const { return between(back_, u_m); }
  [[nodiscard]] double pace(double u_m) const { return between(pace_, u_m); }  // m of way per m of u

 private:
  void brake(std::vector<double>& speeds, bool forth, double along_mps2) const;
  [[nodiscard]] double between(const std::vector<double>& values, double u_m) const;

  bool closed_;
  double length_m_;
  double cell_m_;
  std::vector<double> pace_;   // at the cells' borders
  std::vector<double> forth_;  // m/s, likewise
  std::vector<double> back_;
};

struct Ride {
  std::vector<double> u_m;         // along the path, round after round
  std::vector<double> turned_rad;  // against the path's own heading
};

// `count` steps of Course::kStep_s, of which the first `resting` are at the path's start. resting == 0: at full speed
// at once. The speed's wander and all corners of the ride are the caller's to smooth.
Ride ride(const RoutePath& path, const CourseLimits& limits, std::size_t resting, std::size_t count, Random& random);

}  // namespace lxd::sim
