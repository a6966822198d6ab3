// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/lidar/ouster_sender.hpp"

#include "tools/simulator/lidar/imu_scale.hpp"
#include "tools/simulator/lidar/ouster_encoder.hpp"
#include "tools/simulator/lidar/ouster_metadata.hpp"

namespace lxd::sim {
namespace {

constexpr std::uint32_t kFrameIdMask = 0xFFFF;
constexpr double kLegacyImuRate_hz = 100;

// Of the sensor's IMU, a consumer part: its data sheet's noise, and the bias and scale that calibration leaves.
ImuConfig imu_config(const OusterConfig& config) {
  ImuConfig imu;
  imu.T_body_sensor = config.T_body_sensor * ouster_T_sensor_imu(config);
  imu.clock = config.clock;
  const double packets_hz = kOusterImuPacketsPerTurn * config.rate_hz;
  imu.update_rate = config.imu == "ACCEL32_GYRO32_NMEA" ? kOusterImuRecords * packets_hz : kLegacyImuRate_hz;
  imu.gyroscope_noise_density = 2.6e-4;
  imu.accelerometer_noise_density = 2.3e-3;
  return scaled_errors(imu, config.imu_error_scale);
}

const OusterProfile* other_profile(const std::string& name) {
  return find_ouster_profile(name == "LEGACY" ? "RNG19_RFL8_SIG16_NIR16" : "LEGACY");
}

const OusterImuProfile* imu_profile(const std::string& name) {
  if (name == "NONE") return nullptr;
  return name == "LEGACY" ? &kOusterLegacyImu : &kOusterAccelGyroNmea;
}

}  // namespace

OusterSender::OusterSender(const Context& context, const OusterConfig& config, const OusterMetadata& metadata,
                           const OusterScanner& scanner, const LidarClock& clock, const LidarFaults& faults)
    : context_(context),
      config_(config),
      format_(metadata.format),
      other_format_(metadata.format),
      columns_(metadata.columns_per_frame),
      scanner_(scanner),
      clock_(clock),
      faults_(faults),
      serial_(ouster_unit(config, context.seed).serial),
      other_serial_(ouster_unit(config, context.seed, 1).serial) {
  other_format_.profile = other_profile(config.profile);
}

OusterIdentity OusterSender::identity(std::uint64_t number, double t_s) const {
  const LidarBoot boot = faults_.boot(t_s);
  const auto first_turn = static_cast<std::uint64_t>(boot.up_s * config_.rate_hz);
  return {.frame_id = static_cast<std::uint32_t>(number - first_turn) & kFrameIdMask,
          .init_id = ouster_init_id(config_, context_.seed, boot.number),
          .serial = faults_.on(LidarFault::kSerial, t_s) ? other_serial_ : serial_};
}

std::vector<LidarDatagram> OusterSender::send(const OusterTurn& turn, LidarLog& log) const {
  Random jitter(context_.seed, config_.sensor + "/stamps", turn.number);
  std::vector<LidarDatagram> datagrams;
  std::vector<std::int64_t> stamps_ns(format_.columns_per_packet);
  for (std::size_t first = 0; first < columns_; first += format_.columns_per_packet) {
    for (std::size_t c = 0; c < stamps_ns.size(); ++c) {
      stamps_ns[c] = clock_.stamped_ns(scanner_.column_s(turn.number, first + c), jitter);
    }
    const double t_s = scanner_.column_s(turn.number, first);
    const OusterIdentity id = identity(turn.number, t_s);
    const OusterPacketHeader header{id.frame_id, id.init_id, id.serial, static_cast<std::uint16_t>(first)};
    const auto& format = faults_.on(LidarFault::kProfile, t_s) ? other_format_ : format_;
    const double sent_s = scanner_.column_s(turn.number, first + format_.columns_per_packet);
    datagrams.push_back({t_s, sent_s, false, encode_ouster_packet(format, header, stamps_ns, turn, scanner_)});
    if (!faults_.silent(t_s, sent_s)) count_faults(t_s, turn, log);
  }
  return datagrams;
}

void OusterSender::count_faults(double t_s, const OusterTurn& turn, LidarLog& log) const {
  const OusterPacketFormat& format = faults_.on(LidarFault::kProfile, t_s) ? other_format_ : format_;
  const bool has_header = format.framing().packet_header_bytes > 0;
  if (format.profile != format_.profile) ++log.other_profile;
  if (has_header && faults_.on(LidarFault::kSerial, t_s)) ++log.other_serial;
  if (has_header && faults_.boot(t_s).number > 0) ++log.other_init_id;
  if (turn.fault == ShotFault::kEmpty) ++log.emptied;
}

OusterImuSender::OusterImuSender(const Context& context, const OusterConfig& config, const OusterSender& sender,
                                 const LidarClock& clock)
    : config_(config),
      profile_(imu_profile(config.imu)),
      sender_(sender),
      clock_(clock),
      jitter_(context.seed, config.sensor + "/imu_stamps"),
      model_(imu_config(config), context.motion, context.seed, config.sensor + "/imu") {
  if (profile_ != nullptr && profile_->fixed_records == 0) records_ = kOusterImuRecords;
  rest_s_ = static_cast<double>(records_ - 1) * sample_period_s(imu_config(config));
}

std::optional<LidarDatagram> OusterImuSender::next(double end_s) {
  if (profile_ == nullptr) return std::nullopt;
  if (!ahead_) ahead_ = model_.next();
  if (ahead_->t_s + rest_s_ >= end_s) return std::nullopt;
  return make();
}

LidarDatagram OusterImuSender::make() {
  std::vector<OusterImuSample> samples;
  const double begin_s = ahead_->t_s;
  double t_s = begin_s;
  while (samples.size() < records_) {
    t_s = ahead_->t_s;
    const auto stamp_ns = static_cast<std::uint64_t>(clock_.stamped_ns(t_s, jitter_));
    samples.push_back({stamp_ns, stamp_ns, ahead_->measured.accel_mps2, ahead_->measured.gyro_radps});
    ahead_ = model_.next();
  }
  const OusterIdentity id = sender_.identity(static_cast<std::uint64_t>(t_s * config_.rate_hz), t_s);
  const auto step = static_cast<std::uint16_t>(config_.columns / (kOusterImuPacketsPerTurn * kOusterImuRecords));
  const std::uint64_t first_record = packets_++ % kOusterImuPacketsPerTurn * records_;
  const auto first_column = static_cast<std::uint16_t>((first_record + 1) * step - 1);
  const auto system_ns = static_cast<std::uint64_t>(clock_.stamp_ns(t_s));
  return {begin_s, t_s, true,
          encode_ouster_imu(*profile_, {id.frame_id, id.init_id, id.serial, system_ns, first_column, step}, samples)};
}

}  // namespace lxd::sim
