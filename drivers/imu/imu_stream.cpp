// SPDX-License-Identifier: Apache-2.0
#include "drivers/imu/imu_stream.hpp"

namespace lxd {
namespace {

void add(Rejections& rejected, const VectorNavCounts& counts) {
  count_rejected(rejected, "skipped_byte", counts.bytes_skipped);
  count_rejected(rejected, "bad_crc", counts.bad_crc);
  count_rejected(rejected, "too_long", counts.too_long);
  count_rejected(rejected, "unknown_field", counts.unknown_field);
  count_rejected(rejected, "no_imu_fields", counts.no_imu_fields);
  count_rejected(rejected, "non_finite", counts.non_finite);
}

void add(Rejections& rejected, const VectorNavAsciiCounts& counts) {
  count_rejected(rejected, "skipped_byte", counts.bytes_skipped);
  count_rejected(rejected, "bad_checksum", counts.bad_checksum);
  count_rejected(rejected, "too_long", counts.too_long);
  count_rejected(rejected, "broken_line", counts.broken_line);
  count_rejected(rejected, "sensor_error", counts.sensor_error);
  count_rejected(rejected, "bad_field", counts.bad_field);
  count_rejected(rejected, "no_imu_fields", counts.no_imu_fields);
}

void add(Rejections& rejected, const MipCounts& counts) {
  count_rejected(rejected, "skipped_byte", counts.bytes_skipped);
  count_rejected(rejected, "bad_checksum", counts.bad_checksum);
  count_rejected(rejected, "bad_field", counts.bad_field);
  count_rejected(rejected, "no_imu_fields", counts.no_imu_fields);
  count_rejected(rejected, "non_finite", counts.non_finite);
}

void add(Rejections& rejected, const XsensCounts& counts) {
  count_rejected(rejected, "skipped_byte", counts.bytes_skipped);
  count_rejected(rejected, "bad_checksum", counts.bad_checksum);
  count_rejected(rejected, "too_long", counts.too_long);
  count_rejected(rejected, "bad_bus", counts.bad_bus);
  count_rejected(rejected, "bad_field", counts.bad_field);
  count_rejected(rejected, "no_imu_fields", counts.no_imu_fields);
  count_rejected(rejected, "non_finite", counts.non_finite);
}

// Frames of other ids are no rejection: the module sends what its user switched on.
void add(Rejections& rejected, const WitMotionCounts& counts) {
  count_rejected(rejected, "skipped_byte", counts.bytes_skipped);
  count_rejected(rejected, "bad_checksum", counts.bad_checksum);
  count_rejected(rejected, "unknown_id", counts.unknown_id);
  count_rejected(rejected, "half_sample", counts.orphan_acceleration + counts.orphan_rate);
  count_rejected(rejected, "bad_time", counts.bad_time);
}

using AnyParser = std::variant<VectorNavParser, VectorNavAsciiParser, WitMotionParser, MipParser, XsensParser>;

AnyParser parser_of(ImuProtocol protocol, double baud_rate) {
  switch (protocol) {
    case ImuProtocol::kVectorNavAscii:
      return VectorNavAsciiParser(baud_rate);
    case ImuProtocol::kWitMotion:
      return WitMotionParser(baud_rate);
    case ImuProtocol::kMicroStrain:
      return MipParser(baud_rate);
    case ImuProtocol::kXsens:
      return XsensParser(baud_rate);
    case ImuProtocol::kVectorNav:
      break;
  }
  return VectorNavParser(baud_rate);
}

}  // namespace

ImuStream::ImuStream(ImuProtocol protocol, double baud_rate) : parser_(parser_of(protocol, baud_rate)) {}

Rejections ImuStream::rejected() const {
  Rejections rejected;
  std::visit([&](const auto& parser) { add(rejected, parser.counts()); }, parser_);
  return rejected;
}

bool ImuClock::place(ImuSample& sample) {
  if (!sample.sensor_ns) return true;
  while (const auto pulse = pulses_.due(sample.received)) (void)model_.add_edge(*pulse);
  if (model_.add(*sample.sensor_ns, sample.t) == ClockVerdict::refused) return false;
  sample.t = model_.to_rig(*sample.sensor_ns);
  return true;
}

}  // namespace lxd
