// SPDX-License-Identifier: Apache-2.0
#include "drivers/replay/udp_frames.hpp"

#include <algorithm>

namespace lxd {
namespace {

using ByteVector = std::vector<std::uint8_t>;

constexpr std::size_t kEthernetBytes = 14, kIpBytes = 20, kUdpBytes = 8;
constexpr std::size_t kMtuBytes = 1500;
constexpr std::size_t kFragmentBytes = (kMtuBytes - kIpBytes) / 8 * 8;  // offsets count units of eight bytes
constexpr std::uint16_t kMoreFragments = 0x2000;
constexpr std::uint8_t kTimeToLive = 64, kUdpProtocol = 17;
constexpr std::uint16_t kEtherTypeIpv4 = 0x0800, kVersionAndLength = 0x4500;
constexpr std::uint8_t kLocalUnicast = 0x02;  // a MAC address that no vendor has

void append(ByteVector& to, std::uint16_t value) {
  to.push_back(static_cast<std::uint8_t>(value >> 8U));
  to.push_back(static_cast<std::uint8_t>(value & 0xFFU));
}
void append(ByteVector& to, std::span<const std::uint8_t> bytes) { to.insert(to.end(), bytes.begin(), bytes.end()); }

void put(ByteVector& at, std::size_t offset, std::uint16_t value) {
  at[offset] = static_cast<std::uint8_t>(value >> 8U);
  at[offset + 1] = static_cast<std::uint8_t>(value & 0xFFU);
}

// The sum of 16-bit words of RFC 1071, not yet complemented.
std::uint32_t word_sum(std::span<const std::uint8_t> bytes, std::uint32_t sum) {
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2)
    sum += static_cast<std::uint32_t>(bytes[i] << 8U | bytes[i + 1]);
  if (bytes.size() % 2 != 0) sum += static_cast<std::uint32_t>(bytes.back()) << 8U;
  return sum;
}

std::uint16_t check_sum(std::uint32_t sum) {
  while (sum > 0xFFFF) sum = (sum & 0xFFFFU) + (sum >> 16U);
  return static_cast<std::uint16_t>(~sum);
}

std::uint16_t udp_check_sum(const UdpRoute& route, std::span<const std::uint8_t> udp) {
  std::uint32_t sum = kUdpProtocol + static_cast<std::uint32_t>(udp.size());
  sum = word_sum(route.source.address, sum);
  sum = word_sum(route.destination.address, sum);
  const std::uint16_t check = check_sum(word_sum(udp, sum));
  return check == 0 ? 0xFFFF : check;  // zero would say that there is none
}

void append_mac(ByteVector& to, const UdpEnd& end) {
  to.push_back(kLocalUnicast);
  to.push_back(0);
  append(to, end.address);
}

}  // namespace

std::span<const ByteVector> UdpFramer::frames(const UdpRoute& route, std::span<const std::uint8_t> payload) {
  udp_.clear();
  append(udp_, route.source.port);
  append(udp_, route.destination.port);
  append(udp_, static_cast<std::uint16_t>(kUdpBytes + payload.size()));
  append(udp_, std::uint16_t{0});
  append(udp_, payload);
  put(udp_, kUdpBytes - 2, udp_check_sum(route, udp_));
  ++identification_;
  const std::size_t count = (udp_.size() + kFragmentBytes - 1) / kFragmentBytes;
  if (frames_.size() < count) frames_.resize(count);
  for (std::size_t i = 0; i < count; ++i) frame_fragment(route, i * kFragmentBytes, frames_[i]);
  return std::span(frames_).first(count);
}

void UdpFramer::frame_fragment(const UdpRoute& route, std::size_t offset, ByteVector& frame) const {
  const std::size_t bytes = std::min(kFragmentBytes, udp_.size() - offset);
  const bool last = offset + bytes == udp_.size();
  frame.clear();
  append_mac(frame, route.destination);
  append_mac(frame, route.source);
  append(frame, kEtherTypeIpv4);
  append(frame, kVersionAndLength);
  append(frame, static_cast<std::uint16_t>(kIpBytes + bytes));
  append(frame, identification_);
  append(frame, static_cast<std::uint16_t>(offset / 8 | (last ? 0U : kMoreFragments)));
  frame.push_back(kTimeToLive);
  frame.push_back(kUdpProtocol);
  append(frame, std::uint16_t{0});
  append(frame, route.source.address);
  append(frame, route.destination.address);
  put(frame, kEthernetBytes + 10, check_sum(word_sum(std::span(frame).subspan(kEthernetBytes, kIpBytes), 0)));
  append(frame, std::span(udp_).subspan(offset, bytes));
}

}  // namespace lxd
