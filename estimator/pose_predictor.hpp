// SPDX-License-Identifier: Apache-2.0
// The state at the rate of the IMU: the filter's last one, carried on over the readings that came since. For whoever
// steers by it: a sweep's pose is a period old when it is known. One thread; memory from the arena.
#pragma once

#include <optional>

#include "estimator/imu_history.hpp"
#include "estimator/state.hpp"
#include "rt/arena.hpp"
#include "rt/time.hpp"

namespace lxd {

// The filter's state as another thread takes it over: bytes that may be copied while they are overwritten.
struct MotionAnchor {
  RigTime t;
  std::array<double, 9> R{};  // by columns
  std::array<double, 3> p{}, v{}, b_g{}, b_a{}, g{};
  bool inertial = false;  // the biases are those of the IMU; otherwise nothing can be predicted from it
  bool tracked = false;   // its sweep held the pose
  Duration imu_delay;     // an instant's reading is stamped so much later

  static MotionAnchor of(RigTime t, const State& x, bool inertial, bool tracked) noexcept;
  [[nodiscard]] State state() const noexcept;
};

struct PredictedState {
  RigTime t;                                             // the reading's instant
  State x;                                               // then
  Duration reach;                                        // since the anchor
  bool tracked = false;                                  // of the anchor's sweep
  Eigen::Vector3d rate_radps = Eigen::Vector3d::Zero();  // of the body, without the bias
};

class PosePredictor {
 public:
  // Farther than this the integrated noise of a small IMU is no pose to steer by: 0.5 m/s^2 of wrong tilt make 6 cm.
  static constexpr Duration kReachMax = Duration::from_ns(500'000'000);

  explicit PosePredictor(Arena& arena) : history_(arena) {}

  // A newer state of the filter: what was read since is gone through again.
  void take(const MotionAnchor& anchor) noexcept;

  // The state at the reading; nothing before the first anchor, where readings are missing since it, or too far from it.
  std::optional<PredictedState> add(const InertialReading& reading) noexcept;

 private:
  [[nodiscard]] bool carry_to(RigTime t) noexcept;

  ImuHistory history_;
  std::optional<MotionAnchor> anchor_;
  State x_;    // at t_
  RigTime t_;  // from the anchor on
};

}  // namespace lxd
