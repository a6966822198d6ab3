// SPDX-License-Identifier: Apache-2.0
#include "backend/graph/gnss_track.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "backend/graph/earth_alignment.hpp"
#include "rt/so3.hpp"

namespace lxd {
namespace {

constexpr double kChiSquare3 = 16.27;                 // one sound fix in a thousand is beyond it
constexpr std::size_t kWaitingMeasurementsMax = 512;  // measurements; then every second is given up
constexpr double kExtentMin_m = 1;
constexpr double kTryAgain = 1.1;  // alignment is sought when so many times as many wait

double horizontal_sigma_m(const Eigen::Matrix3d& C) { return std::sqrt(0.5 * (C(0, 0) + C(1, 1))); }

double chi_square(const Eigen::Vector3d& e, const Eigen::Matrix3d& C) { return e.dot(C.ldlt().solve(e)); }

Eigen::Vector3d error_m(const GnssMeasurement& m, const Pose& T_map_body, const EarthAlignment& earth) {
  return earth.antenna_enu_m(T_map_body, m.antenna_body_m, m.antenna_velocity_mps) - m.enu_m;
}

bool sound(const GnssMeasurement& m, int key_frames) {
  return m.enu_m.allFinite() && m.antenna_body_m.allFinite() && m.antenna_velocity_mps.allFinite() &&
         m.covariance_m2.allFinite() && m.covariance_m2.llt().info() == Eigen::Success && m.key_frame >= 0 &&
         m.key_frame < key_frames;
}

}  // namespace

bool GnssTrack::add(const GnssMeasurement& measurement, const PoseOf& pose) {
  ++counts_.taken;
  GnssMeasurement m = measurement;
  m.covariance_m2.diagonal().array() += config_.gnss_sigma_min_m * config_.gnss_sigma_min_m;
  if (!sound(m, chain_.size())) {
    ++counts_.not_finite;
    return false;
  }
  if (!aligned()) return wait(m, pose);
  if (!agrees(m, pose)) {
    ++counts_.jumped;
    return false;
  }
  use(m);
  return true;
}

void GnssTrack::use(const GnssMeasurement& measurement) {
  if (fixes_.empty()) began_ = measurement.stamp;
  fixes_.push_back(measurement);
  const auto at_m = [this](const GnssMeasurement& m) {
    return Eigen::Vector3d(chain_[static_cast<int>(m.key_frame)].T_world_body.p);
  };
  extent_m_ = std::max(extent_m_, (at_m(measurement) - at_m(fixes_.front())).head<2>().norm());
}

bool GnssTrack::wait(const GnssMeasurement& measurement, const PoseOf& pose) {
  waiting_.push_back(measurement);
  if (waiting_.size() > kWaitingMeasurementsMax) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < waiting_.size(); i += 2) waiting_[kept++] = waiting_[i];
    counts_.unaligned += waiting_.size() - kept;
    waiting_.resize(kept);
    tried_ = 0;
  }
  return static_cast<double>(waiting_.size()) >= kTryAgain * static_cast<double>(tried_) && align(pose);
}

bool GnssTrack::align(const PoseOf& pose) {
  tried_ = waiting_.size();
  std::vector<AlignmentPair> pairs;
  for (const GnssMeasurement& m : waiting_) {
    const Eigen::Vector3d antenna = m.antenna_body_m - config_.gnss_delay_s * m.antenna_velocity_mps;
    const double fix_m = horizontal_sigma_m(m.covariance_m2), age_m = delay_sigma_m(m);
    pairs.push_back({pose(m.key_frame) * antenna, m.enu_m, std::sqrt(fix_m * fix_m + age_m * age_m)});
  }
  const auto fit = fit_alignment(pairs);
  if (!fit) return false;
  alignment_ = fit->alignment;
  alignment_->delay_s = config_.gnss_delay_s;
  for (std::size_t i = 0; i < waiting_.size(); ++i) {
    if (fit->fits[i])
      use(waiting_[i]);
    else
      ++counts_.unaligned;
  }
  waiting_.clear();
  return true;
}

// What the antenna does in the time by which the fix's age may be off.
double GnssTrack::delay_sigma_m(const GnssMeasurement& m) const {
  return config_.gnss_delay_sigma_s * m.antenna_velocity_mps.norm();
}

// The graph lags behind the fixes: it smooths over about the time that their errors last.
const GnssMeasurement& GnssTrack::settled_before(RigTime stamp) const {
  const RigTime since = stamp - Duration::from_seconds(config_.gnss_correlation_s);
  auto fix = fixes_.rbegin();
  while (fix + 1 != fixes_.rend() && fix->stamp > since) ++fix;
  return *fix;
}

// What odometry can have drifted, and what the yaw that all fixes so far show leaves open.
Eigen::Matrix3d GnssTrack::drift_m2(const GnssMeasurement& m, const PoseOf& pose) const {
  const GnssMeasurement& last = settled_before(m.stamp);
  const RelativeMotion since = chain_.motion(static_cast<int>(last.key_frame), static_cast<int>(m.key_frame));
  const Pose T_map_last = pose(last.key_frame), T_map_now = pose(m.key_frame);
  const Eigen::Matrix3d R_enu_last = Exp(Eigen::Vector3d(0, 0, alignment_->yaw_rad)) * T_map_last.R;
  const double yaw_rad = horizontal_sigma_m(m.covariance_m2) / std::max(kExtentMin_m, extent_m_);
  const double by_yaw_m = yaw_rad * (T_map_now.p - T_map_last.p).head<2>().norm();
  return R_enu_last * since.covariance.bottomRightCorner<3, 3>() * R_enu_last.transpose() +
         by_yaw_m * by_yaw_m * Eigen::Matrix3d::Identity();
}

// The last fix's own error counts, too: the graph may have followed it.
bool GnssTrack::agrees(const GnssMeasurement& m, const PoseOf& pose) const {
  const Eigen::Vector3d error = error_m(m, pose(m.key_frame), *alignment_);
  const Eigen::Matrix3d by_age_m2 = std::pow(delay_sigma_m(m), 2) * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d C = m.covariance_m2 + fixes_.back().covariance_m2 + drift_m2(m, pose) + by_age_m2;
  return chi_square(error, C) < kChiSquare3;
}

// By the measure of the others: the graph does not follow every fix as closely as its covariance would have it.
bool GnssTrack::drop_outliers(const PoseOf& pose) {
  if (fixes_.empty()) return false;
  constexpr double kMedian3 = 2.366;  // of chi square with three degrees of freedom
  std::vector<double> squares;
  for (const GnssMeasurement& m : fixes_)
    squares.push_back(chi_square(error_m(m, pose(m.key_frame), *alignment_), m.covariance_m2));
  std::vector<double> sorted = squares;
  std::ranges::nth_element(sorted, sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2));
  const double limit = kChiSquare3 * std::max(1.0, sorted[sorted.size() / 2] / kMedian3);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < fixes_.size(); ++i)
    if (squares[i] <= limit) fixes_[kept++] = fixes_[i];
  const std::size_t dropped = fixes_.size() - kept;
  counts_.outlying += dropped;
  fixes_.erase(fixes_.begin() + static_cast<std::ptrdiff_t>(kept), fixes_.end());
  return dropped > 0;
}

GnssCounts GnssTrack::counts() const {
  GnssCounts counts = counts_;
  counts.used = fixes_.size();
  counts.unaligned += waiting_.size();
  return counts;
}

}  // namespace lxd
