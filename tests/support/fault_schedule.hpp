// SPDX-License-Identifier: Apache-2.0
// When which wire of a rig is in trouble: one trouble after the other, with time to recover between them, by a seed.
// Some are the simulator's, since they are in the sensor; the others are made on the wire (wire_faults.hpp).
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "tools/simulator/random.hpp"

namespace lxd::test {

struct FaultSlot {
  std::string kind;
  std::vector<std::string> wires;  // that it concerns
  double begin_s = 0, end_s = 0;   // of the recording
  double value = 0;                // of the simulator's fault; 0: its own

  [[nodiscard]] bool concerns(const std::string& wire) const { return std::ranges::count(wires, wire) > 0; }
  [[nodiscard]] bool on(double t_s) const { return begin_s <= t_s && t_s < end_s; }
  [[nodiscard]] bool is(std::string_view name) const { return kind == name; }
};

struct FaultKind {
  const char* name;
  std::vector<std::string> wires;
  double lasts_s;    // 0: 1 s, 5 s, 0.1 s in turn
  bool simulated;    // by the simulator, under the same name
  double value = 0;  // likewise; its sign changes every time
};

// In the order of a short run, which has room for the first ones only.
inline std::vector<FaultKind> fault_kinds() {
  return {{"lidar0_silent", {"lidar0"}, 0, false},
          {"imu_silent", {"imu"}, 0, false},
          {"imu_unplugged", {"imu"}, 0, false},
          {"lidar0_time_step", {"lidar0"}, 2, true, 1},
          {"imu_time_step", {"imu"}, 2, true, 1},
          {"lidar0_restart", {"lidar0"}, 0.5, true},
          {"lidar0_burst", {"lidar0"}, 0.4, false},
          {"lidar0_loss", {"lidar0"}, 1, false},
          {"lidar1_silent", {"lidar1"}, 0, false},
          {"gnss_silent", {"gnss"}, 0, false},
          {"gnss_unplugged", {"gnss"}, 0, false},
          {"imu_burst", {"imu"}, 0.4, false},
          {"jitter", {"lidar0", "lidar1", "imu", "gnss"}, 3, false},
          {"all_silent", {"lidar0", "lidar1", "imu", "gnss"}, 0.1, false},
          {"lidar0_serial", {"lidar0"}, 0.4, true},
          {"lidar0_profile", {"lidar0"}, 0.4, true},
          {"lidar0_empty", {"lidar0"}, 0.3, true},
          {"imu_nan", {"imu"}, 0.1, true}};
}

class FaultSchedule {
 public:
  static constexpr double kFirst_s = 4;       // by then the filter has found its map
  static constexpr double kRecovery_s = 2.5;  // between two troubles

  FaultSchedule(double duration_s, std::uint64_t seed) {
    constexpr std::array kSilences_s{1.0, 5.0, 0.1};
    double t_s = kFirst_s;
    for (std::size_t round = 0;; ++round) {
      for (const FaultKind& kind : in_turn(round, seed)) {
        const double lasts_s = kind.lasts_s > 0 ? kind.lasts_s : kSilences_s[round % kSilences_s.size()];
        if (t_s + lasts_s + kRecovery_s > duration_s) return;
        slots_.push_back({kind.name, kind.wires, t_s, t_s + lasts_s, round % 2 == 0 ? kind.value : -kind.value});
        t_s += lasts_s + kRecovery_s;
      }
    }
  }

  [[nodiscard]] const std::vector<FaultSlot>& slots() const { return slots_; }
  [[nodiscard]] std::size_t times(std::string_view kind) const {
    return static_cast<std::size_t>(std::ranges::count(slots_, kind, &FaultSlot::kind));
  }
  // On this wire something is under way, or was a moment ago, or will be.
  [[nodiscard]] bool busy(const std::string& wire, double t_s) const {
    constexpr double kBefore_s = 0.3, kAfter_s = 1;
    return std::ranges::any_of(slots_, [&](const FaultSlot& slot) {
      return slot.concerns(wire) && t_s >= slot.begin_s - kBefore_s && t_s < slot.end_s + kAfter_s;
    });
  }
  // The slot of this kind at a time; null: there is none.
  [[nodiscard]] const FaultSlot* at(std::string_view kind, double t_s) const {
    const auto found = std::ranges::find_if(slots_, [&](const FaultSlot& s) { return s.is(kind) && s.on(t_s); });
    return found == slots_.end() ? nullptr : &*found;
  }
  // Options of `simulate` for those that are the sensor's.
  [[nodiscard]] std::string simulator_options() const {
    std::string options;
    for (const FaultSlot& slot : slots_) {
      const auto kinds = fault_kinds();
      if (!std::ranges::any_of(kinds, [&](const FaultKind& kind) { return slot.is(kind.name) && kind.simulated; }))
        continue;
      options += fmt::format(" --fault {}@{:.3f}+{:.3f}", slot.kind, slot.begin_s, slot.end_s - slot.begin_s);
      if (slot.value != 0) options += fmt::format("={}", slot.value);
    }
    return options;
  }

 private:
  // The first round is in the order of the list, the others in one of the seed.
  static std::vector<FaultKind> in_turn(std::size_t round, std::uint64_t seed) {
    std::vector<FaultKind> kinds = fault_kinds();
    sim::Random random(seed, "faults", round);
    for (std::size_t i = kinds.size(); round > 0 && i > 1; --i) std::swap(kinds[i - 1], kinds[random.bits() % i]);
    return kinds;
  }

  std::vector<FaultSlot> slots_;
};

}  // namespace lxd::test
