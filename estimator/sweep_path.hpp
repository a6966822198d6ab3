// SPDX-License-Identifier: Apache-2.0
// The body's path during one sweep, told from the state at its end: backwards at constant velocity, or along the IMU's
// readings. Deskewing with it takes every point to where the filter believes it was fired (paper, "Kinematic Motion
// Distortion Compensation"), and how a point moves with the end state, rates included, is known in closed form: the
// sweep's own skew measures the velocity.
//
// With tau the time before the end and Gamma the body's turn from then to the end,
//   R(tau) = R Gamma,   p(tau) = p - v tau + g tau^2 / 2 + R beta(tau),   beta = twice integrated specific force;
// without an IMU Gamma = Exp(b_g tau) (b_g is minus the rate) and g and beta are left out.
//
// The path hangs on the end state alone. One that is also held at the previous sweep's end (a cubic through both) looks
// better, but errors of the held end come back amplified 1.8 times a sweep; estimator/README.md derives it.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "estimator/inertial_propagation.hpp"
#include "estimator/state.hpp"
#include "rt/time.hpp"

namespace lxd {

// The blocks of the state that a sweep speaks of: theta, p, v, b_g.
inline constexpr int kLidarDim = 12;
using Vector6d = Eigen::Matrix<double, 6, 1>;  // of the pose: [theta, p]
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using LidarVector = Eigen::Matrix<double, kLidarDim, 1>;
using LidarMatrix = Eigen::Matrix<double, kLidarDim, kLidarDim>;

// Pose at `before_end_s` before the end, and what it takes to differentiate it by the end state.
struct PathKnot {
  Eigen::Matrix3d R;  // R_world_body
  Eigen::Vector3d p;
  Eigen::Matrix3d turn;                                     // Gamma: from the body then to the body at the end
  Eigen::Matrix3d turn_by_bias;                             // G: Gamma(b_g + d) = Exp(G d) Gamma
  Eigen::Vector3d lever = Eigen::Vector3d::Zero();          // beta, m, in the body at the end
  Eigen::Matrix3d lever_by_bias = Eigen::Matrix3d::Zero();  // d beta / d b_g
  double before_end_s;                                      // tau
  // Of what the IMU's delay is wrong by (imu_delay.hpp): Gamma(delay + d) = Exp(turn_by_delay d) Gamma.
  Eigen::Vector3d turn_by_delay = Eigen::Vector3d::Zero();
};

// How n^T (R(tau) q + p(tau)) moves with the end state. Of b_a and g, which bend the path by tau^2 / 2 of what they are
// wrong by (a quarter of a millimetre in 0.1 s for 0.05 m/s^2), a sweep says nothing.
//   theta: (Gamma q + beta) x h,   p: n,   v: -tau n,   b_g: G^T (Gamma q x h) + (d beta / d b_g)^T h,   h = R_end^T n
LidarVector row_along(const PathKnot& knot, const Eigen::Vector3d& q_body, const Eigen::Vector3d& n_world);

// The same by the delay, the end state being held: (Gamma q x h)^T turn_by_delay. What the force tells late bends the
// path by less than b_a does.
double row_by_delay(const PathKnot& knot, const Eigen::Vector3d& q_body, const Eigen::Vector3d& n_world);

// J^T J for J = d (R(tau) q + p(tau)) / d(end state).
LidarMatrix motion_of(const PathKnot& knot, const Eigen::Vector3d& q_body);

class SweepPath {
 public:
  static constexpr int kIntervals = 64;  // knots are exact; between them matrices are interpolated: at 5 rad/s and 10
                                         // Hz the error is (5 * 0.1 / 64)^2 / 8 = 8e-6 of a point's distance

  // At constant velocity. span: end minus begin; zero for a sweep that is an instant.
  void set(const State& end, Duration span);
  // Along the IMU's readings, in the order of time and ending at the end; they make up the span.
  void set(const State& end, Duration span, std::span<const InertialSpan> measured);

  [[nodiscard]] static PathKnot knot(const State& end, double before_end_s);  // exact, at constant velocity
  // The same along readings; before_end_s within them. Linear in their number.
  [[nodiscard]] static PathKnot knot(const State& end, double before_end_s, std::span<const InertialSpan> measured);
  [[nodiscard]] const PathKnot& nearest_knot(std::uint32_t offset_ns) const {
    return knots_[static_cast<int>(interval_position(offset_ns) + 0.5f)];
  }

  // A point fired at `offset` after the sweep's begin, from the body's frame then into the world.
  [[nodiscard]] Eigen::Vector3d to_world(const Eigen::Vector3d& p_body, std::uint32_t offset_ns) const {
    const float f = interval_position(offset_ns);
    const int i = static_cast<int>(f);
    const double b = f - static_cast<float>(i);
    const PathKnot &k0 = knots_[i], &k1 = knots_[i + 1];
    return (k0.R * p_body + k0.p) * (1.0 - b) + (k1.R * p_body + k1.p) * b;
  }

  // The same in float, relative to origin(): for clouds.
  [[nodiscard]] Eigen::Vector3f to_local(const Eigen::Vector3f& p_body, std::uint32_t offset_ns) const {
    const float f = interval_position(offset_ns);
    const int i = static_cast<int>(f);
    const float b = f - static_cast<float>(i);
    const FloatKnot &k0 = float_knots_[i], &k1 = float_knots_[i + 1];
    return (k0.R * p_body + k0.p) * (1.0f - b) + (k1.R * p_body + k1.p) * b;
  }
  [[nodiscard]] const Eigen::Vector3d& origin() const { return end_.p; }

 private:
  struct FloatKnot {
    Eigen::Matrix3f R;
    Eigen::Vector3f p;  // relative to the end's position
  };

  [[nodiscard]] float interval_position(std::uint32_t offset_ns) const {
    return std::min(static_cast<float>(offset_ns) * intervals_per_ns_, kIntervals - 1e-3f);
  }

  void begin(const State& end, Duration span);
  void place(int i, const PathKnot& knot);
  [[nodiscard]] double before_end_s(int i) const { return span_.seconds() * (kIntervals - i) / kIntervals; }

  State end_;
  Duration span_;
  float intervals_per_ns_ = 0;
  std::array<PathKnot, kIntervals + 1> knots_;
  std::array<FloatKnot, kIntervals + 1> float_knots_;
};

}  // namespace lxd
