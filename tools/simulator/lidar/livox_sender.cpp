// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/lidar/livox_sender.hpp"

#include <algorithm>

#include "tools/simulator/lidar/imu_scale.hpp"

namespace lxd::sim {
namespace {

constexpr double kImuRate_hz = 200;
constexpr std::uint64_t kPointType = 1, kCentimetreType = 2;

const LivoxRecord& record_of(bool other_profile) {
  return *find_livox_record(other_profile ? kCentimetreType : kPointType);
}

// Of the sensor's IMU, a consumer part (ICM-40609 class).
ImuConfig imu_config(const LivoxConfig& config) {
  ImuConfig imu;
  imu.T_body_sensor = config.T_body_sensor * livox_T_sensor_imu();
  imu.clock = config.clock;
  imu.update_rate = kImuRate_hz;
  return scaled_errors(imu, config.imu_error_scale);
}

}  // namespace

Pose livox_T_sensor_imu() {
  Pose T;
  T.p = Eigen::Vector3d(0.0110, 0.02329, -0.04412);  // Livox' user manual
  return T;
}

LivoxSender::LivoxSender(const Context& context, const LivoxConfig& config, const LidarClock& clock,
                         const LidarFaults& faults)
    : context_(context), config_(config), clock_(clock), faults_(faults) {
  const auto found = std::find(kLivoxClockSources.begin(), kLivoxClockSources.end(), config.clock_source);
  clock_type_ = static_cast<LivoxClock>(found - kLivoxClockSources.begin());
}

std::vector<LidarDatagram> LivoxSender::send(const LivoxFrame& frame, LidarLog& log) const {
  Random jitter(context_.seed, config_.sensor + "/stamps", frame.number);
  std::vector<LidarDatagram> datagrams;
  const std::uint64_t packets = frame.shots.size() / kLivoxPacketPoints;
  for (std::uint64_t i = 0; i < packets; ++i) {
    const double t_s = livox_shot_s(frame.first_packet + i, 0), sent_s = livox_shot_s(frame.first_packet + i + 1, 0);
    const auto first_frame = static_cast<std::uint64_t>(faults_.boot(t_s).up_s * kNanosPerSecond) / kLivoxFrame_ns;
    const LivoxHeader header{.timestamp_ns = static_cast<std::uint64_t>(clock_.stamped_ns(t_s, jitter)),
                             .duration_ns = kLivoxPacket_ns,
                             .packet_counter = static_cast<std::uint16_t>(i),
                             .frame_counter = static_cast<std::uint8_t>(frame.number - first_frame),
                             .clock = clock_type_};
    const bool centimetres = faults_.on(LidarFault::kProfile, t_s), empty = frame.fault == ShotFault::kEmpty;
    const auto shots = std::span(frame.shots).subspan(i * kLivoxPacketPoints, empty ? 0 : kLivoxPacketPoints);
    datagrams.push_back({t_s, sent_s, false, encode_livox_points(record_of(centimetres), header, shots)});
    if (faults_.silent(t_s, sent_s)) continue;
    if (centimetres) ++log.other_profile;
    if (empty) ++log.emptied;
  }
  return datagrams;
}

LivoxImuSender::LivoxImuSender(const Context& context, const LivoxConfig& config, LivoxClock clock_type,
                               const LidarClock& clock)
    : enabled_(config.imu),
      clock_type_(clock_type),
      clock_(clock),
      jitter_(context.seed, config.sensor + "/imu_stamps"),
      model_(imu_config(config), context.motion, context.seed, config.sensor + "/imu") {}

std::optional<LidarDatagram> LivoxImuSender::next(double end_s) {
  if (!enabled_) return std::nullopt;
  if (!ahead_) ahead_ = model_.next();
  const double t_s = ahead_->t_s;
  if (t_s >= end_s) return std::nullopt;
  const LivoxHeader header{.timestamp_ns = static_cast<std::uint64_t>(clock_.stamped_ns(t_s, jitter_)),
                           .duration_ns = 0,
                           .packet_counter = packets_++,
                           .frame_counter = 0,
                           .clock = clock_type_};
  LidarDatagram datagram{t_s, t_s, true,
                         encode_livox_imu(header, ahead_->measured.gyro_radps, ahead_->measured.accel_mps2)};
  ahead_ = model_.next();
  return datagram;
}

}  // namespace lxd::sim
