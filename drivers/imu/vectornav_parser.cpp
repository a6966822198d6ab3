// SPDX-License-Identifier: Apache-2.0
#include "drivers/imu/vectornav_parser.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <optional>

#include "drivers/imu/crc16.hpp"
#include "drivers/ouster/bit_field.hpp"

namespace lxd {
namespace {

using Bytes = std::span<const std::uint8_t>;

// Where rate and acceleration are found: a field and the bytes before the vector in it.
struct Place {
  VectorNavField field;
  std::size_t skip;
};
struct InertialFields {
  Place gyro, accel;
};
constexpr std::size_t kVectorBytes = 3 * sizeof(float);

// In order of preference: biases are the estimator's business, so uncompensated values come first.
constexpr std::array kInertialFields{
    InertialFields{{vectornav::kImu, kVectorBytes}, {vectornav::kImu, 0}},
    InertialFields{{vectornav::kImuGroupUncompGyro, 0}, {vectornav::kImuGroupUncompAccel, 0}},
    InertialFields{{vectornav::kAngularRate, 0}, {vectornav::kAccel, 0}},
    InertialFields{{vectornav::kImuGroupAngularRate, 0}, {vectornav::kImuGroupAccel, 0}}};

// The time since start never steps; the GPS' does when it is first set.
constexpr std::array kTimeFields{vectornav::kTimeStartup, vectornav::kTimeGroupStartup, vectornav::kTimeGps,
                                 vectornav::kTimeGroupGps};

Eigen::Vector3d vector_at(const std::uint8_t* at) {
  Eigen::Vector3d v;
  for (int i = 0; i < 3; ++i) {
    v[i] = std::bit_cast<float>(static_cast<std::uint32_t>(bytes_at(4 * i, 4).get(at)));
  }
  return v;
}

std::optional<std::int64_t> time_of(const VectorNavLayout& layout, Bytes frame) {
  for (const VectorNavField field : kTimeFields) {
    if (const auto at = layout.offset_of(field)) return static_cast<std::int64_t>(bytes_at(0, 8).get(&frame[*at]));
  }
  return std::nullopt;
}

const InertialFields* inertial_fields_of(const VectorNavLayout& layout) {
  const auto* const found = std::ranges::find_if(kInertialFields, [&](const InertialFields& fields) {
    return layout.has(fields.gyro.field) && layout.has(fields.accel.field);
  });
  return found == kInertialFields.end() ? nullptr : found;
}

Eigen::Vector3d vector_of(const Place& place, const VectorNavLayout& layout, Bytes frame) {
  return vector_at(&frame[*layout.offset_of(place.field) + place.skip]);
}

}  // namespace

bool VectorNavParser::next(ImuSample& sample) {
  VectorNavLayout layout;
  for (;;) {
    const Bytes bytes = buffer_.view();
    const auto sync = std::ranges::find(bytes, kVectorNavSync);
    skip(static_cast<std::size_t>(sync - bytes.begin()));
    const Frame frame = find_frame(layout);
    if (frame == Frame::kIncomplete) return false;
    if (frame == Frame::kRefused) continue;
    const bool is_sample = read(layout, sample);
    ++counts_.frames;
    counts_.bytes_accepted += layout.frame_bytes();
    buffer_.drop(layout.frame_bytes());
    if (is_sample) return true;
  }
}

VectorNavParser::Frame VectorNavParser::find_frame(VectorNavLayout& layout) {
  const Bytes bytes = buffer_.view();
  switch (read_vectornav_header(bytes, layout)) {
    case VectorNavHeader::kIncomplete:
      return Frame::kIncomplete;
    case VectorNavHeader::kUnknownField:
      return refuse(counts_.unknown_field);
    case VectorNavHeader::kTooLong:
      return refuse(counts_.too_long);
    case VectorNavHeader::kSound:
      break;
  }
  if (bytes.size() < layout.frame_bytes()) return Frame::kIncomplete;
  if (crc16(bytes.subspan(1, layout.frame_bytes() - 1)) != 0) return refuse(counts_.bad_crc);
  return Frame::kSound;
}

VectorNavParser::Frame VectorNavParser::refuse(std::uint64_t& cause) {
  ++cause;
  skip(1);
  return Frame::kRefused;
}

void VectorNavParser::skip(std::size_t bytes) {
  counts_.bytes_skipped += bytes;
  buffer_.drop(bytes);
}

bool VectorNavParser::read(const VectorNavLayout& layout, ImuSample& sample) {
  const InertialFields* const fields = inertial_fields_of(layout);
  if (fields == nullptr) {
    ++counts_.no_imu_fields;
    return false;
  }
  const Bytes frame = buffer_.view().first(layout.frame_bytes());
  sample = {time_of(layout, frame), buffer_.received(), buffer_.sent(0), vector_of(fields->gyro, layout, frame),
            vector_of(fields->accel, layout, frame)};
  if (sample.gyro_radps.allFinite() && sample.accel_mps2.allFinite()) return true;
  ++counts_.non_finite;
  return false;
}

}  // namespace lxd
