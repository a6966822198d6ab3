// SPDX-License-Identifier: Apache-2.0
// The paths of a run: the filter's as it goes, with its covariance, and the final one when it is done.
#pragma once

#include <vector>

#include "backend/trajectory.hpp"
#include "board/run_folder.hpp"
#include "board/star.hpp"

namespace lxd {

class PathWriter {
 public:
  static Result<PathWriter> create(const RunFolder& folder);

  // A pose of the reference frame, as the filter has just estimated it; on disk when this returns.
  Status append(const StampedPose& pose, const PoseCovariance& covariance);

  [[nodiscard]] const std::vector<StampedPose>& poses() const { return poses_; }

 private:
  PathWriter(LineFile odometry, LineFile covariance);

  LineFile odometry_;
  LineFile covariance_;
  std::vector<StampedPose> poses_;
};

}  // namespace lxd
