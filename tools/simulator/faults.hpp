// SPDX-License-Identifier: Apache-2.0
// Faults by name and time. The sensors ask whether a fault of theirs is on; what the fault does is written where the
// sensor is.
#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "rt/result.hpp"

namespace lxd::sim {

struct Fault {
  std::string name;    // of known_faults()
  double begin_s = 0;  // since the recording's start
  double end_s = std::numeric_limits<double>::infinity();
  double value = 0;  // in the fault's own unit: a part, m, s, ppm
};

struct KnownFault {
  std::string_view name;
  double duration_s;      // when the user gives none; infinite: to the end
  double value;           // when the user gives none
  std::string_view unit;  // of the value; empty: takes none
  std::string_view what;  // one line for --help and the README
};

class FaultPlan {
 public:
  FaultPlan() = default;
  explicit FaultPlan(std::vector<Fault> faults) : faults_(std::move(faults)) {}

  // The fault of this name that is on at t_s, or null.
  [[nodiscard]] const Fault* active(std::string_view name, double t_s) const {
    for (const Fault& fault : faults_) {
      if (fault.name == name && t_s >= fault.begin_s && t_s < fault.end_s) return &fault;
    }
    return nullptr;
  }
  [[nodiscard]] const std::vector<Fault>& all() const { return faults_; }

 private:
  std::vector<Fault> faults_;
};

}  // namespace lxd::sim
