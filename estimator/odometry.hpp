// SPDX-License-Identifier: Apache-2.0
// Odometry: the whole of a sweep's life. Everything is allocated at construction; step() is the real-time path.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "estimator/config.hpp"
#include "estimator/downsample.hpp"
#include "estimator/extra_returns.hpp"
#include "estimator/ieskf.hpp"
#include "estimator/motion.hpp"
#include "estimator/place_trial.hpp"
#include "estimator/point_to_mesh.hpp"
#include "estimator/returns.hpp"
#include "estimator/rotation_guess.hpp"
#include "estimator/sweep_outcome.hpp"
#include "estimator/sweep_path.hpp"
#include "estimator/vision/visual_update.hpp"
#include "estimator/work_budget.hpp"
#include "mapping/config.hpp"
#include "mapping/surface_map.hpp"
#include "rt/arena.hpp"
#include "rt/nonblocking.hpp"
#include "rt/sweep.hpp"

namespace lxd {

struct OdometrySetup {
  EstimatorConfig estimator;
  MappingConfig mapping;
  SurfaceMapCapacity map;               // map.fine.points_per_sweep: capacity of a sweep
  std::uint32_t registration_capacity;  // residuals, at most
  Pose T_body_lidar;
  Eigen::Matrix3d R_world_body = Eigen::Matrix3d::Identity();  // at the beginning, when nothing tells what is up
  std::optional<LidarModel> lidar1;                            // an extra LiDAR, if one is in use
  std::optional<MountedCamera> camera;                         // if one is in use
  std::optional<ImuNoise> imu;                                 // of the body's IMU, if one is in use
  std::optional<WheelModel> wheel;                             // of the wheels, if they are in use
};

enum class FitDetail : std::uint8_t;

class Odometry {
 public:
  Odometry(const OdometrySetup& setup, Arena& arena);

  // Readings of the other sensors, in the order of their time: those up to a sweep's end before its step().
  void add(const InertialReading& reading) noexcept LXD_NONBLOCKING { motion_.add(reading); }
  void add(const WheelReading& reading) noexcept LXD_NONBLOCKING { motion_.add(reading); }
  // A return of the extra LiDAR, its offset counted from `zero`.
  void add_extra(RigTime zero, const LidarPoint& point) noexcept LXD_NONBLOCKING { extra_.add(zero, point); }

  // The features of an image.
  void add(const FeatureFrame& frame) noexcept LXD_NONBLOCKING {
    if (vision_) vision_->add(frame);
  }

  // How the body has turned, R_then_now, by the gyroscope; nothing when that is not known.
  [[nodiscard]] std::optional<Eigen::Matrix3d> turn(RigTime then, RigTime now) noexcept {
    return motion_.turn(filter_.state(), then, now);
  }

  // Takes one sweep of the primary LiDAR through the filter and into the map. One without returns stands for a time in
  // which that LiDAR was silent: the other sensors carry the pose on as long as they can, else it is rejected.
  // Real-time thread only; the result is valid until the next call.
  const SweepOutcome& step(const Sweep& sweep) noexcept LXD_NONBLOCKING;

  [[nodiscard]] const SweepOutcome& outcome() const { return outcome_; }  // of the last step()

  // Forgets the map and the motion: the next sweep is a first one, at the world's zero. Between sweeps.
  void restart();

  [[nodiscard]] const SurfaceMap& map() const { return map_; }
  [[nodiscard]] SurfaceMap& map() { return map_; }
  [[nodiscard]] const State& state() const { return filter_.state(); }
  [[nodiscard]] RigTime state_time() const { return last_end_; }
  [[nodiscard]] const Motion& motion() const { return motion_; }
  [[nodiscard]] const ImuDelay& imu_delay() const { return filter_.delay(); }
  [[nodiscard]] const ImuMount& imu_mount() const { return filter_.mount(); }
  // An instant's image is stamped so much later.
  [[nodiscard]] Duration camera_delay() const { return vision_ ? vision_->alignment().delay() : Duration(); }
  [[nodiscard]] const VisualUpdate* vision() const { return vision_ ? &*vision_ : nullptr; }
  [[nodiscard]] std::uint64_t extra_returns_lost() const { return extra_.lost(); }

 private:
  static constexpr std::size_t kResidualsMin = 30;  // fewer do not make an update

  enum class Phase : std::uint8_t { first_sweep, second_sweep, tracking };

  [[nodiscard]] SweepRejection admit(const Sweep& sweep) const;
  [[nodiscard]] bool carried_without(const Sweep& sweep) const;
  void take(const Sweep& sweep);
  template <typename F>
  bool for_each_return(F&& f) const {
    return primary_returns_.for_each(f) && extra_returns_.for_each(f);
  }
  void downsample();
  [[nodiscard]] int points_wanted() const;
  [[nodiscard]] bool thin();
  // The path during the sweep in hand, if it ended in this state.
  void follow(const State& end) { motion_.path(end, begin_, end_, path_); }
  void register_to_mesh(int iterations);
  void insert();
  [[nodiscard]] NormalEquations see_surfaces(int iteration, LidarMatrix& motion);
  struct Iteration {
    double kernel_sigmas = 0;
    LidarMatrix information = LidarMatrix::Zero();
    StateVector step = StateVector::Zero();
  };
  // Does this update say what the IMU is wrong by?
  [[nodiscard]] bool sees_imu() const {
    return outcome_.source == MotionSource::imu && outcome_.degenerate_directions == 0 &&
           outcome_.points_used >= kResidualsMin;
  }
  [[nodiscard]] DelaySums see_delay(const Iteration& last);
  [[nodiscard]] bool enough_features() const;
  [[nodiscard]] bool enough() const;
  void align_sensors();
  void diverge();
  void lose();
  [[nodiscard]] Pose pose_at(RigTime t);  // of the body, within the path
  [[nodiscard]] SensorsAtWork at_work();
  void hand_over(const Sweep& sweep);

  // odometry_camera.cpp
  [[nodiscard]] NormalEquations see_features(int iteration);
  void conclude_image();
  void align_camera();

  // odometry_begin.cpp
  void begin_with(const Sweep& sweep);
  void take_first_again();
  [[nodiscard]] bool bootstrap(const Sweep& sweep);

  // odometry_place.cpp
  [[nodiscard]] bool in_doubt() const;
  [[nodiscard]] bool astray() const;
  void begin_trial();
  [[nodiscard]] bool belongs();
  [[nodiscard]] double pierced(std::size_t beams) const;
  [[nodiscard]] bool may_insert() const;
  void count_lost();

  // odometry_guess.cpp
  void remember(std::span<const MapPoint> points);
  std::span<const GuessSample> guess_samples();
  double fit_of(const State& x, FitDetail detail);
  void guess_rotation();

  OdometrySetup setup_;
  SurfaceMap map_;
  Ieskf filter_;
  Motion motion_;
  SweepPath path_;

  std::optional<VisualUpdate> vision_;
  bool image_in_hand_ = false;                  // one takes part in this sweep
  Vector6d image_variance_ = Vector6d::Zero();  // of its pose against the sweep's end, Motion::path_variance()

  std::span<RegistrationPoint> registration_;
  std::span<float> registration_intensity_;
  std::span<PointResidual> residuals_;
  std::span<float> scratch_;
  std::span<MapPoint> map_points_;
  std::span<MapPoint> thinned_points_;
  std::span<RegisteredPoint> registered_;
  std::span<LidarPoint> first_sweep_;
  VoxelSet voxels_;
  RotationGuess guess_;
  std::span<GuessSample> guess_samples_;
  Pose T_image_world_;  // of the range image, of the last sweep that was mapped: the LiDAR at that sweep's end
  RigTime image_end_;
  std::uint32_t registration_count_ = 0, registered_primary_ = 0, first_count_ = 0;
  std::uint32_t lost_sweeps_ = 0;  // in a row, that did not hold the pose
  SearchRest search_rest_;
  PlaceTrial trial_;
  double usually_pierced_ = 0;               // share of beams, of the sweeps that hold the pose
  StateMatrix doubt_ = StateMatrix::Zero();  // when it began
  std::uint64_t not_finite_updates_ = 0;
  WorkBudget budget_;
  double voxel_edge_m_;
  ExtraReturns extra_;
  LidarModel lidar0_;
  LidarReturns primary_returns_, extra_returns_;  // of the sweep in hand
  RigTime begin_, end_;                           // of its path: from the first of its returns
  RigTime last_extra_ = kNever;                   // end of the last sweep with returns of the extra LiDAR
  RigTime first_begin_;                           // of the first sweep
  RigTime last_end_;                              // of the sweep before
  Phase phase_ = Phase::first_sweep;
  SweepOutcome outcome_;
};

}  // namespace lxd
