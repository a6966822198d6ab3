// SPDX-License-Identifier: Apache-2.0
// Fixes of GNSS on their way into the graph: until they show where the map lies on the earth they wait; then each must
// agree with where odometry has gone since the last that did. What jumps, drags or stands still is refused and counted.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "backend/graph/factors.hpp"
#include "backend/graph/gnss_fix.hpp"
#include "backend/graph/odometry_chain.hpp"

namespace lxd {

struct GnssCounts {
  std::uint64_t taken = 0;  // measurements offered
  std::uint64_t used = 0;   // now in the graph
  std::uint64_t not_finite = 0;
  std::uint64_t unaligned = 0;  // came before the map's place was known, and disagree with it; or it never was
  std::uint64_t jumped = 0;     // farther off than odometry can have drifted since the last fix in use
  std::uint64_t outlying = 0;   // against the final solution
};

class GnssTrack {
 public:
  using PoseOf = std::function<Pose(std::int64_t key_frame)>;  // T_map_body, as the graph has it

  GnssTrack(const GraphConfig& config, const OdometryChain& chain) : config_(config), chain_(chain) {}

  // True: the entries in use, or the alignment, are others than before.
  bool add(const GnssMeasurement& measurement, const PoseOf& pose);
  // Leaves out what does not fit the graph's solution. True: something was.
  bool drop_outliers(const PoseOf& pose);

  [[nodiscard]] bool aligned() const { return alignment_.has_value(); }
  [[nodiscard]] const EarthAlignment& alignment() const { return *alignment_; }
  void set_alignment(const EarthAlignment& alignment) { alignment_ = alignment; }
  // Those in use, in order.
  [[nodiscard]] const std::vector<GnssMeasurement>& fixes() const { return fixes_; }
  // When the first was that ever was in use.
  [[nodiscard]] RigTime began() const { return began_; }
  [[nodiscard]] GnssCounts counts() const;

 private:
  bool wait(const GnssMeasurement& measurement, const PoseOf& pose);
  bool align(const PoseOf& pose);
  void use(const GnssMeasurement& measurement);
  [[nodiscard]] double delay_sigma_m(const GnssMeasurement& measurement) const;
  [[nodiscard]] bool agrees(const GnssMeasurement& measurement, const PoseOf& pose) const;
  [[nodiscard]] const GnssMeasurement& settled_before(RigTime stamp) const;
  [[nodiscard]] Eigen::Matrix3d drift_m2(const GnssMeasurement& measurement, const PoseOf& pose) const;

  GraphConfig config_;
  const OdometryChain& chain_;
  std::vector<GnssMeasurement> waiting_;
  std::size_t tried_ = 0;  // waiting when alignment was last sought
  std::vector<GnssMeasurement> fixes_;
  RigTime began_;
  double extent_m_ = 0;  // by odometry, level: from the first fix in use to the farthest
  std::optional<EarthAlignment> alignment_;
  GnssCounts counts_;
};

}  // namespace lxd
