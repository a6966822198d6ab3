// SPDX-License-Identifier: Apache-2.0
// What a receiver makes of its sky: which kind of fix it has, and by how much that errs.
#pragma once

#include <string_view>

#include "drivers/gnss/gnss_fix.hpp"
#include "tools/simulator/context.hpp"
#include "tools/simulator/gnss/gnss_config.hpp"

namespace lxd::sim {

// Fix or none, RTK or not, epoch by epoch. It starts with the best that the sky allows: a receiver that has run before.
class FixState {
 public:
  FixState(const GnssConfig& config, std::uint64_t seed) : config_(config), random_(seed, "gnss_rtk") {}

  // `lost`, `rtk_lost`: by fault. Times must grow.
  GnssQuality step(double t_s, double blocked, bool lost, bool rtk_lost);

 private:
  const GnssConfig& config_;
  Random random_;
  double last_s_ = 0;
  double fix_from_s_ = 0;    // earliest fix
  double fixed_from_s_ = 0;  // earliest RTK fixed
};

// A quantity that forgets itself over a time constant; stationary, of unit variance.
class GaussMarkov {
 public:
  GaussMarkov(std::uint64_t seed, std::string_view stream, double time_s);
  // Its value `since_s` after the last.
  double step(double since_s);

 private:
  Random random_;
  double time_s_, value_;
};

// East, north, up.
struct GnssError {
  Eigen::Vector3d error_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d reported_sigma_m = Eigen::Vector3d::Zero();  // what the receiver believes
};

class GnssErrors {
 public:
  GnssErrors(const GnssConfig& config, std::uint64_t seed);

  // Of one epoch. Precondition: a fix; the quality none gives zeros.
  GnssError step(double t_s, GnssQuality quality, double blocked);

 private:
  [[nodiscard]] double sigma_m(GnssQuality quality) const;

  const GnssConfig& config_;
  Random white_;
  std::array<GaussMarkov, 3> slow_, multipath_;
  double last_s_ = 0;
};

// Dilution of precision of a sky of which a part is blocked.
double hdop(double blocked);

}  // namespace lxd::sim
