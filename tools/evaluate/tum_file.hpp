// SPDX-License-Identifier: Apache-2.0
// Reading what `evaluate` compares: TUM paths, and the covariances and innovations beside them.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "backend/trajectory.hpp"
#include "rt/result.hpp"

namespace lxd {

struct Trajectory {
  std::vector<StampedPose> poses;  // strictly increasing in time
  bool oriented = true;            // false: every quaternion of the file was 0 0 0 0 (a tracked prism has no attitude)
};

// `t tx ty tz qx qy qz qw` a line, '#' comments. Stamps are read digit by digit, exact to the nanosecond.
// Error: file:line, found, wanted (columns, a number, finite, a unit quaternion, increasing time, at least one pose).
Result<Trajectory> load_tum(const std::filesystem::path& path);

struct StampedCovariance {
  RigTime stamp;
  Eigen::Matrix<double, 6, 6> covariance;  // [rotation body-frame rad, position world-frame m]
};

// `t` and 21 numbers a line, as covariance_line() of the back-end writes them. Error: as load_tum.
Result<std::vector<StampedCovariance>> load_covariances(const std::filesystem::path& path);

struct StampedInnovation {
  RigTime stamp;
  double nis;      // normalised innovation squared, 0 or more
  int dimensions;  // degrees of freedom, 1 or more
};

// `t nis dimensions` a line, as innovation_line() of the back-end writes them. Error: as load_tum.
Result<std::vector<StampedInnovation>> load_innovations(const std::filesystem::path& path);

// "12.5", "1684567182.821034193", "1.4e9". Nothing when it is no finite number within int64 nanoseconds.
std::optional<RigTime> parse_stamp(std::string_view text);

}  // namespace lxd
