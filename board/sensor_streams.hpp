// SPDX-License-Identifier: Apache-2.0
// The sensors of a recording beside its LiDAR, handed to the odometry in the order of time: before each sweep, all that
// was measured up to its end. Runs in the thread that reads, not in the real-time path.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "board/camera_stream.hpp"
#include "board/found_mount.hpp"
#include "board/imu_hints.hpp"
#include "board/mutes.hpp"
#include "board/rig.hpp"
#include "board/sensor_set.hpp"
#include "board/star.hpp"
#include "drivers/replay/gnss_source.hpp"
#include "drivers/replay/imu_source.hpp"
#include "drivers/replay/source.hpp"
#include "drivers/replay/wheel_source.hpp"
#include "estimator/odometry.hpp"

namespace lxd {

class SensorStreams {
 public:
  // Of the sensors in use. Error: one of them has no recording, or it cannot be read.
  static Result<SensorStreams> open(const std::filesystem::path& recording, const Rig& rig, const SensorSet& sensors,
                                    const Star& star);

  // Of a live rig: sources that give what has come so far, and never end. None: not in use.
  class FeatureSource {
   public:
    virtual ~FeatureSource() = default;
    virtual std::optional<FeatureFrame> next() = 0;
  };
  struct LiveSources {
    std::unique_ptr<FeatureSource> features;
    std::unique_ptr<ImuSource> imu;
    std::unique_ptr<WheelLogSource> wheel;
    std::unique_ptr<SweepSource> extra;
  };
  static SensorStreams of_live(LiveSources sources);

  // All that was measured up to `until`, and one sample more of the IMU, that the one at `until` lies between two.
  // `shift` is added to the stamps.
  void feed(Odometry& odometry, RigTime until, Duration shift);

  // Do the IMU or the wheels go on until `t`? Hands over what they read until then.
  [[nodiscard]] bool outlast(Odometry& odometry, RigTime t, Duration shift);

  // Fixes of GNSS that were received up to `until`, which the back-end takes.
  void feed_fixes(RigTime until, Duration shift, const std::function<void(const GnssFix&)>& take);

  // After a sweep, taken or rejected.
  void note(const Sweep& sweep, const Odometry& odometry, const Star& star) {
    if (uses_imu_) imu_hints_.note(sweep.begin, sweep.end, odometry, star);
    const WheelAlignment& wheel = odometry.motion().wheel_alignment();
    wheel_hint_.note(wheel.delay_s(), wheel.delay_sigma_s());
    if (odometry.vision() == nullptr) return;
    const CameraAlignment& camera = odometry.vision()->alignment();
    camera_hint_.note(camera.delay_s(), camera.delay_sigma_s());
    mount_hint_.note(found_mount(camera, star));
  }
  // What the user should look at.
  [[nodiscard]] std::vector<std::string> hints() const;

  // Who else sees a recording's images.
  void listen(CameraStream::Listener listener) {
    if (camera_) camera_->listen(std::move(listener));
  }

  // Those that shall not be heard for a while; before the first feed().
  void mute(const Mutes& mutes) { mutes_ = mutes; }
  [[nodiscard]] Mutes& mutes() { return mutes_; }

  // What was read and did not reach the pose, by sensor and cause, beside what read_recorded_sensors() tells.
  [[nodiscard]] std::map<std::string, Rejections> rejected(const Odometry& odometry) const;

 private:
  // A source has nothing more: of a recording it is let go.
  template <typename Source>
  void pause(std::unique_ptr<Source>& source) {
    if (!live_) source.reset();
  }
  void feed_extra(Odometry& odometry, RigTime until, Duration shift);
  [[nodiscard]] bool read_extra();
  void feed_imu(Odometry& odometry, RigTime until, Duration shift);
  void feed_wheel(Odometry& odometry, RigTime until, Duration shift);
  void feed_features(Odometry& odometry, RigTime until);

  std::unique_ptr<ImuSource> imu_;         // none: not in use, or ended
  RigTime imu_until_ = kNever;             // of what was read of it
  std::unique_ptr<WheelLogSource> wheel_;  // likewise
  std::optional<WheelSample> next_wheel_;
  std::unique_ptr<GnssSource> gnss_;  // likewise
  std::optional<GnssFix> next_fix_;
  std::optional<CameraStream> camera_;
  std::unique_ptr<FeatureSource> features_;
  std::optional<FeatureFrame> next_features_;
  std::unique_ptr<SweepSource> extra_;  // likewise
  std::vector<LidarPoint> extra_storage_;
  Mutes mutes_;
  ImuHints imu_hints_;
  DelayHint wheel_hint_, camera_hint_;
  MountHint mount_hint_{
      "camera0",
      "its images turn otherwise than the rig does (is camera0.T_reference_sensor the inverse of what "
      "is meant, or are its axes other than x to the right, y down, z ahead?)"};
  bool uses_imu_ = false;
  Sweep extra_sweep_;  // read, and not yet handed over whole
  bool live_ = false;
};

// Every sensor that the rig has and the recording holds: what a replay uses unless it is told.
SensorSet recorded_sensors(const std::filesystem::path& recording, const Rig& rig);

// What the odometry is told of the IMU and of the wheels that are in use.
std::optional<ImuNoise> imu_noise_of(const Rig& rig, const SensorSet& sensors);
std::optional<LidarModel> extra_lidar_of(const Rig& rig, const Star& star, const EstimatorConfig& estimator);
std::optional<WheelModel> wheel_model_of(const Rig& rig, const Star& star);

}  // namespace lxd
