// SPDX-License-Identifier: Apache-2.0
#include "drivers/replay/imu_log.hpp"

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

}  // namespace

Result<ImuLog> ImuLog::open(const std::filesystem::path& path, ImuProtocol protocol, double baud_rate) {
  Result<SerialLog> log = SerialLog::open(path);
  if (!log) return log.error();
  return ImuLog(std::move(*log), protocol, baud_rate);
}

ImuLog::ImuLog(SerialLog log, ImuProtocol protocol, double baud_rate)
    : log_(std::move(log)), parser_(parser_of(protocol, baud_rate)) {}

ImuLog::Parser ImuLog::parser_of(ImuProtocol protocol, double baud_rate) {
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

bool ImuLog::next(ImuSample& sample) {
  for (;;) {
    if (std::visit([&](auto& parser) { return parser.next(sample); }, parser_)) {
      ++samples_;
      return true;
    }
    if (!feed()) return false;
  }
}

// The parser has taken all samples out of what it holds, so there is room.
bool ImuLog::feed() {
  while (chunk_.bytes.empty()) {
    if (!log_.next(chunk_, file_rejected_)) return false;
  }
  const std::size_t taken =
      std::visit([&](auto& parser) { return parser.feed(chunk_.bytes, chunk_.received); }, parser_);
  bytes_ += taken;
  chunk_.bytes = chunk_.bytes.subspan(taken);
  return true;
}

Rejections ImuLog::rejected() const {
  Rejections rejected = file_rejected_;
  std::visit([&](const auto& parser) { add(rejected, parser.counts()); }, parser_);
  return rejected;
}

}  // namespace lxd
