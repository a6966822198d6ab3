// SPDX-License-Identifier: Apache-2.0
#include "backend/pnp/pnp_refinement.hpp"

#include <algorithm>
#include <array>

#include <Eigen/Cholesky>
#include <ceres/ceres.h>

#include "rt/so3.hpp"

namespace lxd {
namespace {

constexpr double kHuber_sigmas = 1.5;
constexpr int kIterations = 20;
constexpr double kBehind = 1e3;  // sigmas: the residual of a point that left the view

Pose moved(const Pose& T, const Eigen::Map<const Vector6d>& step) {
  return {T.R * Exp(step.head<3>()), T.p + step.tail<3>()};
}

// The residual as a function of the step from a fixed pose, so that the step is the filter's own perturbation.
class ProjectionCost final : public ceres::SizedCostFunction<2, 6> {
 public:
  ProjectionCost(const ProjectionConstraint& constraint, const Pose& T_CH) : constraint_(constraint), T_CH_(T_CH) {}

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const Eigen::Map<const Vector6d> step(parameters[0]);
    ProjectionResidual found;
    const bool seen = project_constraint(constraint_, moved(T_CH_, step), found);
    Eigen::Map<Eigen::Vector2d>{residuals} = seen ? found.r : Eigen::Vector2d::Constant(kBehind);
    if (jacobians == nullptr || jacobians[0] == nullptr) return true;
    Eigen::Map<Eigen::Matrix<double, 2, 6, Eigen::RowMajor>> J(jacobians[0]);
    J.setZero();
    if (!seen) return true;
    J.leftCols<3>() = found.J.leftCols<3>() * Jr(step.head<3>());
    J.rightCols<3>() = found.J.rightCols<3>();
    return true;
  }

 private:
  ProjectionConstraint constraint_;
  Pose T_CH_;
};

Matrix6d information_at(std::span<const ProjectionConstraint> constraints, const Pose& T_CH) {
  Matrix6d out = Matrix6d::Zero();
  for (const ProjectionConstraint& constraint : constraints) {
    ProjectionResidual residual;
    if (!project_constraint(constraint, T_CH, residual)) continue;
    const double weight = std::min(1.0, kHuber_sigmas / residual.r.norm());  // norm 0: infinity, so 1
    out += weight * residual.J.transpose() * residual.J;
  }
  return out;
}

}  // namespace

std::optional<Matrix6d> refine_pose(std::span<const ProjectionConstraint> constraints, Pose& T_CH) {
  std::array<double, 6> step{};
  ceres::Problem problem;
  for (const ProjectionConstraint& constraint : constraints)
    problem.AddResidualBlock(new ProjectionCost(constraint, T_CH), new ceres::HuberLoss(kHuber_sigmas), step.data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = kIterations;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable()) return std::nullopt;
  T_CH = moved(T_CH, Eigen::Map<const Vector6d>(step.data()));
  T_CH.R = orthonormalized(T_CH.R);
  const Matrix6d information = information_at(constraints, T_CH);
  const Eigen::LLT<Matrix6d> root(information);
  if (root.info() != Eigen::Success) return std::nullopt;
  return information;
}

}  // namespace lxd
