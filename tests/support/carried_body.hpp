// SPDX-License-Identifier: Apache-2.0
// A body on its way whose state is known, and a Motion that carries it sweep by sweep by what its sensors say.
#pragma once

#include <cmath>
#include <utility>

#include "estimator/motion.hpp"
#include "tests/support/inertial_motion.hpp"
#include "tests/support/mapping_scene.hpp"

namespace lxd::test {

inline constexpr double kSweep_s = 0.1, kReading_s = 0.01, kBegin_s = 1.0;
inline constexpr ImuNoise kImuNoise{1e-3, 1e-2, 1e-4, 1e-3};
inline const Eigen::Vector3d kTrueBias(0.01, -0.02, 0.015);

inline RigTime at(double t_s) { return RigTime::from_seconds(t_s); }

inline MotionSetup with_imu() { return {{}, kImuNoise, std::nullopt}; }
inline MotionSetup with_wheel() { return {{}, std::nullopt, WheelModel{{}, 0.02, 0.02}}; }
inline MotionSetup with_both() { return {{}, kImuNoise, WheelModel{{}, 0.02, 0.02}}; }

inline StateMatrix known() {
  StateMatrix P = StateMatrix::Zero();
  P.diagonal().head<12>().setConstant(1e-6);
  return P;
}

// A body on its way whose state is known at `kBegin_s`, and what its sensors say.
class Carried {
 public:
  explicit Carried(const MotionSetup& setup, InertialMotion its_way) : way(std::move(its_way)), motion(setup, *arena_) {
    filter.reset(way.state(kBegin_s), known());
  }
  void read(double from_s, double to_s, double period_s = kReading_s) {
    for (double t = from_s; t < to_s - 1e-6; t += period_s) {
      InertialReading reading = way.reading(t);
      reading.rate_radps += kTrueBias;
      // White noise of the density, alternating: scatters as the sensor's own does, the mean is without.
      sign_ = -sign_;
      reading.rate_radps.array() += sign_ * 0.5 * kImuNoise.gyro_density / std::sqrt(period_s);
      reading.force_mps2.array() += sign_ * 0.5 * kImuNoise.accel_density / std::sqrt(period_s);
      motion.add(reading);
    }
  }
  void roll(double from_s, double to_s) {
    for (double t = from_s; t < to_s - 1e-6; t += 0.02) motion.add(way.wheel(t));
  }
  // As if at constant velocity until now.
  void align() {
    State x = way.state(kBegin_s);
    x.b_g = -way.rate(kBegin_s);
    motion.align(x, at(kBegin_s - 0.2), at(kBegin_s));
  }
  MotionSource sweep() {
    now_s += kSweep_s;
    return motion.predict(filter, at(now_s - kSweep_s), at(now_s));
  }
  [[nodiscard]] double shift_m() const { return (filter.state().p - way.pose(now_s).p).norm(); }
  [[nodiscard]] double turn_rad() const { return Log(filter.state().R.transpose() * way.pose(now_s).R).norm(); }

 private:
  OwnedArena arena_{std::size_t{1} << 20};
  double sign_ = 1;

 public:
  InertialMotion way;
  Motion motion;
  Ieskf filter;
  double now_s = kBegin_s;
};

// An IMU that has run for 0.2 s before the begin and is aligned, and goes on until `until_s`.
inline Carried aligned(const InertialMotion& way, double until_s, const MotionSetup& setup = with_imu()) {
  Carried body(setup, way);
  body.read(kBegin_s - 0.2, until_s);
  body.align();
  return body;
}

}  // namespace lxd::test
