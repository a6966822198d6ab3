// SPDX-License-Identifier: Apache-2.0
// See ip_reassembler.hpp.
#include "drivers/replay/ip_reassembler.hpp"

#include <algorithm>

namespace lxd {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::size_t kIpHeaderBytes = 20;  // without options
constexpr std::size_t kUdpHeaderBytes = 8;
constexpr unsigned kUdpProtocol = 17;
constexpr unsigned kMoreFragments = 0x2000;
constexpr unsigned kOffsetMask = 0x1FFF;

std::uint32_t big_endian(Bytes bytes, std::size_t at, std::size_t count) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < count; ++i) value = value << 8U | bytes[at + i];
  return value;
}

}  // namespace

IpReassembler::IpReassembler() {
  for (Slot& slot : slots_) slot.bytes.resize(kMaxBytes);
}

std::optional<UdpDatagram> IpReassembler::add(Bytes ipv4) {
  const auto fragment = parse(ipv4);
  if (!fragment) return std::nullopt;
  if (fragment->offset == 0 && fragment->last) return parse_udp(fragment->key, fragment->payload);
  return add_fragment(*fragment);
}

std::optional<IpReassembler::Fragment> IpReassembler::parse(Bytes ipv4) {
  if (ipv4.size() < kIpHeaderBytes || ipv4[0] >> 4U != 4) return refuse();
  const std::size_t header_bytes = (ipv4[0] & 0xFU) * 4U;
  const std::size_t total_bytes = big_endian(ipv4, 2, 2);
  if (header_bytes < kIpHeaderBytes || total_bytes < header_bytes || ipv4.size() < total_bytes) return refuse();
  const std::uint32_t protocol = ipv4[9];
  if (protocol != kUdpProtocol) return std::nullopt;
  const std::uint32_t flags = big_endian(ipv4, 6, 2);
  const std::uint64_t addresses = std::uint64_t{big_endian(ipv4, 12, 4)} << 32U | big_endian(ipv4, 16, 4);
  return Fragment{.key = {addresses, big_endian(ipv4, 4, 2) << 8U | protocol},
                  .offset = (flags & kOffsetMask) * kUnitBytes,
                  .last = (flags & kMoreFragments) == 0,
                  .payload = ipv4.subspan(header_bytes, total_bytes - header_bytes)};
}

std::optional<UdpDatagram> IpReassembler::parse_udp(const Key& key, Bytes payload) {
  if (payload.size() < kUdpHeaderBytes) return refuse();
  const std::size_t udp_bytes = big_endian(payload, 4, 2);
  if (udp_bytes < kUdpHeaderBytes || udp_bytes > payload.size()) return refuse();
  return UdpDatagram{key.source_address(), static_cast<std::uint16_t>(big_endian(payload, 0, 2)),
                     static_cast<std::uint16_t>(big_endian(payload, 2, 2)),
                     payload.subspan(kUdpHeaderBytes, udp_bytes - kUdpHeaderBytes)};
}

std::optional<UdpDatagram> IpReassembler::add_fragment(const Fragment& fragment) {
  const std::size_t end = fragment.offset + fragment.payload.size();
  const bool whole_units = fragment.last || fragment.payload.size() % kUnitBytes == 0;
  if (fragment.payload.empty() || end > kMaxBytes || !whole_units) return refuse();
  Slot& slot = slot_of(fragment.key);
  if (fragment.last) slot.total_bytes = end;
  slot.farthest_bytes = std::max(slot.farthest_bytes, end);
  if (slot.total_bytes && slot.farthest_bytes > *slot.total_bytes) {  // fragments that contradict each other
    slot.used = false;
    return refuse();
  }
  std::copy(fragment.payload.begin(), fragment.payload.end(),
            slot.bytes.begin() + static_cast<std::ptrdiff_t>(fragment.offset));
  for (std::size_t at = fragment.offset; at < end; at += kUnitBytes) slot.received.set(at / kUnitBytes);
  if (!complete(slot)) return std::nullopt;
  slot.used = false;
  return parse_udp(slot.key, Bytes(slot.bytes).first(*slot.total_bytes));
}

// The slot of a datagram under way, or a fresh one; with all in use the oldest datagram is given up.
IpReassembler::Slot& IpReassembler::slot_of(const Key& key) {
  for (Slot& slot : slots_) {
    if (slot.used && slot.key == key) return slot;
  }
  Slot* oldest = &slots_.front();
  for (Slot& slot : slots_) {
    if (!slot.used) {
      oldest = &slot;
      break;
    }
    if (slot.started < oldest->started) oldest = &slot;
  }
  if (oldest->used) ++counts_.incomplete;
  oldest->used = true;
  oldest->key = key;
  oldest->started = starts_++;
  oldest->total_bytes.reset();
  oldest->farthest_bytes = 0;
  oldest->received.reset();
  return *oldest;
}

bool IpReassembler::complete(const Slot& slot) {
  const std::size_t units = (slot.total_bytes.value_or(0) + kUnitBytes - 1) / kUnitBytes;
  return slot.total_bytes && slot.received.count() == units;
}

void IpReassembler::finish() {
  for (Slot& slot : slots_) {
    if (slot.used) ++counts_.incomplete;
    slot.used = false;
  }
}

std::nullopt_t IpReassembler::refuse() {
  ++counts_.malformed;
  return std::nullopt;
}

}  // namespace lxd
