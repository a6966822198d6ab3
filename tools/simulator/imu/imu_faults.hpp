// SPDX-License-Identifier: Apache-2.0
// What can go wrong with an IMU on request, by name and time.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "tools/simulator/faults.hpp"
#include "tools/simulator/imu/imu_errors.hpp"

namespace lxd::sim {

std::span<const KnownFault> imu_faults();

// Samples that each fault has changed or kept back.
struct ImuFaultCounts {
  std::uint64_t gap = 0, clipped = 0, step = 0, nan = 0, stuck = 0, time_step = 0, skew = 0;
};

class ImuFaults {
 public:
  explicit ImuFaults(const FaultPlan& plan) : plan_(plan) {}

  // None: the sample is never sent. Precondition: calls in the order of time.
  std::optional<Inertial> apply(const Inertial& measured, double t_s);
  // What the faults add to the sensor's clock.
  double clock_error_s(double t_s);

  [[nodiscard]] const ImuFaultCounts& counts() const { return counts_; }

 private:
  void clip(Inertial& sample, double t_s);

  const FaultPlan& plan_;
  Inertial last_;  // as it was sent
  ImuFaultCounts counts_;
};

}  // namespace lxd::sim
