// SPDX-License-Identifier: Apache-2.0
#include "board/sensor_streams.hpp"

#include <algorithm>
#include <numbers>

#include "board/default/capacities.hpp"
#include "board/wheel_table.hpp"
#include "drivers/replay/camera_source.hpp"
#include "drivers/replay/lidar_imu.hpp"
#include "drivers/replay/open.hpp"
#include "drivers/replay/ouster_pcap.hpp"

namespace lxd {

Result<SensorStreams> SensorStreams::open(const std::filesystem::path& recording, const Rig& rig,
                                          const SensorSet& sensors, const Star& star) {
  SensorStreams streams;
  const PulsedSensors pulsed = pulsed_sensors(rig);
  if (sensors.imu) {
    const auto protocol = find_imu_protocol(rig.imu->protocol).value_or(ImuProtocol::kVectorNav);
    auto imu = rig.imu->of_lidar() ? open_lidar_imu(recording, pulsed.lidar0)
                                   : open_imu_source(recording, protocol, rig.imu->baud_rate, pulsed.imu);
    if (!imu) return imu.error();
    streams.imu_ = std::move(*imu);
    streams.uses_imu_ = true;
  }
  if (sensors.wheel) {
    auto wheel = open_wheel_source(recording, wheel_messages(*rig.wheel), wheel_decoder_config(*rig.wheel, {}));
    if (!wheel) return wheel.error();
    streams.wheel_ = std::move(*wheel);
  }
  if (sensors.gnss) {
    auto gnss = GnssSource::open(recording / kGnssFile);
    if (!gnss) return gnss.error();
    streams.gnss_ = std::make_unique<GnssSource>(std::move(*gnss));
  }
  if (const auto camera = camera_of(rig, star)) {
    auto images = CameraStream::open(recording, rig, *camera);
    if (!images) return images.error();
    streams.camera_.emplace(std::move(*images));
  }
  if (sensors.extra_lidar) {
    auto extra = open_extra_lidar(recording, pulsed.lidar1);
    if (!extra) return extra.error();
    streams.extra_ = std::move(*extra);
    streams.extra_storage_.resize(capacities::kSweepPointsMax);
  }
  return streams;
}

SensorStreams SensorStreams::of_live(LiveSources sources) {
  SensorStreams streams;
  streams.live_ = true;
  streams.uses_imu_ = sources.imu != nullptr;
  streams.imu_ = std::move(sources.imu);
  streams.wheel_ = std::move(sources.wheel);
  streams.features_ = std::move(sources.features);
  streams.extra_ = std::move(sources.extra);
  if (streams.extra_) streams.extra_storage_.resize(capacities::kSweepPointsMax);
  return streams;
}

void SensorStreams::feed(Odometry& odometry, RigTime until, Duration shift) {
  feed_imu(odometry, until, shift);
  feed_wheel(odometry, until, shift);
  feed_extra(odometry, until, shift);
  const RigTime images_until = until + odometry.camera_delay();
  if (camera_) camera_->feed(odometry, mutes_, images_until, shift);
  feed_features(odometry, images_until);
}

// What a live camera's own thread has found.
void SensorStreams::feed_features(Odometry& odometry, RigTime until) {
  while (features_) {
    if (!next_features_) next_features_ = features_->next();
    if (!next_features_ || next_features_->stamp > until) return;
    odometry.add(*next_features_);
    next_features_.reset();
  }
}

bool SensorStreams::outlast(Odometry& odometry, RigTime t, Duration shift) {
  feed_imu(odometry, t, shift);
  feed_wheel(odometry, t, shift);
  return imu_until_ >= t || next_wheel_;
}

SensorSet recorded_sensors(const std::filesystem::path& recording, const Rig& rig) {
  const auto holds = [&](std::initializer_list<const char*> names) {
    std::error_code ignored;
    return std::any_of(names.begin(), names.end(),
                       [&](const char* name) { return std::filesystem::exists(recording / name, ignored); });
  };
  const auto holds_packets = [&] { return holds({"lidar0.pcap"}) || looks_like_pcap(recording); };
  SensorSet sensors;
  sensors.extra_lidar = rig.lidar1 && holds({"lidar1.pcap", "lidar1"});
  sensors.camera = rig.camera0 && open_camera(recording).ok();
  sensors.imu = rig.imu && (rig.imu->of_lidar() ? holds_packets() : holds({kImuSerialFile, kImuTextFile}));
  sensors.wheel = rig.wheel && holds({kCanLogFile, kWheelTextFile});
  sensors.gnss = rig.gnss && holds({kGnssFile});
  return sensors;
}

std::map<std::string, Rejections> SensorStreams::rejected(const Odometry& odometry) const {
  Rejections camera = camera_ ? camera_->rejected() : Rejections(), lidar1, wheel, imu;
  if (const VisualUpdate* const vision = odometry.vision()) {
    count_rejected(camera, "late_image", vision->counts().late);
    count_rejected(camera, "crowded_image", vision->counts().crowded);
  }
  count_rejected(lidar1, "lost_return", odometry.extra_returns_lost());
  count_rejected(wheel, "slip", odometry.motion().slipping());
  const InertialCounts& inertial = odometry.motion().inertial_counts();
  count_rejected(imu, "not_finite", inertial.not_finite);
  count_rejected(imu, "time_backwards", inertial.late);
  count_rejected(imu, "stuck", inertial.stuck);
  return {{"camera0", camera}, {"lidar1", lidar1}, {"wheel", wheel}, {"imu", imu}};
}

std::vector<std::string> SensorStreams::hints() const {
  std::vector<std::string> hints = uses_imu_ ? imu_hints_.sentences() : std::vector<std::string>();
  for (std::string sentence :
       {wheel_hint_.sentence("wheel", "readings"), camera_hint_.sentence("camera0", "images"), mount_hint_.sentence()})
    if (!sentence.empty()) hints.push_back(std::move(sentence));
  return hints;
}

// The next sweep that has a point. A recording that cannot be read further ends.
bool SensorStreams::read_extra() {
  extra_sweep_ = {};
  extra_sweep_.storage = extra_storage_;
  const auto more = extra_->next(extra_sweep_);
  return more && *more;
}

// Returns are handed over when they were fired, as a driver does that hands over each packet; what was fired later
// stays.
void SensorStreams::feed_extra(Odometry& odometry, RigTime until, Duration shift) {
  while (extra_) {
    if (extra_sweep_.count == 0 && !read_extra()) return pause(extra_);
    const RigTime zero = extra_sweep_.begin + shift;
    std::uint32_t kept = 0;
    for (const LidarPoint& point : extra_sweep_.points()) {
      const RigTime fired = zero + Duration::from_ns(point.offset_ns);
      if (fired > until)
        extra_sweep_.storage[kept++] = point;
      else if (!mutes_.silent("lidar1", fired))
        odometry.add_extra(zero, point);
    }
    extra_sweep_.count = kept;
    if (kept > 0) return;
  }
}

void SensorStreams::feed_imu(Odometry& odometry, RigTime until, Duration shift) {
  ImuSample sample;
  until = until + odometry.motion().imu_delay();
  while (imu_ && imu_until_ < until) {
    if (!imu_->next(sample)) return pause(imu_);
    const RigTime t = sample.t + shift;
    imu_until_ = std::max(imu_until_, t);
    if (mutes_.silent("imu", t)) continue;
    imu_hints_.note(t, sample);
    odometry.add(InertialReading{t, sample.gyro_radps, sample.accel_mps2});
  }
}

// A mean over a span is the value at its middle.
void SensorStreams::feed_wheel(Odometry& odometry, RigTime until, Duration shift) {
  until = until + odometry.motion().wheel_delay();
  while (wheel_) {
    WheelSample sample;
    if (!next_wheel_ && wheel_->next(sample)) next_wheel_ = sample;
    if (!next_wheel_) return pause(wheel_);
    const RigTime t = next_wheel_->received - next_wheel_->span / 2 + shift;
    if (t > until) return;
    if (!mutes_.silent("wheel", t)) odometry.add(WheelReading{t, next_wheel_->speed_mps, next_wheel_->yaw_rate_radps});
    next_wheel_.reset();
  }
}

void SensorStreams::feed_fixes(RigTime until, Duration shift, const std::function<void(const GnssFix&)>& take) {
  while (gnss_) {
    if (!next_fix_) next_fix_ = gnss_->next();
    if (!next_fix_) return gnss_.reset();
    const RigTime t = next_fix_->received + shift;
    if (t > until) return;
    if (!mutes_.silent("gnss", t)) take(*next_fix_);
    next_fix_.reset();
  }
}

std::optional<ImuNoise> imu_noise_of(const Rig& rig, const SensorSet& sensors) {
  if (!sensors.imu) return std::nullopt;
  const ImuRig& imu = *rig.imu;
  return ImuNoise{imu.gyroscope_noise_density,
                  imu.accelerometer_noise_density,
                  imu.gyroscope_random_walk,
                  imu.accelerometer_random_walk,
                  imu.delay_s,
                  imu.of_lidar() ? 0 : imu.delay_sigma_s,
                  imu.of_lidar() ? 0 : imu.rotation_sigma_deg * std::numbers::pi / 180};
}

// What its rig does not say is taken to be as the primary LiDAR's.
std::optional<LidarModel> extra_lidar_of(const Rig& rig, const Star& star, const EstimatorConfig& estimator) {
  if (!star.T_body_lidar1) return std::nullopt;
  LidarModel model{*star.T_body_lidar1, estimator.range_min_m, estimator.range_max_m, estimator.range_sigma_m,
                   estimator.bearing_sigma_rad};
  if (rig.lidar1->range_sigma_m) model.range_sigma_m = *rig.lidar1->range_sigma_m;
  if (!rig.lidar1->range_m) return model;
  model.range_min_m = (*rig.lidar1->range_m)[0];
  model.range_max_m = (*rig.lidar1->range_m)[1];
  return model;
}

std::optional<WheelModel> wheel_model_of(const Rig& rig, const Star& star) {
  if (!star.T_body_wheel) return std::nullopt;
  const WheelRig& wheel = *rig.wheel;
  return WheelModel{*star.T_body_wheel, wheel.speed_sigma_mps, wheel.yaw_rate_sigma_radps, wheel.delay_s,
                    wheel.delay_sigma_s};
}

}  // namespace lxd
