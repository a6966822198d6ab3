// SPDX-License-Identifier: Apache-2.0
#include "drivers/ros1/picture.hpp"

#include <algorithm>
#include <array>

namespace lxd {
namespace {

constexpr std::uint32_t kLongestSide = 16384;  // pixels, as camera frames

bool take_encoding(Ros1Picture& out) {
  const bool grey = out.encoding == "mono8" || out.encoding == "8UC1";
  out.blue_first = out.encoding == "bgr8";
  out.channels = grey ? 1 : 3;
  return grey || out.blue_first || out.encoding == "rgb8";
}

bool begins_with(Ros1Reader::Bytes data, std::span<const std::uint8_t> magic) {
  return data.size() >= magic.size() && std::equal(magic.begin(), magic.end(), data.begin());
}

}  // namespace

// is_bigendian has no meaning for pixels of one byte.
Ros1Fault read_ros1_picture(Ros1Reader::Bytes message, Ros1Picture& out) {
  Ros1Reader reader(message);
  out.header = read_ros1_header(reader);
  out.height = reader.number<std::uint32_t>();
  out.width = reader.number<std::uint32_t>();
  out.encoding = reader.text();
  (void)reader.number<std::uint8_t>();
  out.row_bytes = reader.number<std::uint32_t>();
  out.pixels = reader.array();
  if (const Ros1Fault fault = reader.finish(); fault != Ros1Fault::none) return fault;
  if (!take_encoding(out)) return Ros1Fault::unknown_encoding;
  if (out.width == 0 || out.height == 0) return Ros1Fault::empty;
  const bool fits = out.width <= kLongestSide && out.height <= kLongestSide &&
                    out.row_bytes >= out.width * out.channels &&
                    out.pixels.size() >= std::uint64_t{out.row_bytes} * out.height;
  return fits ? Ros1Fault::none : Ros1Fault::bad_layout;
}

Ros1Fault read_ros1_compressed_picture(Ros1Reader::Bytes message, Ros1CompressedPicture& out) {
  static constexpr std::array<std::uint8_t, 3> kJpeg{0xFF, 0xD8, 0xFF};
  static constexpr std::array<std::uint8_t, 4> kPng{0x89, 'P', 'N', 'G'};
  Ros1Reader reader(message);
  out.header = read_ros1_header(reader);
  (void)reader.text();  // "jpeg", "bgr8; jpeg compressed bgr8" and others: the data know better
  out.data = reader.array();
  if (const Ros1Fault fault = reader.finish(); fault != Ros1Fault::none) return fault;
  if (out.data.empty()) return Ros1Fault::empty;
  out.compression = begins_with(out.data, kPng) ? Ros1Compression::png : Ros1Compression::jpeg;
  const bool known = out.compression == Ros1Compression::png || begins_with(out.data, kJpeg);
  return known ? Ros1Fault::none : Ros1Fault::unknown_encoding;
}

}  // namespace lxd
