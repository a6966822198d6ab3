// SPDX-License-Identifier: Apache-2.0
// The faults of one LiDAR, by name `<sensor>_<fault>`, and what they come to at a given time.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "tools/simulator/faults.hpp"

namespace lxd::sim {

enum class LidarFault : std::uint8_t {
  kLoss,
  kReorder,
  kDuplicate,
  kOff,
  kRestart,
  kSerial,
  kProfile,
  kEmpty,
  kZero,
  kOneVoxel,
  kMaxPoints,
  kTimeStep,
  kSkew,
  kCount
};

// What becomes of every shot of a sweep.
enum class ShotFault : std::uint8_t { kNone, kEmpty, kZero, kOneVoxel, kMaxPoints };

// The sensor's life up to an instant: how often it restarted, and when it last did.
struct LidarBoot {
  std::uint32_t number = 0;  // 0: it has been running since before the recording
  double down_s = 0;         // when it went down to start anew; its own clock begins there
  double up_s = 0;           // when it sent again
};

class LidarFaults {
 public:
  // Keeps a reference to the plan.
  LidarFaults(const FaultPlan& plan, const std::string& sensor);

  [[nodiscard]] bool on(LidarFault fault, double t_s) const { return active(fault, t_s) != nullptr; }
  // The value of a fault that is on, else 0.
  [[nodiscard]] double value(LidarFault fault, double t_s) const;
  [[nodiscard]] bool silent(double t_s) const { return on(LidarFault::kOff, t_s) || on(LidarFault::kRestart, t_s); }
  // A datagram that was begun or sent in silence is not sent.
  [[nodiscard]] bool silent(double begin_s, double sent_s) const { return silent(begin_s) || silent(sent_s); }
  [[nodiscard]] ShotFault shots(double t_s) const;
  [[nodiscard]] LidarBoot boot(double t_s) const;
  // What steps and skews have added to the sensor's clock. A skew's offset stays when the fault is over.
  [[nodiscard]] double clock_error_s(double t_s) const;

 private:
  [[nodiscard]] const Fault* active(LidarFault fault, double t_s) const;
  [[nodiscard]] const std::string& name(LidarFault fault) const { return names_[static_cast<std::size_t>(fault)]; }

  const FaultPlan& plan_;
  std::array<std::string, static_cast<std::size_t>(LidarFault::kCount)> names_;
};

// Of the sensor named lidar0 or lidar1; none for another name.
std::span<const KnownFault> known_lidar_faults(std::string_view sensor);

}  // namespace lxd::sim
