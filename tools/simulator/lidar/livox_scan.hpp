// SPDX-License-Identifier: Apache-2.0
// A tenth of a second of a simulated Mid-360: every shot fired at its own time, from where the sensor is then.
#pragma once

#include <cstdint>
#include <vector>

#include "tools/simulator/context.hpp"
#include "tools/simulator/lidar/livox_config.hpp"
#include "tools/simulator/lidar/livox_pattern.hpp"

namespace lxd::sim {

struct LivoxReturn {
  Eigen::Vector3d p_m = Eigen::Vector3d::Zero();  // sensor frame; the origin: nothing came back
  std::uint8_t reflectivity = 0;
  std::uint8_t tag = 0;
};

struct LivoxFrame {
  std::uint64_t number = 0;
  std::uint64_t first_packet = 0;
  ShotFault fault = ShotFault::kNone;
  std::vector<LivoxReturn> shots;  // kLivoxPacketPoints a packet
};

class LivoxScanner {
 public:
  // Keeps references to the context and what it names.
  LivoxScanner(const Context& context, const LivoxConfig& config);

  // Frame 0 begins with the recording. Safe from many threads.
  [[nodiscard]] LivoxFrame scan(std::uint64_t number, ShotFault fault) const;

 private:
  // A packet's rays, and their directions in the sensor's frame.
  struct Aim {
    std::vector<Ray> rays;
    std::vector<Eigen::Vector3d> directions;
  };
  void aim(std::uint64_t packet, Aim& aim) const;
  static LivoxReturn wire_return(const Return& measured, const Eigen::Vector3d& direction, Random& random);

  const Context& context_;
  LivoxConfig config_;
  ReturnModel returns_;
};

}  // namespace lxd::sim
