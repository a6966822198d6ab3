// SPDX-License-Identifier: Apache-2.0
#include "backend/graph/graph_problem.hpp"

#include <array>
#include <cmath>
#include <memory>

#include <ceres/loss_function.h>
#include <ceres/manifold.h>
#include <ceres/problem.h>
#include <ceres/sized_cost_function.h>
#include <ceres/solver.h>

#include "rt/so3.hpp"

namespace lxd {
namespace {

// A pose as Ceres holds it: quaternion x y z w, position.
constexpr int kPoseSize = 7, kTangentSize = 6;
using PoseBlock = std::array<double, kPoseSize>;
using AlignmentBlock = std::array<double, kAlignmentSize>;

PoseBlock block_of(const Pose& T) {
  PoseBlock block;
  Eigen::Map<Eigen::Vector4d>(block.data()) = T.quaternion().coeffs();
  Eigen::Map<Eigen::Vector3d>(block.data() + 4) = T.p;
  return block;
}

Pose pose_of(const double* block) {
  return {Eigen::Map<const Eigen::Quaterniond>(block).toRotationMatrix(), Eigen::Map<const Eigen::Vector3d>(block + 4)};
}

AlignmentBlock block_of(const EarthAlignment& a) {
  return {a.yaw_rad, a.offset_m.x(), a.offset_m.y(), a.offset_m.z(), a.delay_s};
}

EarthAlignment alignment_of(const double* block) { return {block[0], Eigen::Vector3d(block + 1), block[4]}; }

// rt/so3's perturbation. The factors give their Jacobians by the tangent; they stand in the first six of the seven
// columns that Ceres wants, and this chart's Jacobian hands them through.
class PoseManifold final : public ceres::Manifold {
 public:
  int AmbientSize() const override { return kPoseSize; }
  int TangentSize() const override { return kTangentSize; }
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override {
    const PoseBlock block = block_of(box_plus(pose_of(x), Eigen::Map<const Vector6d>(delta)));
    std::copy(block.begin(), block.end(), x_plus_delta);
    return true;
  }
  bool PlusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, kPoseSize, kTangentSize, Eigen::RowMajor>>(jacobian).setIdentity();
    return true;
  }
  bool Minus(const double* y, const double* x, double* y_minus_x) const override {
    Eigen::Map<Vector6d>(y_minus_x, kTangentSize) = box_minus(pose_of(y), pose_of(x));
    return true;
  }
  bool MinusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, kTangentSize, kPoseSize, Eigen::RowMajor>>(jacobian).setIdentity();
    return true;
  }
};

template <int kRows, int kColumns>
void put(const Eigen::Matrix<double, kRows, kColumns>& by_tangent, double* jacobian) {
  Eigen::Map<Eigen::Matrix<double, kRows, kPoseSize, Eigen::RowMajor>> J(jacobian);
  J.setZero();
  J.template leftCols<kColumns>() = by_tangent;
}

class RelativeCost final : public ceres::SizedCostFunction<6, kPoseSize, kPoseSize> {
 public:
  explicit RelativeCost(const RelativeFactor& factor) : factor_(factor) {}
  bool Evaluate(double const* const* x, double* r, double** J) const override {
    Matrix6d by_a, by_b;
    Eigen::Map<Vector6d> residual(r);
    residual = factor_.evaluate(pose_of(x[0]), pose_of(x[1]), &by_a, &by_b);
    if (J != nullptr && J[0] != nullptr) put(by_a, J[0]);
    if (J != nullptr && J[1] != nullptr) put(by_b, J[1]);
    return residual.allFinite();
  }

 private:
  RelativeFactor factor_;
};

void put_square(const Eigen::Matrix3d& by_vector, double* jacobian) {
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> J(jacobian);
  J = by_vector;
}

using AlignmentRows = Eigen::Matrix<double, 3, kAlignmentSize, Eigen::RowMajor>;

class GnssCost final : public ceres::SizedCostFunction<3, kPoseSize, kAlignmentSize, 3, 3> {
 public:
  GnssCost(const GnssFactor& factor, double toward) : factor_(factor), toward_(toward) {}
  bool Evaluate(double const* const* x, double* r, double** J) const override {
    Eigen::Matrix<double, 3, 6> by_pose;
    Eigen::Matrix<double, 3, kAlignmentSize> by_alignment;
    Eigen::Map<Eigen::Vector3d> residual(r);
    const Eigen::Vector3d b = (1 - toward_) * Eigen::Vector3d(x[2]) + toward_ * Eigen::Vector3d(x[3]);
    residual = factor_.evaluate(pose_of(x[0]), alignment_of(x[1]), b, &by_pose, &by_alignment);
    if (J == nullptr) return residual.allFinite();
    if (J[0] != nullptr) put(by_pose, J[0]);
    if (J[1] != nullptr) Eigen::Map<AlignmentRows>(J[1], 3, kAlignmentSize) = by_alignment;
    if (J[2] != nullptr) put_square((1 - toward_) * factor_.by_lasting(), J[2]);
    if (J[3] != nullptr) put_square(toward_ * factor_.by_lasting(), J[3]);
    return residual.allFinite();
  }

 private:
  GnssFactor factor_;
  double toward_;
};

class LastingCost final : public ceres::SizedCostFunction<3, 3, 3> {
 public:
  explicit LastingCost(const LastingFactor& factor) : factor_(factor) {}
  bool Evaluate(double const* const* x, double* r, double** J) const override {
    const double before = factor_.by_before(), now = factor_.by_now();
    Eigen::Map<Eigen::Vector3d>(r, 3) = before * Eigen::Vector3d(x[0]) + now * Eigen::Vector3d(x[1]);
    if (J != nullptr && J[0] != nullptr) put_square(before * Eigen::Matrix3d::Identity(), J[0]);
    if (J != nullptr && J[1] != nullptr) put_square(now * Eigen::Matrix3d::Identity(), J[1]);
    return true;
  }

 private:
  LastingFactor factor_;
};

class FirstLastingCost final : public ceres::SizedCostFunction<3, 3> {
 public:
  bool Evaluate(double const* const* x, double* r, double** J) const override {
    std::copy_n(x[0], 3, r);
    if (J != nullptr && J[0] != nullptr) put_square(Eigen::Matrix3d::Identity(), J[0]);
    return true;
  }
};

// Tilt and anchor: of one pose.
template <typename Factor, int kRows>
class PoseCost final : public ceres::SizedCostFunction<kRows, kPoseSize> {
 public:
  explicit PoseCost(const Factor& factor) : factor_(factor) {}
  bool Evaluate(double const* const* x, double* r, double** J) const override {
    Eigen::Matrix<double, kRows, 6> by_pose;
    Eigen::Map<Eigen::Matrix<double, kRows, 1>>(r, kRows) = factor_.evaluate(pose_of(x[0]), &by_pose);
    if (J != nullptr && J[0] != nullptr) put(by_pose, J[0]);
    return true;
  }

 private:
  Factor factor_;
};

class DelayCost final : public ceres::SizedCostFunction<1, kAlignmentSize> {
 public:
  DelayCost(double expected_s, double sigma_s) : expected_s_(expected_s), sigma_s_(sigma_s) {}
  bool Evaluate(double const* const* x, double* r, double** J) const override {
    r[0] = (x[0][kAlignmentSize - 1] - expected_s_) / sigma_s_;
    if (J == nullptr || J[0] == nullptr) return true;
    std::fill_n(J[0], kAlignmentSize, 0.0);
    J[0][kAlignmentSize - 1] = 1 / sigma_s_;
    return true;
  }

 private:
  double expected_s_, sigma_s_;
};

class CeresProblem {
 public:
  explicit CeresProblem(const GraphProblem& problem)
      : source_(problem), alignment_(block_of(problem.alignment)), lasting_(problem.lasting) {
    blocks_.reserve(problem.poses.size());
    for (const Pose& T : problem.poses) blocks_.push_back(block_of(T));
    for (PoseBlock& block : blocks_) problem_.AddParameterBlock(block.data(), kPoseSize, &manifold_);
    for (std::size_t i = 0; i < problem.held.size(); ++i)
      if (problem.held[i]) problem_.SetParameterBlockConstant(blocks_[i].data());
    add_factors();
  }

  ceres::Problem& problem() { return problem_; }

  void write_back(GraphProblem& problem) const {
    for (std::size_t i = 0; i < blocks_.size(); ++i) problem.poses[i] = pose_of(blocks_[i].data());
    problem.alignment = alignment_of(alignment_.data());
    problem.lasting = lasting_;
  }

 private:
  static ceres::Problem::Options options() {
    ceres::Problem::Options options;
    options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    return options;
  }

  double* block(int node) { return blocks_[static_cast<std::size_t>(node)].data(); }

  void add_factors() {
    for (const auto& [a, b, factor, robust] : source_.relative)
      problem_.AddResidualBlock(new RelativeCost(factor), robust > 0 ? new ceres::HuberLoss(robust) : nullptr, block(a),
                                block(b));
    for (const auto& [node, factor] : source_.tilt)
      problem_.AddResidualBlock(new PoseCost<TiltFactor, 3>(factor), nullptr, block(node));
    if (source_.anchor) problem_.AddResidualBlock(new PoseCost<AnchorFactor, 6>(*source_.anchor), nullptr, block(0));
    if (!source_.gnss.empty()) add_gnss();
  }

  void add_gnss() {
    problem_.AddParameterBlock(alignment_.data(), kAlignmentSize);
    for (Eigen::Vector3d& b : lasting_) problem_.AddParameterBlock(b.data(), 3);
    for (const auto& [node, factor, robust, knot, toward] : source_.gnss)
      problem_.AddResidualBlock(new GnssCost(factor, toward), new ceres::HuberLoss(robust), block(node),
                                alignment_.data(), lasting_[knot].data(), lasting_[knot + 1].data());
    for (std::size_t k = 1; k < lasting_.size(); ++k)
      problem_.AddResidualBlock(new LastingCost(source_.lasting_factor), nullptr, lasting_[k - 1].data(),
                                lasting_[k].data());
    if (source_.first_lasting_held)
      problem_.SetParameterBlockConstant(lasting_.front().data());
    else
      problem_.AddResidualBlock(new FirstLastingCost, nullptr, lasting_.front().data());
    problem_.AddResidualBlock(new DelayCost(source_.delay_expected_s, source_.delay_sigma_s), nullptr,
                              alignment_.data());
    if (source_.alignment_held) problem_.SetParameterBlockConstant(alignment_.data());
  }

  const GraphProblem& source_;
  PoseManifold manifold_;
  std::vector<PoseBlock> blocks_;
  AlignmentBlock alignment_;
  std::vector<Eigen::Vector3d> lasting_;
  ceres::Problem problem_{options()};
};

}  // namespace

GraphSolution solve(GraphProblem& problem, const SolverEffort& effort) {
  CeresProblem ceres_problem(problem);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.sparse_linear_algebra_library_type = ceres::SUITE_SPARSE;
  options.max_num_iterations = effort.iterations_max;
  options.function_tolerance = effort.cost_tolerance;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &ceres_problem.problem(), &summary);
  const bool usable = summary.IsSolutionUsable() && std::isfinite(summary.final_cost);
  if (usable) ceres_problem.write_back(problem);
  return {summary.initial_cost, summary.final_cost, static_cast<int>(summary.iterations.size()), usable};
}

double cost_of(const GraphProblem& problem) {
  CeresProblem ceres_problem(problem);
  double cost = 0;
  ceres_problem.problem().Evaluate({}, &cost, nullptr, nullptr, nullptr);
  return cost;
}

}  // namespace lxd
