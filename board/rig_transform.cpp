// SPDX-License-Identifier: Apache-2.0
#include "board/rig_transform.hpp"

#include <cmath>
#include <vector>

#include <Eigen/LU>
#include <fmt/format.h>

namespace lxd {
namespace {

constexpr double kRotationTolerance = 1e-6;  // of R^T R - I, element-wise
constexpr double kRoundedTolerance = 2e-2;   // what writing two or three digits leaves
constexpr double kTranslationMax_m = 100.0;  // no rig is longer
constexpr int kElements = 16;
constexpr std::string_view kWanted = "wanted four rows of four numbers, [[R, p], [0, 0, 0, 1]]";

const Eigen::RowVector4d kLastRow{0, 0, 0, 1};

double deviation_from_identity(const Eigen::Matrix3d& M) {
  return (M - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
}

std::string complaint_about_last_row(const Eigen::Matrix4d& T) {
  const Eigen::RowVector4d row = T.row(3);
  if (row == kLastRow) return {};
  const bool transposed = T.col(3).transpose() == kLastRow;
  return fmt::format("found the last row {} {} {} {}, wanted 0 0 0 1{}", row[0], row[1], row[2], row[3],
                     transposed ? " (the matrix looks transposed)" : "");
}

// The rotation block is known to be wrong: say how.
std::string likely_cause(const Eigen::Matrix3d& R) {
  const Eigen::Matrix3d gram = R.transpose() * R;
  const double scale = std::sqrt(gram.trace() / 3.0);
  const bool orthogonal = scale > 0 && deviation_from_identity(gram / (scale * scale)) < kRotationTolerance;
  if (orthogonal && std::abs(scale - 1.0) > kRotationTolerance) return fmt::format("it looks scaled by {:.9g}", scale);
  if (orthogonal) return "its determinant is -1: a mirror image, one axis is flipped";
  if (deviation_from_identity(gram) < kRoundedTolerance) return "it looks rounded: write at least 8 digits";
  if (R.cwiseAbs().maxCoeff() > 1.0 + kRoundedTolerance)
    return "elements beyond 1: it looks like angles in degrees, not a matrix";
  return "its columns are not orthonormal";
}

std::string complaint_about_rotation(const Eigen::Matrix3d& R) {
  const double off = deviation_from_identity(R.transpose() * R);
  if (off <= kRotationTolerance && R.determinant() > 0) return {};
  return fmt::format("found a 3 x 3 block that is no rotation (off by {:.3g}), wanted one to {}: {}", off,
                     kRotationTolerance, likely_cause(R));
}

std::string complaint_about_translation(const Eigen::Vector3d& p) {
  if (p.cwiseAbs().maxCoeff() <= kTranslationMax_m) return {};
  return fmt::format("found the translation {} {} {}, wanted metres within {} (is it in millimetres?)", p[0], p[1],
                     p[2], kTranslationMax_m);
}

void append_leaves(const YAML::Node& node, std::vector<YAML::Node>& leaves) {
  if (!node.IsSequence()) return leaves.push_back(node);
  for (const YAML::Node& child : node) {
    if (child.IsSequence() && child.size() != 4) return leaves.clear();
    append_leaves(child, leaves);
  }
}

std::optional<Eigen::Matrix4d> matrix_of(const YAML::Node& node, std::string& complaint) {
  const YAML::Node list = node.IsMap() && node["data"] ? node["data"] : node;
  std::vector<YAML::Node> leaves;
  append_leaves(list, leaves);
  if (leaves.size() != kElements) {
    complaint = fmt::format("found {}, {}", describe(node), kWanted);
    return std::nullopt;
  }
  Eigen::Matrix4d T;
  for (int i = 0; i < kElements; ++i) {
    if (YAML::convert<double>::decode(leaves[i], T(i / 4, i % 4))) continue;
    complaint = fmt::format("found {} in row {}, column {}, wanted a number", describe(leaves[i]), i / 4, i % 4);
    return std::nullopt;
  }
  return T;
}

}  // namespace

std::string complaint_about_transform(const Eigen::Matrix4d& T) {
  if (!T.allFinite()) return fmt::format("found a number that is not finite, {}", kWanted);
  if (std::string row = complaint_about_last_row(T); !row.empty()) return row;
  if (std::string R = complaint_about_rotation(T.topLeftCorner<3, 3>()); !R.empty()) return R;
  return complaint_about_translation(T.topRightCorner<3, 1>());
}

std::optional<Pose> read_transform(YamlSection& section, std::string_view key) {
  const auto node = section.find(key);
  if (!node) return std::nullopt;
  std::string complaint;
  const auto T = matrix_of(*node, complaint);
  if (T) complaint = complaint_about_transform(*T);
  if (complaint.empty()) return Pose{T->topLeftCorner<3, 3>(), T->topRightCorner<3, 1>()};
  section.complain(*node, key, complaint);
  return std::nullopt;
}

}  // namespace lxd
