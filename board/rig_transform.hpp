// SPDX-License-Identifier: Apache-2.0
// The extrinsics that people type: a 4 x 4 matrix that must be a rotation and a translation, and what the usual
// mistakes look like.
#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>
#include <yaml-cpp/yaml.h>

#include "board/yaml_section.hpp"
#include "rt/pose.hpp"

namespace lxd {

// Nothing when T is a rigid transform (R orthonormal to 1e-6, det +1, last row 0 0 0 1, finite, translation within
// 100 m); else what was found, what was wanted and what the mistake looks like.
std::string complaint_about_transform(const Eigen::Matrix4d& T);

// Reads four rows of four, sixteen numbers row by row, or OpenCV's {rows, cols, data}. Nothing when the key is missing
// or wrong (then `section` has the complaint).
std::optional<Pose> read_transform(YamlSection& section, std::string_view key);

}  // namespace lxd
