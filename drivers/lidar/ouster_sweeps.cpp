// SPDX-License-Identifier: Apache-2.0
#include "drivers/lidar/ouster_sweeps.hpp"

namespace lxd {

OusterSweeps::OusterSweeps(const OusterMetadata& metadata, std::unique_ptr<SweepClock> clock)
    : point_bytes_(metadata.format.packet_bytes()),
      legacy_imu_(kOusterLegacyImu, std::nullopt),
      imu_(kOusterAccelGyroNmea, metadata.init_id),
      parser_(metadata.format, metadata.columns_per_frame, metadata.init_id, metadata.serial),
      assembler_(metadata.format, metadata.columns_per_frame),
      builder_(metadata),
      clock_(std::move(clock)) {}

bool OusterSweeps::take(RigTime received, Sweep& sweep) {
  if (packet_.count > 0) clock_->observe(static_cast<std::int64_t>(packet_.columns().back().timestamp_ns), received);
  const OusterFrame* const frame = assembler_.add(packet_);
  return frame != nullptr && build(*frame, sweep);
}

bool OusterSweeps::flush(Sweep& sweep) {
  const OusterFrame* const frame = assembler_.flush();
  return frame != nullptr && build(*frame, sweep);
}

// By the size that no packet of points has, or by the type that the header says.
OusterImuParser* OusterSweeps::inertial_parser(std::span<const std::uint8_t> datagram) {
  if (datagram.size() == point_bytes_) return nullptr;
  if (datagram.size() == kOusterLegacyImu.record.bytes) return &legacy_imu_;
  const std::size_t least = kOusterAccelGyroNmea.header_bytes + kOusterAccelGyroNmea.footer_bytes;
  const bool typed =
      datagram.size() > least && kOusterAccelGyroNmea.packet_type.get(datagram.data()) == kOusterImuPacket;
  return typed ? &imu_ : nullptr;
}

std::span<const ImuSample> OusterSweeps::inertial(std::span<const std::uint8_t> datagram, RigTime received) {
  OusterImuParser* const parser = inertial_parser(datagram);
  if (parser == nullptr || !parser->parse(datagram, imu_packet_)) return {};
  std::size_t count = 0;
  for (const OusterImuSample& read : imu_packet_.samples()) {
    const auto sensor_ns = static_cast<std::int64_t>(read.gyro_ns);
    const auto t = clock_->rig_time(RigTime::from_ns(sensor_ns));
    if (t) samples_[count++] = {sensor_ns, received, *t, read.gyro_radps, read.accel_mps2};
  }
  return std::span(samples_).first(count);
}

bool OusterSweeps::build(const OusterFrame& frame, Sweep& sweep) {
  if (!builder_.build(frame, sweep)) {
    count_rejected(rejected_, "empty_sweep");
    return false;
  }
  if (!clock_->place(sweep, rejected_)) return false;
  sweep.lidar = 0;
  sweep.sequence = sequence_++;
  return true;
}

void OusterSweeps::report_inertial(Rejections& rejected) const {
  const OusterImuCounts &legacy = legacy_imu_.counts(), &imu = imu_.counts();
  set_rejected(rejected, {{"bad_size", legacy.bad_size + imu.bad_size},
                          {"bad_packet_type", imu.bad_packet_type},
                          {"bad_init_id", imu.bad_init_id},
                          {"bad_crc", imu.bad_crc},
                          {"invalid_record", imu.invalid_record},
                          {"not_finite", legacy.non_finite_record + imu.non_finite_record}});
}

// The parts count for themselves, in numbers that only grow; here they get their names.
void OusterSweeps::report(Rejections& rejected) const {
  for (const auto& [cause, times] : rejected_) rejected[cause] = times;
  const OusterParserCounts& parser = parser_.counts();
  const OusterSweepCounts& sweep = builder_.counts();
  set_rejected(rejected, {{"bad_size", parser.bad_size},
                          {"bad_packet_type", parser.bad_packet_type},
                          {"bad_init_id", parser.bad_init_id},
                          {"sensor_restart", parser.restarts},
                          {"bad_serial", parser.bad_serial},
                          {"bad_crc", parser.bad_crc},
                          {"invalid_column", parser.invalid_column},
                          {"bad_measurement_id", parser.bad_measurement_id},
                          {"bad_column_frame_id", parser.bad_column_frame_id},
                          {"stale_packet", assembler_.stale_packets()},
                          {"missing_frame", assembler_.missing_frames()},
                          {"missing_packet", assembler_.missing_packets()},
                          {"repeated_column", assembler_.repeated_columns()},
                          {"no_return", sweep.no_return},
                          {"above_capacity", sweep.above_capacity},
                          {"bad_column_time", sweep.bad_column_time}});
}

}  // namespace lxd
