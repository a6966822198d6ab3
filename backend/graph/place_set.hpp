// SPDX-License-Identifier: Apache-2.0
// Which of the places that were found in finished maps are true: those of the largest set in which each says the same
// of where this path lies, by way of odometry. There is nothing else to judge them by: before the first is believed,
// the path's place in the map is unknown.
#pragma once

#include <cstdint>
#include <vector>

#include "backend/graph/agreement.hpp"
#include "backend/graph/odometry_chain.hpp"
#include "backend/loop_measurement.hpp"

namespace lxd {

struct PlaceCounts {
  std::uint64_t proposed = 0, accepted = 0;
  std::uint64_t not_sound = 0;  // no finite numbers, or of a key frame that is not there
  std::uint64_t waiting = 0;    // for others that agree; or outvoted by them
};

class PlaceSet {
 public:
  PlaceSet(const GraphConfig& config, const OdometryChain& chain)
      : config_(config), chain_(chain), agreement_(static_cast<std::size_t>(config.loop_agreeing_min)) {}

  // True: the accepted places are others than before.
  bool add(const PlaceMeasurement& place);

  // All in the same map; with the covariance that they have at least.
  [[nodiscard]] std::vector<PlaceMeasurement> accepted() const;
  [[nodiscard]] PlaceCounts counts() const;

 private:
  [[nodiscard]] bool sound(const PlaceMeasurement& place) const;
  [[nodiscard]] bool agree(const PlaceMeasurement& a, const PlaceMeasurement& b) const;

  GraphConfig config_;
  const OdometryChain& chain_;
  Agreement agreement_;
  std::vector<PlaceMeasurement> set_;      // whose agreement is known; of too many the oldest keep their verdict
  std::vector<PlaceMeasurement> settled_;  // accepted, and no longer compared
  PlaceCounts counts_;
};

}  // namespace lxd
