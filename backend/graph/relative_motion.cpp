// SPDX-License-Identifier: Apache-2.0
#include "backend/graph/relative_motion.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "rt/so3.hpp"

namespace lxd {
namespace {

// Below any sensor's: keeps a covariance of zero from an infinite weight. rad^2 and m^2.
constexpr double kLeastVariance = 1e-12;

// How an error of T_a_b shows in T_a_c = T_a_b T_b_c.
Matrix6d carried_on(const Pose& ab, const Pose& bc) {
  Matrix6d F = Matrix6d::Identity();
  F.topLeftCorner<3, 3>() = bc.R.transpose();
  F.bottomLeftCorner<3, 3>() = -ab.R * hat(bc.p);
  return F;
}

// How an error of T_b_c shows in it.
Matrix6d turned_by(const Eigen::Matrix3d& R_a_b) {
  Matrix6d G = Matrix6d::Identity();
  G.bottomRightCorner<3, 3>() = R_a_b;
  return G;
}

}  // namespace

Pose box_plus(const Pose& T, const Vector6d& d) { return {T.R * Exp(d.head<3>()), T.p + d.tail<3>()}; }

Vector6d box_minus(const Pose& y, const Pose& x) {
  Vector6d d;
  d.head<3>() = Log(x.R.transpose() * y.R);
  d.tail<3>() = y.p - x.p;
  return d;
}

RelativeMotion operator*(const RelativeMotion& ab, const RelativeMotion& bc) {
  const Matrix6d F = carried_on(ab.T, bc.T), G = turned_by(ab.T.R);
  return {ab.T * bc.T, F * ab.covariance * F.transpose() + G * bc.covariance * G.transpose()};
}

// (R Exp(d))^T = R^T Exp(-R d), and -(R Exp(d))^T (p + dp) = -R^T p - [R^T p]x d - R^T dp.
RelativeMotion inverse_of(const RelativeMotion& ab) {
  const Eigen::Matrix3d Rt = ab.T.R.transpose();
  Matrix6d J = Matrix6d::Zero();
  J.topLeftCorner<3, 3>() = -ab.T.R;
  J.bottomLeftCorner<3, 3>() = -hat(Rt * ab.T.p);
  J.bottomRightCorner<3, 3>() = -Rt;
  return {ab.T.inverse(), J * ab.covariance * J.transpose()};
}

RelativeMotion between(const RelativeMotion& ab, const RelativeMotion& ac) {
  const Pose bc = ab.T.inverse() * ac.T;
  const Matrix6d F = carried_on(ab.T, bc), Gt = turned_by(ab.T.R).transpose();
  return {bc, without_negative(Gt * (ac.covariance - F * ab.covariance * F.transpose()) * Gt.transpose())};
}

bool alike(const RelativeMotion& a, const RelativeMotion& b) {
  constexpr double kChiSquare6 = 33.11;  // one true pair in a hundred thousand is beyond it
  const Vector6d e = box_minus(a.T, b.T);
  return e.dot((a.covariance + b.covariance).ldlt().solve(e)) < kChiSquare6;
}

Matrix6d without_negative(const Matrix6d& C) {
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(0.5 * (C + C.transpose()));
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).asDiagonal() * eigen.eigenvectors().transpose();
}

Matrix6d sqrt_information(const Matrix6d& covariance) {
  const Matrix6d C = covariance + kLeastVariance * Matrix6d::Identity();
  return C.llt().solve(Matrix6d::Identity()).llt().matrixU();
}

}  // namespace lxd
