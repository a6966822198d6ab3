// SPDX-License-Identifier: Apache-2.0
#include "backend/pnp/projection_residual.hpp"

#include <Eigen/Cholesky>

#include "rt/so3.hpp"

namespace lxd {
namespace {

constexpr double kNearest_m = 0.05;  // points nearer than this to the image's plane project to nowhere

ProjectionConstraint constraint_of(Direction direction, const VisualFeature& landmark, const VisualFeature& seen) {
  ProjectionConstraint out;
  out.direction = direction;
  out.point_m = landmark.point_m();
  const Eigen::Vector3d b = seen.bearing.cast<double>();
  out.seen = b.head<2>() / b.z();
  out.seen_sigma = static_cast<double>(seen.sigma_rad) / (b.z() * b.z());  // at most: along the image's radius
  out.point_sigma_m = static_cast<double>(landmark.distance_sigma_m);
  out.across_sigma_m = static_cast<double>(landmark.sigma_rad * landmark.distance_m);
  return out;
}

void add_set(Direction direction, const VisualKeyFrame& landmarks, const VisualKeyFrame& image,
             std::span<const FeatureMatch> matches, std::vector<ProjectionConstraint>& out) {
  const bool forward = direction == Direction::forward;
  for (const FeatureMatch& match : matches) {
    const VisualFeature& landmark = landmarks.features[forward ? match.historical : match.current];
    const VisualFeature& seen = image.features[forward ? match.current : match.historical];
    if (landmark.has_point() && seen.bearing.z() > 0) out.push_back(constraint_of(direction, landmark, seen));
  }
}

}  // namespace

std::vector<ProjectionConstraint> constraints_of(const VisualKeyFrame& historical, const VisualKeyFrame& current,
                                                 std::span<const FeatureMatch> matches) {
  std::vector<ProjectionConstraint> out;
  add_set(Direction::forward, historical, current, matches, out);
  add_set(Direction::backward, current, historical, matches, out);
  return out;
}

bool project_constraint(const ProjectionConstraint& constraint, const Pose& T_CH, ProjectionResidual& out) {
  const bool forward = constraint.direction == Direction::forward;
  const Eigen::Matrix3d R = forward ? T_CH.R : Eigen::Matrix3d(T_CH.R.transpose());
  const Eigen::Vector3d q = forward ? T_CH * constraint.point_m : Eigen::Vector3d(R * (constraint.point_m - T_CH.p));
  if (!(q.z() > kNearest_m)) return false;
  Eigen::Matrix<double, 2, 3> P;  // d pi / d q
  P << 1 / q.z(), 0, -q.x() / (q.z() * q.z()), 0, 1 / q.z(), -q.y() / (q.z() * q.z());
  // (R Exp(d)) P = R P + R (d x P); (R Exp(d))^T y = Exp(-d) R^T y = q - d x q.
  Eigen::Matrix<double, 3, 6> dq;
  if (forward) {
    dq << -T_CH.R * hat(constraint.point_m), Eigen::Matrix3d::Identity();
  } else {
    dq << hat(q), -R;
  }
  // The landmark's own uncertainty, seen in this image: long along its ray, short across it.
  const Eigen::Vector3d ray = constraint.point_m.normalized();
  const double along2 = constraint.point_sigma_m * constraint.point_sigma_m;
  const double across2 = constraint.across_sigma_m * constraint.across_sigma_m;
  const Eigen::Matrix3d point_cov = across2 * Eigen::Matrix3d::Identity() + (along2 - across2) * ray * ray.transpose();
  const Eigen::Matrix2d S = constraint.seen_sigma * constraint.seen_sigma * Eigen::Matrix2d::Identity() +
                            P * R * point_cov * R.transpose() * P.transpose();
  const Eigen::LLT<Eigen::Matrix2d> root(S);
  if (root.info() != Eigen::Success) return false;
  out.r = root.matrixL().solve(Eigen::Vector2d(q.head<2>() / q.z() - constraint.seen));
  out.J = root.matrixL().solve(Eigen::Matrix<double, 2, 6>(P * dq));
  return true;
}

}  // namespace lxd
