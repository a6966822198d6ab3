// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/lidar/lidar_faults.hpp"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "tools/simulator/units.hpp"

namespace lxd::sim {
namespace {

constexpr double kToTheEnd = std::numeric_limits<double>::infinity();
constexpr double kOneSweep_s = 0.1;

// In the order of LidarFault; the name here is what follows `<sensor>_`.
constexpr std::array<KnownFault, static_cast<std::size_t>(LidarFault::kCount)> kFaults{{
    {"loss", kToTheEnd, 0.1, "part", "each datagram of points loses a frame with this chance"},
    {"reorder", kToTheEnd, 0.01, "part", "each datagram of points is overtaken by the next with this chance"},
    {"duplicate", kToTheEnd, 0.01, "part", "each datagram of points comes twice with this chance"},
    {"off", 5, 0, "", "sends nothing, then goes on as if nothing had been"},
    {"restart", 1, 0, "", "sends nothing, then begins anew: new init id, frame ids and own clock from zero"},
    {"serial", kToTheEnd, 0, "", "another sensor's serial number (profiles with a packet header)"},
    {"profile", kToTheEnd, 0, "", "another packet format than the metadata says (Livox: points in centimetres)"},
    {"empty", kOneSweep_s, 0, "", "sweeps without a valid column (Livox: packets without a point)"},
    {"zero", kOneSweep_s, 0, "", "sweeps in which every range is zero"},
    {"one_voxel", kOneSweep_s, 0, "",
     "sweeps that see nothing but a plate of 0.5 m, 2 m ahead (Livox: every point is there)"},
    {"max_points", kOneSweep_s, 0, "", "sweeps in which every shot returns"},
    {"time_step", kToTheEnd, 1, "s", "the sensor's clock is off by this much"},
    {"skew", kToTheEnd, 100, "ppm", "the sensor's clock runs this much faster"},
}};

// The table with a sensor's names; strings and entries live as long as the program.
class NamedFaults {
 public:
  explicit NamedFaults(const std::string& sensor) {
    names_.reserve(kFaults.size());
    for (const KnownFault& fault : kFaults) {
      names_.push_back(sensor + "_" + std::string(fault.name));
      faults_.push_back(fault);
      faults_.back().name = names_.back();
    }
  }
  [[nodiscard]] std::span<const KnownFault> all() const { return faults_; }

 private:
  std::vector<std::string> names_;
  std::vector<KnownFault> faults_;
};

}  // namespace

std::span<const KnownFault> known_lidar_faults(std::string_view sensor) {
  static const NamedFaults primary("lidar0"), extra("lidar1");
  if (sensor == "lidar0") return primary.all();
  if (sensor == "lidar1") return extra.all();
  return {};
}

LidarFaults::LidarFaults(const FaultPlan& plan, const std::string& sensor) : plan_(plan) {
  for (std::size_t i = 0; i < names_.size(); ++i) names_[i] = sensor + "_" + std::string(kFaults[i].name);
}

const Fault* LidarFaults::active(LidarFault fault, double t_s) const { return plan_.active(name(fault), t_s); }

double LidarFaults::value(LidarFault fault, double t_s) const {
  const Fault* const found = active(fault, t_s);
  return found == nullptr ? 0 : found->value;
}

ShotFault LidarFaults::shots(double t_s) const {
  constexpr std::array kKinds{
      std::pair{LidarFault::kEmpty, ShotFault::kEmpty}, std::pair{LidarFault::kZero, ShotFault::kZero},
      std::pair{LidarFault::kOneVoxel, ShotFault::kOneVoxel}, std::pair{LidarFault::kMaxPoints, ShotFault::kMaxPoints}};
  for (const auto& [fault, kind] : kKinds) {
    if (on(fault, t_s)) return kind;
  }
  return ShotFault::kNone;
}

LidarBoot LidarFaults::boot(double t_s) const {
  LidarBoot boot;
  for (const Fault& fault : plan_.all()) {
    if (fault.name != name(LidarFault::kRestart) || fault.end_s > t_s) continue;
    ++boot.number;
    if (fault.end_s >= boot.up_s) {
      boot.down_s = fault.begin_s;
      boot.up_s = fault.end_s;
    }
  }
  return boot;
}

double LidarFaults::clock_error_s(double t_s) const {
  double error_s = 0;
  for (const Fault& fault : plan_.all()) {
    if (t_s < fault.begin_s) continue;
    if (fault.name == name(LidarFault::kTimeStep) && t_s < fault.end_s) error_s += fault.value;
    if (fault.name == name(LidarFault::kSkew)) {
      error_s += (std::min(t_s, fault.end_s) - fault.begin_s) * fault.value * kPpm;
    }
  }
  return error_s;
}

}  // namespace lxd::sim
