// SPDX-License-Identifier: Apache-2.0
#include "drivers/imu/xsens_parser.hpp"

#include <algorithm>

#include "drivers/imu/big_endian.hpp"

namespace lxd {
namespace {

using Bytes = std::span<const std::uint8_t>;

struct Samples {
  std::optional<std::uint32_t> ticks;
  std::optional<Eigen::Vector3d> accel, accel_high_rate, rate, rate_high_rate;
};

// None: not in a format that is known here, or of another size than the format's.
std::optional<Eigen::Vector3d> vector_of(unsigned format, Bytes value) {
  if (format == xsens::kFloat && value.size() == 3 * sizeof(float)) return get_big_endian_floats(value.data());
  if (format != xsens::kDouble || value.size() != 3 * sizeof(double)) return std::nullopt;
  const std::uint8_t* const at = value.data();
  return Eigen::Vector3d(get_big_endian_double(at), get_big_endian_double(at + sizeof(double)),
                         get_big_endian_double(at + 2 * sizeof(double)));
}

// False: the item is one of ours and not in the form that it should have.
bool note(Samples& found, unsigned id, Bytes value) {
  const auto keep = [&](std::optional<Eigen::Vector3d>& into) {
    into = vector_of(id & xsens::kFormatMask, value);
    return into.has_value();
  };
  switch (id & xsens::kIdMask) {
    case xsens::kSampleTime:
      if (value.size() != sizeof(std::uint32_t)) return false;
      found.ticks = static_cast<std::uint32_t>(get_big_endian(value.data(), sizeof(std::uint32_t)));
      return true;
    case xsens::kAccel:
      return keep(found.accel);
    case xsens::kAccelHighRate:
      return keep(found.accel_high_rate);
    case xsens::kRate:
      return keep(found.rate);
    case xsens::kRateHighRate:
      return keep(found.rate_high_rate);
    default:
      return true;
  }
}

std::optional<Samples> items_of(Bytes data) {
  Samples found;
  while (!data.empty()) {
    if (data.size() < kXsensItemHeaderBytes || data.size() < kXsensItemHeaderBytes + data[2]) return std::nullopt;
    const auto id = static_cast<unsigned>(get_big_endian(data.data(), 2));
    const std::size_t bytes = data[2];
    if (!note(found, id, data.subspan(kXsensItemHeaderBytes, bytes))) return std::nullopt;
    data = data.subspan(kXsensItemHeaderBytes + bytes);
  }
  return found;
}

}  // namespace

bool XsensParser::next(ImuSample& sample) {
  XsensHeader header;
  for (;;) {
    const Bytes bytes = buffer_.view();
    skip(static_cast<std::size_t>(std::ranges::find(bytes, kXsensSync) - bytes.begin()));
    const Frame frame = find_frame(header);
    if (frame == Frame::kIncomplete) return false;
    if (frame == Frame::kRefused) continue;
    const bool is_sample = read(buffer_.view().first(header.frame_bytes()), header, sample);
    ++counts_.frames;
    counts_.bytes_accepted += header.frame_bytes();
    buffer_.drop(header.frame_bytes());
    if (is_sample) return true;
  }
}

XsensParser::Frame XsensParser::find_frame(XsensHeader& header) {
  const Bytes bytes = buffer_.view();
  if (bytes.size() > 1 && bytes[1] != kXsensBus) return refuse(counts_.bad_bus);
  const auto read = read_xsens_header(bytes);
  if (!read) return Frame::kIncomplete;
  header = *read;
  if (header.data_bytes > kXsensMaxDataBytes) return refuse(counts_.too_long);
  if (bytes.size() < header.frame_bytes()) return Frame::kIncomplete;
  if (xsens_sum(bytes.subspan(1, header.frame_bytes() - 1)) != 0) return refuse(counts_.bad_checksum);
  return Frame::kSound;
}

XsensParser::Frame XsensParser::refuse(std::uint64_t& cause) {
  ++cause;
  skip(1);
  return Frame::kRefused;
}

void XsensParser::skip(std::size_t bytes) {
  counts_.bytes_skipped += bytes;
  buffer_.drop(bytes);
}

// What the device sends at its own high rate is used when there is nothing else.
bool XsensParser::read(Bytes frame, const XsensHeader& header, ImuSample& sample) {
  if (frame[kXsensMessageAt] != kXsensData) {
    ++counts_.no_imu_fields;
    return false;
  }
  const auto found = items_of(frame.subspan(header.data_at, header.data_bytes));
  if (!found) {
    ++counts_.bad_field;
    return false;
  }
  const auto& accel = found->accel ? found->accel : found->accel_high_rate;
  const auto& rate = found->rate ? found->rate : found->rate_high_rate;
  if (!accel || !rate) {
    ++counts_.no_imu_fields;
    return false;
  }
  if (!accel->allFinite() || !rate->allFinite()) {
    ++counts_.non_finite;
    return false;
  }
  sample = {std::nullopt, buffer_.received(), buffer_.sent(0), *rate, *accel};
  if (found->ticks) sample.sensor_ns = unwrapped_ns(*found->ticks);
  return true;
}

std::int64_t XsensParser::unwrapped_ns(std::uint32_t ticks) {
  const auto since = ticks_ ? static_cast<std::int32_t>(ticks - static_cast<std::uint32_t>(*ticks_)) : 0;
  ticks_ = ticks_ ? *ticks_ + since : std::int64_t{ticks};
  return *ticks_ * xsens::kSampleTick_ns;
}

}  // namespace lxd
