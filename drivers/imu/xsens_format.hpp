// SPDX-License-Identifier: Apache-2.0
// Xsens' MTData2 (MTi): 0xFA, bus id 0xFF, message id, length, data, checksum. A length of 255 means that two bytes
// with the length follow. All bytes behind the 0xFA sum up to 0 in their low byte. Data are {u16 id, u8 size, value},
// big endian. Source: ethzasl_xsens_driver, mtdevice.py, mtdef.py.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace lxd {

inline constexpr std::uint8_t kXsensSync = 0xFA, kXsensBus = 0xFF, kXsensData = 0x36;
inline constexpr std::uint8_t kXsensExtendedLength = 0xFF;
inline constexpr std::size_t kXsensMessageAt = 2, kXsensLengthAt = 3, kXsensHeaderBytes = 4;
inline constexpr std::size_t kXsensMaxDataBytes = 1024;  // more is taken for a damaged length
inline constexpr std::size_t kXsensMaxFrameBytes = kXsensHeaderBytes + 2 + kXsensMaxDataBytes + 1;
inline constexpr std::size_t kXsensItemHeaderBytes = 3;

namespace xsens {
// Ids without the low four bits, which say coordinate frame (of orientations) and number format.
inline constexpr unsigned kIdMask = 0xFFF0, kFormatMask = 0x3;
inline constexpr unsigned kPacketCounter = 0x1020, kSampleTime = 0x1060;  // u16; u32 of 100 us
inline constexpr unsigned kAccel = 0x4020, kAccelHighRate = 0x4040;       // m/s^2
inline constexpr unsigned kRate = 0x8020, kRateHighRate = 0x8040;         // rad/s
inline constexpr std::int64_t kSampleTick_ns = 100'000;
// Formats 1 and 2 are fixed-point numbers of 4 and 6 bytes, which no source here describes to the bit.
inline constexpr unsigned kFloat = 0, kDouble = 3;
}  // namespace xsens

struct XsensHeader {
  std::size_t data_at = 0, data_bytes = 0;
  [[nodiscard]] std::size_t frame_bytes() const { return data_at + data_bytes + 1; }
};

// Of bytes that begin with 0xFA; none: they do not reach to the length's end.
constexpr std::optional<XsensHeader> read_xsens_header(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kXsensHeaderBytes) return std::nullopt;
  if (bytes[kXsensLengthAt] != kXsensExtendedLength) return XsensHeader{kXsensHeaderBytes, bytes[kXsensLengthAt]};
  if (bytes.size() < kXsensHeaderBytes + 2) return std::nullopt;
  const unsigned length = static_cast<unsigned>(bytes[kXsensHeaderBytes] << 8U | bytes[kXsensHeaderBytes + 1]);
  return XsensHeader{kXsensHeaderBytes + 2, length};
}

// Of a frame without its 0xFA; with its checksum 0.
constexpr std::uint8_t xsens_sum(std::span<const std::uint8_t> bytes) {
  unsigned sum = 0;
  for (const std::uint8_t byte : bytes) sum += byte;
  return static_cast<std::uint8_t>(sum);
}

}  // namespace lxd
