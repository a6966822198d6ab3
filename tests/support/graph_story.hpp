// SPDX-License-Identifier: Apache-2.0
// A drive for the factor graph: a true path, what an odometry that drifts makes of it, loops and fixes from the truth.
#pragma once

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <Eigen/SVD>

#include "backend/graph/pose_graph.hpp"
#include "rt/so3.hpp"

namespace lxd::test {

// A kilometre up and down in wide bends, a pose every two metres.
inline std::vector<Pose> wide_bends() {
  std::vector<Pose> path;
  Pose T;
  for (int i = 0; i < 500; ++i) {
    path.push_back(T);
    T = T * Pose{Exp(Eigen::Vector3d(0, 0.002 * std::sin(i * 0.05), 0.02 * std::sin(i * 0.02))), {2, 0, 0}};
  }
  return path;
}

struct GraphStory {
  std::vector<Pose> truth;  // of each key frame
  std::vector<KeyFrame> key_frames;
  std::mt19937_64 engine{1};

  double normal(double sigma) { return sigma * std::normal_distribution<double>()(engine); }
  Eigen::Vector3d normals(double sigma) { return {normal(sigma), normal(sigma), normal(sigma)}; }

  // Drifts as the configuration says; `times` as much.
  void drive(const std::vector<Pose>& path, const GraphConfig& config, double speed_mps = 10, double times = 1) {
    truth = path;
    constexpr double kSubMesh_m = 40;
    double way_m = 0, time_s = 1000;
    for (std::size_t i = 0; i < path.size(); ++i) {
      KeyFrame frame;
      frame.id = static_cast<std::int64_t>(i);
      frame.T_world_body = path[0];
      if (i > 0) {
        const Pose step = path[i - 1].inverse() * path[i];
        frame.travelled_m = step.p.norm();
        frame.turned_rad = Log(step.R).norm();
        const double root = times * std::sqrt(frame.travelled_m);
        Vector6d drift;
        drift.head<3>() = normals(config.drift_rad_per_sqrt_m * root);
        drift.tail<3>() = normals(config.drift_m_per_sqrt_m * root);
        frame.T_world_body = key_frames.back().T_world_body * box_plus(step, drift);
      }
      way_m += frame.travelled_m;
      time_s += frame.travelled_m / speed_mps;
      frame.stamp = RigTime::from_seconds(time_s);
      frame.sub_mesh = static_cast<std::int64_t>(way_m / kSubMesh_m);
      key_frames.push_back(frame);
    }
  }

  LoopMeasurement loop(int from, int to, double sigma_m = 0.05, double sigma_rad = 2e-3) {
    const auto at = [this](int i) { return truth[static_cast<std::size_t>(i)]; };
    LoopMeasurement loop{from, to, at(from).inverse() * at(to), {}};
    Vector6d sigmas, error;
    sigmas << Eigen::Vector3d::Constant(sigma_rad), Eigen::Vector3d::Constant(sigma_m);
    error.head<3>() = normals(sigma_rad);
    error.tail<3>() = normals(sigma_m);
    loop.T_from_to = box_plus(loop.T_from_to, error);
    loop.covariance = sigmas.cwiseAbs2().asDiagonal();
    return loop;
  }

  // Where the truth lies on the earth, and how late its fixes come.
  EarthAlignment earth{0.7, {120, -35, 410}, 0.05};
  Eigen::Vector3d antenna_m{-0.3, 0.2, 1.0};

  // A fix at a key frame; `error_m` is what the receiver is wrong by.
  GnssMeasurement fix(int i, double sigma_m, const Eigen::Vector3d& error_m) const {
    const auto at = [this](int k) { return truth[static_cast<std::size_t>(k)]; };
    GnssMeasurement fix;
    fix.key_frame = i;
    fix.stamp = key_frames[static_cast<std::size_t>(i)].stamp;
    fix.antenna_body_m = antenna_m;
    fix.antenna_velocity_mps.setZero();
    if (i > 0) {
      const double dt_s = (fix.stamp - key_frames[static_cast<std::size_t>(i) - 1].stamp).seconds();
      fix.antenna_velocity_mps = at(i).R.transpose() * (at(i) * antenna_m - at(i - 1) * antenna_m) / dt_s;
    }
    fix.enu_m = earth.to_enu(at(i) * (antenna_m - earth.delay_s * fix.antenna_velocity_mps)) + error_m;
    fix.covariance_m2 = sigma_m * sigma_m * Eigen::Vector3d(1, 1, 4).asDiagonal();
    return fix;
  }
};

// Round and round in a circle, gently up and down.
inline std::vector<Pose> ring(double length_m, double rounds, double step_m) {
  std::vector<Pose> path;
  const double radius_m = length_m / (2 * std::numbers::pi);
  for (double way_m = 0; way_m < rounds * length_m; way_m += step_m) {
    const double angle = way_m / radius_m;
    path.push_back({Exp(Eigen::Vector3d(0, 0, angle + std::numbers::pi / 2)),
                    {radius_m * std::cos(angle), radius_m * std::sin(angle), std::sin(2 * angle)}});
  }
  return path;
}

// Root mean square of positions after the best rigid motion of one onto the other.
inline double aligned_error_m(const std::vector<Pose>& truth, const PoseGraph& graph) {
  const auto n = static_cast<Eigen::Index>(truth.size());
  Eigen::Matrix3Xd a(3, n), b(3, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    a.col(i) = graph.T_map_body(static_cast<int>(i)).p;
    b.col(i) = truth[static_cast<std::size_t>(i)].p;
  }
  const Eigen::Vector3d a_mean = a.rowwise().mean(), b_mean = b.rowwise().mean();
  const Eigen::Matrix3Xd a_about = a.colwise() - a_mean, b_about = b.colwise() - b_mean;
  const Eigen::Matrix3d H = b_about * a_about.transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(H, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double turn = (svd.matrixU() * svd.matrixV().transpose()).determinant();
  const Eigen::Matrix3d R = svd.matrixU() * Eigen::Vector3d(1, 1, turn).asDiagonal() * svd.matrixV().transpose();
  return std::sqrt((R * a_about - b_about).squaredNorm() / static_cast<double>(n));
}

}  // namespace lxd::test
