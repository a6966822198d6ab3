// SPDX-License-Identifier: Apache-2.0
// How fast the wheels turn at any instant: exact from the motion, then wrong as wheels are (scale, slip).
#pragma once

#include <vector>

#include "tools/simulator/context.hpp"
#include "tools/simulator/wheel/wheel_config.hpp"

namespace lxd::sim {

struct WheelSpeeds {
  double left_mps = 0, right_mps = 0;  // rear, or only
  double front_left_mps = 0, front_right_mps = 0;
  double yaw_rate_radps = 0;  // true, about the wheel frame's z

  [[nodiscard]] double speed_mps() const { return (left_mps + right_mps) / 2; }
  [[nodiscard]] double wheel_yaw_rate_radps(double track_m) const { return (right_mps - left_mps) / track_m; }
};

class WheelMotion {
 public:
  WheelMotion(const Context& context, const WheelConfig& config);

  // Without noise.
  [[nodiscard]] WheelSpeeds at(double t_s) const;
  // What the left and the right wheel roll from begin to end, m (Gauss-Legendre, three points; exact to under a
  // micrometre over the 20 ms of a message).
  struct Ways {
    double left_m = 0, right_m = 0;
  };
  [[nodiscard]] Ways ways(double begin_s, double end_s) const;

  [[nodiscard]] double slip_s() const;  // of the whole recording, faults aside

 private:
  struct Slip {
    double begin_s, end_s;
    bool left, right;
  };
  void draw_slips();
  [[nodiscard]] double slip_factor(double t_s, bool Slip::*side) const;

  const Context& context_;
  WheelConfig config_;
  std::vector<Slip> slips_;
};

}  // namespace lxd::sim
