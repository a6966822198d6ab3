// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/imu/imu_faults.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "tools/simulator/context.hpp"
#include "tools/simulator/units.hpp"

namespace lxd::sim {
namespace {

constexpr double kToTheEnd = std::numeric_limits<double>::infinity();

constexpr std::array kImuFaults{
    KnownFault{"imu_gap", 0.1, 0, "", "the IMU sends nothing"},
    KnownFault{"imu_clip", 1, 1, "g", "the accelerometer saturates at this value"},
    KnownFault{"imu_step", 1, 1, "g", "a step on the accelerometer's x axis"},
    KnownFault{"imu_nan", 0.1, 0, "", "the IMU sends NaN (WitMotion, which has none: the lowest of all numbers)"},
    KnownFault{"imu_stuck", 1, 0, "", "the IMU repeats its last values; its time goes on"},
    KnownFault{"imu_time_step", kToTheEnd, 1, "s", "the IMU's clock is ahead by this much"},
    KnownFault{"imu_skew", kToTheEnd, 100, "ppm", "the IMU's clock runs faster by this much"},
};

}  // namespace

std::span<const KnownFault> imu_faults() { return kImuFaults; }

std::optional<Inertial> ImuFaults::apply(const Inertial& measured, double t_s) {
  if (plan_.active("imu_gap", t_s) != nullptr) {
    ++counts_.gap;
    return std::nullopt;
  }
  if (plan_.active("imu_stuck", t_s) != nullptr) {
    ++counts_.stuck;
    return last_;
  }
  Inertial sample = measured;
  if (const Fault* const step = plan_.active("imu_step", t_s)) {
    ++counts_.step;
    sample.accel_mps2.x() += step->value * kGravity_mps2;
  }
  clip(sample, t_s);
  if (plan_.active("imu_nan", t_s) != nullptr) {
    ++counts_.nan;
    sample.gyro_radps.setConstant(std::numeric_limits<double>::quiet_NaN());
    sample.accel_mps2 = sample.gyro_radps;
  }
  last_ = sample;
  return sample;
}

void ImuFaults::clip(Inertial& sample, double t_s) {
  const Fault* const fault = plan_.active("imu_clip", t_s);
  if (fault == nullptr) return;
  const double most = fault->value * kGravity_mps2;
  if (sample.accel_mps2.cwiseAbs().maxCoeff() > most) ++counts_.clipped;
  sample.accel_mps2 = sample.accel_mps2.cwiseMin(most).cwiseMax(-most);
}

// What skew has gathered stays when the fault ends: the clock goes on from where it is.
double ImuFaults::clock_error_s(double t_s) {
  double error_s = 0;
  if (const Fault* const step = plan_.active("imu_time_step", t_s)) {
    ++counts_.time_step;
    error_s += step->value;
  }
  if (plan_.active("imu_skew", t_s) != nullptr) ++counts_.skew;
  for (const Fault& fault : plan_.all()) {
    if (fault.name != "imu_skew" || t_s < fault.begin_s) continue;
    error_s += (std::min(t_s, fault.end_s) - fault.begin_s) * fault.value * kPpm;
  }
  return error_s;
}

}  // namespace lxd::sim
