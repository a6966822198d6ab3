// SPDX-License-Identifier: Apache-2.0
// One turn of a simulated Ouster: every column fired at its own time, from where the sensor is then.
#pragma once

#include <cstdint>
#include <vector>

#include "drivers/ouster/metadata.hpp"
#include "tools/simulator/context.hpp"
#include "tools/simulator/lidar/ouster_config.hpp"

namespace lxd::sim {

struct OusterTurn {
  std::uint64_t number = 0;
  ShotFault fault = ShotFault::kNone;
  std::vector<Return> pixels;  // column after column: index = column * rows + row
};

class OusterScanner {
 public:
  // Keeps references to the context and what it names.
  OusterScanner(const Context& context, const OusterConfig& config, const OusterMetadata& metadata);

  // Turn 0 begins with the recording. Safe from many threads.
  [[nodiscard]] OusterTurn scan(std::uint64_t number, ShotFault fault) const;
  // True time of a column's firing.
  [[nodiscard]] double column_s(std::uint64_t number, std::size_t column) const {
    return static_cast<double>(number * columns_ + column) * config_.column_period_s();
  }
  // What the wire says of a return: the range from the centre of the optics.
  [[nodiscard]] double wire_range_m(const Return& pixel) const { return pixel.range_m + beam_origin_m_; }

 private:
  void aim(double t_s, std::size_t column, std::vector<Ray>& rays) const;

  const Context& context_;
  OusterConfig config_;
  ReturnModel returns_;
  std::size_t columns_, rows_;
  double beam_origin_m_;
  double reach_m_;
  std::vector<Eigen::Vector3d> directions_;  // per pixel, sensor frame
  std::vector<Eigen::Vector3d> origins_;     // per column, sensor frame
};

}  // namespace lxd::sim
