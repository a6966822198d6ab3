// SPDX-License-Identifier: Apache-2.0
#include "estimator/odometry.hpp"

#include <algorithm>
#include <cmath>

#include "rt/stopwatch.hpp"

namespace lxd {
namespace {

constexpr std::uint32_t kPointsMin = 30;   // a sweep with fewer usable returns is no sweep
constexpr std::size_t kResidualsMin = 30;  // fewer do not make an update
// Least agreement with the map of a sweep that may move the pose. Street, forest, room and hall have 0.7 and more;
// noise in place of a sweep 0.3 at most.
constexpr double kAgreementMin = 0.45;
constexpr std::uint32_t kLostSweepsMax = 10;  // beyond, what is seen begins a surface of its own
constexpr double kFirstVoxelEdge_m = 0.5;
constexpr double kIncrementDone_rad = 5e-5, kIncrementDone_m = 2e-4;  // an iteration that moves less is the last
bool usable(const LidarPoint& p, float min_square, float max_square) {
  const float square = p.x_m * p.x_m + p.y_m * p.y_m + p.z_m * p.z_m;
  return square >= min_square && square <= max_square;  // false for NaN, too
}

bool has_usable(std::span<const LidarPoint> points, const EstimatorConfig& e, std::uint32_t wanted) {
  const auto min_square = static_cast<float>(e.range_min_m * e.range_min_m);
  const auto max_square = static_cast<float>(e.range_max_m * e.range_max_m);
  std::uint32_t count = 0;
  return std::any_of(points.begin(), points.end(), [&](const LidarPoint& p) {
    count += usable(p, min_square, max_square);
    return count == wanted;
  });
}

}  // namespace

Odometry::Odometry(const OdometrySetup& setup, Arena& arena)
    : setup_(setup),
      map_(setup.mapping, setup.map, arena),
      motion_({setup.estimator, setup.imu, setup.wheel}, arena),
      registration_(arena.take<RegistrationPoint>("registration points", setup.registration_capacity)),
      registration_intensity_(arena.take<float>("registration intensities", setup.registration_capacity)),
      residuals_(arena.take<PointResidual>("residuals", setup.registration_capacity)),
      scratch_(arena.take<float>("residual ratios", setup.registration_capacity)),
      map_points_(arena.take<MapPoint>("deskewed points", setup.map.fine.points_per_sweep)),
      thinned_points_(arena.take<MapPoint>("thinned points", setup.registration_capacity)),
      registered_(arena.take<RegisteredPoint>("registered points", setup.registration_capacity)),
      first_sweep_(arena.take<LidarPoint>("first sweep", setup.map.fine.points_per_sweep)),
      voxels_(arena.take<VoxelSet::Slot>("thinning voxels", 2 * std::bit_ceil(setup.registration_capacity))),
      guess_(arena),
      guess_samples_(arena.take<GuessSample>("rotation guess points", RotationGuess::kSamplesMax)),
      voxel_edge_m_(kFirstVoxelEdge_m) {}

const SweepOutcome& Odometry::step(const Sweep& sweep) noexcept LXD_NONBLOCKING {
  outcome_ = {};
  outcome_.rejection = admit(sweep);
  if (outcome_.rejection != SweepRejection::none) return outcome_;
  Stopwatch stage;
  begin_ = sweep.begin;
  end_ = sweep.end;
  downsample(sweep.points());
  outcome_.times.downsample = stage.lap();
  if (phase_ == Phase::first_sweep || (phase_ == Phase::second_sweep && !bootstrap(sweep))) {
    begin_with(sweep);
    hand_over(sweep);
    return outcome_;
  }
  outcome_.source = motion_.predict(filter_, last_end_, end_);
  outcome_.times.predict = stage.lap();
  if (outcome_.source == MotionSource::constant_velocity) guess_rotation((end_ - last_end_).seconds());
  outcome_.times.rotation_guess = stage.lap();
  register_to_mesh(setup_.estimator.iterations_max);
  outcome_.times.lidar_update = stage.lap();
  lost_sweeps_ = outcome_.tracked ? 0 : lost_sweeps_ + 1;
  if (may_insert()) insert(sweep.points());
  outcome_.times.meshing = stage.lap();
  hand_over(sweep);
  return outcome_;
}

// A sweep that does not hold the pose would put its surfaces anywhere; but a carrier that has left its map for good
// must begin another.
bool Odometry::may_insert() const { return lost_sweeps_ == 0 || lost_sweeps_ > kLostSweepsMax; }

void Odometry::restart() {
  map_.clear();
  motion_.restart();
  voxel_edge_m_ = kFirstVoxelEdge_m;
  phase_ = Phase::first_sweep;
}

SweepRejection Odometry::admit(const Sweep& sweep) const {
  if (!has_usable(sweep.points(), setup_.estimator, kPointsMin)) return SweepRejection::too_few_points;
  if (phase_ != Phase::first_sweep && sweep.end <= last_end_) return SweepRejection::time_backwards;
  return SweepRejection::none;
}

// What does not fit is no reason to leave out the end of the sweep: wider voxels take from everywhere.
void Odometry::downsample(std::span<const LidarPoint> points) {
  while (!thin(points) && voxel_edge_m_ < kVoxelEdgeMax_m) voxel_edge_m_ = wider_voxel_edge(voxel_edge_m_);
  voxel_edge_m_ = next_voxel_edge(voxel_edge_m_, registration_count_, setup_.estimator.registration_points);
}

// One return a voxel; false when there are more than have room.
bool Odometry::thin(std::span<const LidarPoint> points) {
  const auto& e = setup_.estimator;
  const auto min_square = static_cast<float>(e.range_min_m * e.range_min_m);
  const auto max_square = static_cast<float>(e.range_max_m * e.range_max_m);
  const auto range_variance = static_cast<float>(e.range_sigma_m * e.range_sigma_m);
  const auto bearing_variance = static_cast<float>(e.bearing_sigma_rad * e.bearing_sigma_rad);
  const auto inverse_edge = static_cast<float>(1.0 / voxel_edge_m_);
  voxels_.clear();
  registration_count_ = 0;
  for (const LidarPoint& p : points) {
    if (!usable(p, min_square, max_square)) continue;
    const Eigen::Vector3f q(p.x_m, p.y_m, p.z_m);
    if (!voxels_.insert(pack((q * inverse_edge).array().floor().cast<int>().matrix()))) continue;
    if (registration_count_ == registration_.size()) return false;
    registration_intensity_[registration_count_] = p.intensity;
    registration_[registration_count_++] = {setup_.T_body_lidar * q.cast<double>(), p.offset_ns,
                                            range_variance + bearing_variance * q.squaredNorm()};
  }
  return true;
}

// Deskew with the current iterate, associate, weigh, solve: until the state rests.
void Odometry::register_to_mesh(int iterations) {
  filter_.begin_update();
  outcome_.tracked = false;
  const double normal_variance = setup_.estimator.normal_sigma_rad * setup_.estimator.normal_sigma_rad;
  LidarMatrix motion = LidarMatrix::Zero();
  for (int i = 0; i < iterations; ++i) {
    follow(filter_.state());
    const auto residuals = associate(registration_.first(registration_count_), path_, map_, residuals_);
    outcome_.points_used = static_cast<std::uint32_t>(residuals.size());
    if (residuals.size() < kResidualsMin) return lose();
    outcome_.residual_scale = residual_scale(residuals, scratch_);
    outcome_.agreement = agreement(residuals);
    NormalEquations sums = accumulate(residuals, outcome_.residual_scale, kernel_sigmas(i));
    if (i == 0) motion = motion_of(residuals, registration_.first(registration_count_), path_);
    sums.motion = sums.weight / static_cast<double>(residuals.size()) * motion;
    const Degeneracy degeneracy = find_degeneracy(sums, filter_.prior_root(), normal_variance);
    discount(degeneracy, sums);
    outcome_.degenerate_directions = degeneracy.directions;
    const StateVector dx = filter_.iterate(sums);
    outcome_.iterations = static_cast<std::uint32_t>(i + 1);
    if (dx.segment<3>(kTheta).norm() < kIncrementDone_rad && dx.segment<3>(kPosition).norm() < kIncrementDone_m) break;
    if (!dx.allFinite()) break;
  }
  if (outcome_.agreement < kAgreementMin) return lose();
  outcome_.tracked = filter_.conclude();
  not_finite_updates_ += !outcome_.tracked;
  if (outcome_.tracked) outcome_.innovation = filter_.innovation();
  follow(filter_.state());
}

// The update is given up: the pose is the prediction.
void Odometry::lose() {
  filter_.abandon();
  follow(filter_.state());
}

void Odometry::insert(std::span<const LidarPoint> points) {
  const auto& e = setup_.estimator;
  const auto min_square = static_cast<float>(e.range_min_m * e.range_min_m);
  const auto max_square = static_cast<float>(e.range_max_m * e.range_max_m);
  const auto range_variance = static_cast<float>(e.range_sigma_m * e.range_sigma_m);
  const auto bearing_variance = static_cast<float>(e.bearing_sigma_rad * e.bearing_sigma_rad);
  const Eigen::Matrix3f R_body_lidar = setup_.T_body_lidar.R.cast<float>();
  const Eigen::Vector3f p_body_lidar = setup_.T_body_lidar.p.cast<float>();
  std::size_t count = 0;
  for (const LidarPoint& p : points) {
    if (!usable(p, min_square, max_square)) continue;
    const Eigen::Vector3f q(p.x_m, p.y_m, p.z_m);
    map_points_[count++] = {path_.to_local(R_body_lidar * q + p_body_lidar, p.offset_ns),
                            range_variance + bearing_variance * q.squaredNorm()};
  }
  const Eigen::Vector3f lidar = (filter_.state().R * setup_.T_body_lidar.p).cast<float>();
  for (std::uint32_t i = 0; i < registration_count_; ++i)
    thinned_points_[i] = {path_.to_local(registration_[i].p_body_m.cast<float>(), registration_[i].offset_ns),
                          registration_[i].variance_m2};
  map_.insert({map_points_.first(count), thinned_points_.first(registration_count_), path_.origin(), lidar, end_});
  remember(map_points_.first(count));
}

void Odometry::hand_over(const Sweep& sweep) {
  outcome_.stamp = sweep.stamp;
  outcome_.not_finite_updates = not_finite_updates_;
  outcome_.T_world_body = path_.pose_at(sweep.end - sweep.stamp);
  outcome_.covariance = filter_.covariance().topLeftCorner<6, 6>();
  outcome_.registered_origin_m = path_.origin();
  for (std::uint32_t i = 0; i < registration_count_; ++i)
    registered_[i] = {
        (path_.to_world(registration_[i].p_body_m, registration_[i].offset_ns) - path_.origin()).cast<float>(),
        registration_intensity_[i]};
  outcome_.registered = registered_.first(may_insert() ? registration_count_ : 0);
  last_end_ = sweep.end;
}

}  // namespace lxd
