// SPDX-License-Identifier: Apache-2.0
#include "estimator/odometry.hpp"

#include <algorithm>
#include <cmath>

#include "estimator/rate_information.hpp"
#include "rt/stopwatch.hpp"

namespace lxd {
namespace {

constexpr std::uint32_t kFeaturesMin = 8;  // likewise, of an image
constexpr int kSearch = 3;                 // times as many iterations as else, when in doubt: the way is long
constexpr Duration kLately = Duration::from_ns(500'000'000);  // a sensor that is silent for longer is gone
constexpr double kFirstVoxelEdge_m = 0.5;
constexpr double kIncrementMax = 1e3;  // m, rad, m/s ...: beyond, the equations had no solution
constexpr double kIncrementDone_rad = 5e-5, kIncrementDone_m = 2e-4;  // an iteration that moves less is the last
LidarModel lidar0_of(const OdometrySetup& setup) {
  const EstimatorConfig& e = setup.estimator;
  return {setup.T_body_lidar, e.range_min_m, e.range_max_m, e.range_sigma_m, e.bearing_sigma_rad};
}

ImuDelay imu_delay_of(const OdometrySetup& setup) {
  return setup.imu ? ImuDelay(setup.imu->delay_s, setup.imu->delay_sigma_s) : ImuDelay();
}

ImuMount imu_mount_of(const OdometrySetup& setup) { return ImuMount(setup.imu ? setup.imu->rotation_sigma_rad : 0); }

// Nobody waits for an extra LiDAR that is not there.
std::size_t extra_capacity(const OdometrySetup& setup) { return setup.lidar1 ? setup.map.fine.points_per_sweep : 0; }

}  // namespace

Odometry::Odometry(const OdometrySetup& setup, Arena& arena)
    : setup_(setup),
      map_(setup.mapping, setup.map, arena),
      filter_(imu_delay_of(setup), imu_mount_of(setup)),
      motion_({setup.estimator, setup.imu, setup.wheel, setup.R_world_body}, arena),
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
      budget_(Duration::from_seconds(1e-3 * setup.estimator.budget_ms)),
      voxel_edge_m_(kFirstVoxelEdge_m),
      extra_(arena, extra_capacity(setup)),
      lidar0_(lidar0_of(setup)) {
  if (setup.camera) vision_.emplace(*setup.camera, setup.estimator.vision, arena);
}

const SweepOutcome& Odometry::step(const Sweep& sweep) noexcept LXD_NONBLOCKING {
  outcome_ = {};
  outcome_.rejection = admit(sweep);
  if (outcome_.rejection != SweepRejection::none) return outcome_;
  outcome_.carried = sweep.count == 0;
  budget_.begin();
  Stopwatch stage;
  take(sweep);
  downsample();
  outcome_.times.downsample = stage.lap();
  if (phase_ == Phase::first_sweep || (phase_ == Phase::second_sweep && !bootstrap(sweep))) {
    begin_with(sweep);
    hand_over(sweep);
    return outcome_;
  }
  outcome_.source = motion_.predict(filter_, last_end_, end_);
  outcome_.times.predict = stage.lap();
  begin_trial();
  if (outcome_.source == MotionSource::constant_velocity || lost_sweeps_ > 0) guess_rotation();
  outcome_.times.rotation_guess = stage.lap();
  image_in_hand_ = vision_ && vision_->begin(begin_, end_);
  if (image_in_hand_) image_variance_ = motion_.path_variance(vision_->instant(), end_);
  register_to_mesh((in_doubt() ? kSearch : 1) * setup_.estimator.iterations_max);
  outcome_.times.lidar_update = stage.lap() - outcome_.times.visual_update;
  if (vision_) conclude_image();
  align_sensors();
  outcome_.times.raycast = stage.lap();
  count_lost();
  if (may_insert()) insert();
  outcome_.times.meshing = stage.lap();
  hand_over(sweep);
  outcome_.over_budget = budget_.end();
  return outcome_;
}

void Odometry::restart() {
  map_.clear();
  filter_ = Ieskf(imu_delay_of(setup_), imu_mount_of(setup_));
  motion_.clear();
  extra_.clear();
  search_rest_ = {};
  trial_ = {};
  last_extra_ = kNever;
  if (vision_) vision_->forget();
  voxel_edge_m_ = kFirstVoxelEdge_m;
  phase_ = Phase::first_sweep;
}

// The sweep, and what the extra LiDAR has fired since the one before.
void Odometry::take(const Sweep& sweep) {
  const bool extra = !extra_.empty() && sweep.end - extra_.begin() <= ExtraReturns::kSpanMax;
  begin_ = extra ? std::min(sweep.begin, extra_.begin()) : sweep.begin;
  end_ = sweep.end;
  const auto shift_ns = [this](RigTime zero) { return static_cast<std::uint32_t>((zero - begin_).ns()); };
  primary_returns_ = {lidar0_, sweep.points(), shift_ns(sweep.begin)};
  extra_returns_ = extra ? LidarReturns(*setup_.lidar1, extra_.points(), shift_ns(extra_.begin())) : LidarReturns();
}

// What does not fit is no reason to leave out the end of the sweep: wider voxels take from everywhere.
void Odometry::downsample() {
  while (!thin() && voxel_edge_m_ < kVoxelEdgeMax_m) voxel_edge_m_ = wider_voxel_edge(voxel_edge_m_);
  if (registration_count_ > 0) voxel_edge_m_ = next_voxel_edge(voxel_edge_m_, registration_count_, points_wanted());
}

int Odometry::points_wanted() const {
  return static_cast<int>(budget_.points_share() * setup_.estimator.registration_points);
}

// One return a voxel; false when there are more than have room.
bool Odometry::thin() {
  const auto inverse_edge = static_cast<float>(1.0 / voxel_edge_m_);
  voxels_.clear();
  registration_count_ = 0;
  const auto take = [&](const Return& r) {
    if (!voxels_.insert(pack((r.p_body_m * inverse_edge).array().floor().cast<int>().matrix()))) return true;
    if (registration_count_ == registration_.size()) return false;
    registration_intensity_[registration_count_] = r.intensity;
    registration_[registration_count_++] = {r.p_body_m.cast<double>(), r.offset_ns, r.variance_m2};
    return true;
  };
  if (!primary_returns_.for_each(take)) return false;
  registered_primary_ = registration_count_;
  return extra_returns_.for_each(take);
}

// Deskew with the current iterate, associate, weigh, solve: until the state rests.
void Odometry::register_to_mesh(int iterations) {
  filter_.begin_update();
  outcome_.tracked = false;
  LidarMatrix motion = LidarMatrix::Zero();
  Iteration last;
  for (int i = 0; i < iterations && (i == 0 || budget_.allows_iteration()); ++i) {
    follow(filter_.state());
    NormalEquations sums = see_surfaces(i, motion);
    sums += see_features(i);
    if (!enough()) return lose();
    const StateVector dx = filter_.iterate(sums);
    last = {kernel_sigmas(i), sums.information, dx};
    outcome_.iterations = static_cast<std::uint32_t>(i + 1);
    if (dx.segment<3>(kTheta).norm() < kIncrementDone_rad && dx.segment<3>(kPosition).norm() < kIncrementDone_m) break;
    if (!(dx.norm() < kIncrementMax)) return diverge();
  }
  if (!belongs()) return lose();
  outcome_.tracked = filter_.conclude(see_delay(last), sees_imu());
  not_finite_updates_ += !outcome_.tracked;
  if (outcome_.tracked) outcome_.innovation = filter_.innovation();
  follow(filter_.state());
}

bool Odometry::enough_features() const { return image_in_hand_ && vision_->residuals() >= kFeaturesMin; }

bool Odometry::enough() const { return outcome_.points_used >= kResidualsMin || enough_features(); }

// Point-to-mesh residuals of all LiDARs, less what is noise of the surfaces' normals. `motion` is that of the first
// iteration, which the others hardly change.
NormalEquations Odometry::see_surfaces(int iteration, LidarMatrix& motion) {
  const auto points = registration_.first(registration_count_);
  const auto residuals = associate(points, path_, setup_.T_body_lidar.p, map_, residuals_);
  outcome_.points_used = static_cast<std::uint32_t>(residuals.size());
  outcome_.agreement = agreement(residuals);
  if (residuals.size() < kResidualsMin) return {};
  outcome_.residual_scale = residual_scale(residuals, scratch_);
  NormalEquations sums = accumulate(residuals, outcome_.residual_scale, kernel_sigmas(iteration));
  if (iteration == 0) motion = motion_of(residuals, points, path_);
  sums.motion = sums.weight / static_cast<double>(residuals.size()) * motion;
  const double normal_sigma = setup_.estimator.normal_sigma_rad;
  const Degeneracy degeneracy = find_degeneracy(sums, filter_.prior_root(), normal_sigma * normal_sigma);
  discount(degeneracy, sums);
  limit_rates(residuals.size(), sums);
  outcome_.degenerate_directions = degeneracy.directions;
  return sums;
}

// What the skew says of the IMU's delay; nothing where a direction is open that the delay might be mistaken for.
DelaySums Odometry::see_delay(const Iteration& last) {
  if (!(filter_.delay().sigma_s() > 0)) return {};  // known exactly
  if (!sees_imu()) return {};
  const auto residuals = residuals_.first(outcome_.points_used);
  DelaySums sums = delay_sums(residuals, registration_, path_, {outcome_.residual_scale, last.kernel_sigmas});
  sums.gradient += sums.coupling.dot(last.step.head<kLidarDim>());
  limit(residuals.size(), last.information, -filter_.prior_pull().head<6>(), sums);
  return sums;
}

void Odometry::diverge() {
  ++not_finite_updates_;
  lose();
}

// The update is given up: the pose is the prediction.
void Odometry::lose() {
  filter_.abandon();
  follow(filter_.state());
}

void Odometry::insert() {
  std::size_t count = 0;
  const auto put = [&](const Return& r) {
    if (count == map_points_.size()) return false;
    map_points_[count++] = {path_.to_local(r.p_body_m, r.offset_ns), r.variance_m2};
    return true;
  };
  primary_returns_.for_each(put);
  const std::size_t primary_count = count;
  extra_returns_.for_each(put);
  const Eigen::Vector3f lidar = (filter_.state().R * setup_.T_body_lidar.p).cast<float>();
  for (std::uint32_t i = 0; i < registration_count_; ++i)
    thinned_points_[i] = {path_.to_local(registration_[i].p_body_m.cast<float>(), registration_[i].offset_ns),
                          registration_[i].variance_m2};
  map_.insert({map_points_.first(count), thinned_points_.first(registration_count_), path_.origin(), lidar, end_});
  if (primary_count > 0) remember(map_points_.first(primary_count));
}

Pose Odometry::pose_at(RigTime t) {
  const PathKnot knot = motion_.knot(filter_.state(), t, end_);
  return {knot.R, knot.p};
}

SensorsAtWork Odometry::at_work() {
  const auto lately = [this](RigTime t) { return end_ - t <= kLately; };
  if (!extra_.empty()) last_extra_ = end_;
  return {.primary_lidar = outcome_.tracked && outcome_.points_used >= kResidualsMin,
          .extra_lidar = lately(last_extra_),
          .camera = vision_ && lately(vision_->instant()),
          .imu = motion_.inertial(),
          .wheel = lately(motion_.rolled_until())};
}

void Odometry::hand_over(const Sweep& sweep) {
  outcome_.stamp = sweep.stamp;
  outcome_.camera_delay = camera_delay();
  if (vision_) outcome_.R_body_camera = vision_->alignment().R_body_camera();
  outcome_.at_work = at_work();
  outcome_.not_finite_updates = not_finite_updates_;
  outcome_.T_world_body = pose_at(sweep.stamp);
  outcome_.covariance = filter_.covariance().topLeftCorner<6, 6>();
  outcome_.registered_origin_m = path_.origin();
  const auto place = [this](const Eigen::Vector3d& p_body_m, std::uint32_t offset_ns) -> Eigen::Vector3f {
    return (path_.to_world(p_body_m, offset_ns) - path_.origin()).cast<float>();
  };
  const auto span_ns = static_cast<std::uint32_t>((end_ - begin_).ns());
  const float share = 1 / static_cast<float>(std::max(span_ns, 1U));
  for (std::uint32_t i = 0; i < registration_count_; ++i) {
    const std::uint32_t offset_ns = registration_[i].offset_ns;
    registered_[i] = {place(registration_[i].p_body_m, offset_ns), registration_intensity_[i],
                      1 - share * static_cast<float>(offset_ns)};
  }
  outcome_.registered = registered_.first(may_insert() ? registration_count_ : 0);
  outcome_.registered_primary = may_insert() ? registered_primary_ : 0;
  outcome_.lidar_then_m = place(setup_.T_body_lidar.p, 0);
  outcome_.lidar_m = place(setup_.T_body_lidar.p, span_ns);
  last_end_ = sweep.end;
  extra_.clear();
}

}  // namespace lxd
