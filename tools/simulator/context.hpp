// SPDX-License-Identifier: Apache-2.0
// What every simulated sensor is given. One object a recording; read only, shared by the threads that write sensors.
#pragma once

#include <cstdint>

#include "rt/time.hpp"
#include "tools/simulator/faults.hpp"
#include "tools/simulator/motion/trajectory.hpp"
#include "tools/simulator/world/scene.hpp"

namespace lxd::sim {

struct Context {
  const Scene& scene;
  const Trajectory& motion;
  const FaultPlan& faults;
  std::uint64_t seed = 0;
  RigTime start;  // rig time of t = 0: the host's clock, unix time
  double duration_s = 0;

  [[nodiscard]] RigTime rig_time(double t_s) const { return start + Duration::from_seconds(t_s); }
};

inline constexpr double kGravity_mps2 = 9.80665;  // along -z of the world

}  // namespace lxd::sim
