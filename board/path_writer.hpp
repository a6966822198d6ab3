// SPDX-License-Identifier: Apache-2.0
// The paths of a run: the filter's as it goes, with its covariance, and the final one when it is done.
#pragma once

#include <vector>

#include "backend/trajectory.hpp"
#include "board/run_folder.hpp"
#include "board/star.hpp"
#include "estimator/innovation.hpp"

namespace lxd {

class PathWriter {
 public:
  static Result<PathWriter> create(const RunFolder& folder);

  // A pose of the reference frame, as the filter has just estimated it, and the innovation of its update if there was
  // one; on disk when this returns.
  Status append(const StampedPose& pose, const PoseCovariance& covariance, const Innovation& innovation);

  [[nodiscard]] const std::vector<StampedPose>& poses() const { return poses_; }

 private:
  PathWriter(LineFile odometry, LineFile covariance, LineFile innovation);

  LineFile odometry_;
  LineFile covariance_;
  LineFile innovation_;
  std::vector<StampedPose> poses_;
};

}  // namespace lxd
