// SPDX-License-Identifier: Apache-2.0
#include "drivers/imu/vectornav_format.hpp"

#include <bit>

#include "drivers/ouster/bit_field.hpp"

namespace lxd {
namespace {

constexpr std::size_t kGroupsAt = 1;
constexpr std::size_t kFieldsAt = 2;
constexpr BitField kFieldMap = bytes_at(0, 2);

constexpr bool bit_of(unsigned bits, unsigned bit) { return (bits >> bit & 1U) != 0; }

// Of the fields of one group whose bit is set in `fields`.
std::size_t bytes_of(std::size_t group, unsigned fields) {
  std::size_t bytes = 0;
  for (unsigned bit = 0; bit < kVectorNavFieldBytes[group].size(); ++bit) {
    if (bit_of(fields, bit)) bytes += kVectorNavFieldBytes[group][bit];
  }
  return bytes;
}

}  // namespace

void VectorNavLayout::add(VectorNavField field) {
  groups = static_cast<std::uint8_t>(groups | 1U << field.group);
  fields[field.group] = static_cast<std::uint16_t>(fields[field.group] | 1U << field.bit);
}

bool VectorNavLayout::has(VectorNavField field) const { return bit_of(fields[field.group], field.bit); }

std::size_t VectorNavLayout::header_bytes() const {
  return kFieldsAt + sizeof(std::uint16_t) * static_cast<std::size_t>(std::popcount(groups));
}

std::size_t VectorNavLayout::frame_bytes() const {
  std::size_t bytes = header_bytes() + kVectorNavCrcBytes;
  for (std::size_t group = 0; group < kVectorNavGroups; ++group) bytes += bytes_of(group, fields[group]);
  return bytes;
}

std::optional<std::size_t> VectorNavLayout::offset_of(VectorNavField field) const {
  if (!has(field)) return std::nullopt;
  std::size_t offset = header_bytes();
  for (std::size_t group = 0; group < field.group; ++group) offset += bytes_of(group, fields[group]);
  const unsigned before = (1U << field.bit) - 1;
  return offset + bytes_of(field.group, fields[field.group] & before);
}

bool VectorNavLayout::every_length_known() const {
  bool any = false;
  for (std::size_t group = 0; group < kVectorNavGroups; ++group) {
    for (unsigned bit = 0; bit < kVectorNavFieldBytes[group].size(); ++bit) {
      if (!bit_of(fields[group], bit)) continue;
      if (kVectorNavFieldBytes[group][bit] == 0) return false;
      any = true;
    }
  }
  return any;
}

VectorNavHeader read_vectornav_header(std::span<const std::uint8_t> bytes, VectorNavLayout& layout) {
  if (bytes.size() <= kGroupsAt) return VectorNavHeader::kIncomplete;
  layout = {bytes[kGroupsAt], {}};
  if (bit_of(layout.groups, kVectorNavGroups)) return VectorNavHeader::kUnknownField;
  if (bytes.size() < layout.header_bytes()) return VectorNavHeader::kIncomplete;
  const std::uint8_t* at = bytes.data() + kFieldsAt;
  for (std::size_t group = 0; group < kVectorNavGroups; ++group) {
    if (!bit_of(layout.groups, static_cast<unsigned>(group))) continue;
    layout.fields[group] = static_cast<std::uint16_t>(kFieldMap.get(at));
    at += sizeof(std::uint16_t);
  }
  if (!layout.every_length_known()) return VectorNavHeader::kUnknownField;
  return layout.frame_bytes() > kVectorNavMaxFrameBytes ? VectorNavHeader::kTooLong : VectorNavHeader::kSound;
}

}  // namespace lxd
