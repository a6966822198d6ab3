// SPDX-License-Identifier: Apache-2.0
#include "drivers/imu/mip_parser.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/imu/big_endian.hpp"
#include "drivers/imu/standard_gravity.hpp"

namespace lxd {
namespace {

using Bytes = std::span<const std::uint8_t>;

// Where the fields that are used lie in a payload; null: it does not have them.
struct Found {
  const std::uint8_t *accel = nullptr, *gyro = nullptr;
  const std::uint8_t *reference_time = nullptr, *gps_time = nullptr, *shared_gps_time = nullptr;
};

// False: the field has another length than it should.
bool note(Found& found, std::uint8_t descriptor, Bytes data) {
  const auto keep = [&](const MipField& field, const std::uint8_t*& at) {
    if (descriptor != field.descriptor) return true;
    at = data.data();
    return data.size() == field.data_bytes;
  };
  return keep(mip::kScaledAccel, found.accel) && keep(mip::kScaledGyro, found.gyro) &&
         keep(mip::kReferenceTime, found.reference_time) && keep(mip::kGpsTime, found.gps_time) &&
         keep(mip::kSharedGpsTime, found.shared_gps_time);
}

std::optional<Found> fields_of(Bytes payload) {
  Found found;
  while (!payload.empty()) {
    const std::size_t bytes = payload[0];
    if (bytes < kMipFieldHeaderBytes || bytes > payload.size()) return std::nullopt;
    if (!note(found, payload[1], payload.subspan(kMipFieldHeaderBytes, bytes - kMipFieldHeaderBytes))) {
      return std::nullopt;
    }
    payload = payload.subspan(bytes);
  }
  return found;
}

// ns since 1980-01-06; none: the device does not know the time, or says one that cannot be.
std::optional<std::int64_t> gps_time(const std::uint8_t* at, unsigned valid) {
  if (at == nullptr) return std::nullopt;
  const double of_week_s = get_big_endian_double(at);
  const std::uint64_t week = get_big_endian(at + mip::kWeekAt, 2);
  const bool said = (get_big_endian(at + mip::kFlagsAt, 2) & valid) == valid;
  const bool possible = of_week_s >= 0 && of_week_s <= static_cast<double>(mip::kWeek_s) && week <= mip::kLastWeek;
  if (!said || !possible) return std::nullopt;
  return static_cast<std::int64_t>(week * mip::kWeek_s) * kNanosPerSecond + std::llround(of_week_s * 1e9);
}

std::optional<std::int64_t> time_of(const Found& found) {
  if (found.reference_time != nullptr) return static_cast<std::int64_t>(get_big_endian(found.reference_time, 8));
  const auto shared = gps_time(found.shared_gps_time, mip::kSharedGpsTimeValid);
  return shared ? shared : gps_time(found.gps_time, mip::kGpsTimeValid);
}

}  // namespace

bool MipParser::next(ImuSample& sample) {
  while (const std::size_t bytes = find_packet()) {
    const bool is_sample = read(buffer_.view().first(bytes), sample);
    ++counts_.frames;
    counts_.bytes_accepted += bytes;
    buffer_.drop(bytes);
    if (is_sample) return true;
  }
  return false;
}

std::size_t MipParser::find_packet() {
  for (;;) {
    const Bytes all = buffer_.view();
    skip(static_cast<std::size_t>(std::ranges::find(all, kMipSync[0]) - all.begin()));
    const Bytes bytes = buffer_.view();
    if (bytes.size() > 1 && bytes[1] != kMipSync[1]) {
      skip(1);
      continue;
    }
    if (bytes.size() < kMipHeaderBytes) return 0;
    const std::size_t summed = kMipHeaderBytes + bytes[kMipLengthAt];
    if (bytes.size() < summed + kMipChecksumBytes) return 0;
    if (std::ranges::equal(mip_checksum(bytes.first(summed)), bytes.subspan(summed, kMipChecksumBytes))) {
      return summed + kMipChecksumBytes;
    }
    ++counts_.bad_checksum;
    skip(1);
  }
}

void MipParser::skip(std::size_t bytes) {
  counts_.bytes_skipped += bytes;
  buffer_.drop(bytes);
}

bool MipParser::read(Bytes packet, ImuSample& sample) {
  if (packet[kMipSetAt] != kMipImuSet) {
    ++counts_.no_imu_fields;
    return false;
  }
  const auto found = fields_of(packet.subspan(kMipHeaderBytes, packet[kMipLengthAt]));
  if (!found) {
    ++counts_.bad_field;
    return false;
  }
  if (found->accel == nullptr || found->gyro == nullptr) {
    ++counts_.no_imu_fields;
    return false;
  }
  sample = {time_of(*found), buffer_.received(), buffer_.sent(0), get_big_endian_floats(found->gyro),
            get_big_endian_floats(found->accel) * kStandardGravity_mps2};
  if (sample.gyro_radps.allFinite() && sample.accel_mps2.allFinite()) return true;
  ++counts_.non_finite;
  return false;
}

}  // namespace lxd
