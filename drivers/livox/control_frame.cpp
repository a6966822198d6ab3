// SPDX-License-Identifier: Apache-2.0
// See control_frame.hpp.
#include "drivers/livox/control_frame.hpp"

#include <algorithm>

#include "drivers/crc.hpp"
#include "drivers/imu/crc16.hpp"
#include "drivers/refuse.hpp"

namespace lxd {
namespace {

std::uint32_t data_crc(std::span<const std::uint8_t> data) { return data.empty() ? 0 : crc32(data); }

}  // namespace

bool LivoxControlParser::parse(std::span<const std::uint8_t> datagram, LivoxControlFrame& frame) {
  if (!accept(datagram)) return false;
  const std::uint8_t* const header = datagram.data();
  frame = {static_cast<std::uint32_t>(kLivoxControl.sequence.get(header)),
           static_cast<std::uint16_t>(kLivoxControl.command.get(header)),
           static_cast<LivoxControlKind>(kLivoxControl.kind.get(header)),
           static_cast<LivoxControlSender>(kLivoxControl.sender.get(header)),
           datagram.subspan(kLivoxControlHeaderBytes)};
  ++counts_.frames;
  return true;
}

bool LivoxControlParser::accept(std::span<const std::uint8_t> datagram) {
  if (datagram.size() < kLivoxControlHeaderBytes) return refuse(counts_.bad_size);
  const std::uint8_t* const header = datagram.data();
  if (kLivoxControl.start.get(header) != kLivoxControlStart) return refuse(counts_.bad_start);
  if (kLivoxControl.version.get(header) != kLivoxControlVersion) return refuse(counts_.bad_start);
  if (kLivoxControl.length.get(header) != datagram.size()) return refuse(counts_.bad_size);
  const std::uint16_t header_crc = crc16(datagram.first(kLivoxControlCheckedBytes), kLivoxHeaderCrcInitial);
  if (kLivoxControl.header_crc.get(header) != header_crc) return refuse(counts_.bad_crc);
  if (kLivoxControl.data_crc.get(header) != data_crc(datagram.subspan(kLivoxControlHeaderBytes)))
    return refuse(counts_.bad_crc);
  const bool known = kLivoxControl.kind.get(header) <= 1 && kLivoxControl.sender.get(header) <= 1;
  return known || refuse(counts_.bad_kind);
}

std::span<const std::uint8_t> encode_livox_control(const LivoxControlFrame& frame, std::span<std::uint8_t> buffer) {
  const std::size_t bytes = kLivoxControlHeaderBytes + frame.data.size();
  if (bytes > std::min(buffer.size(), kLivoxControlMaxBytes)) return {};
  std::uint8_t* const header = buffer.data();
  std::fill_n(header, kLivoxControlHeaderBytes, std::uint8_t{0});
  kLivoxControl.start.set(header, kLivoxControlStart);
  kLivoxControl.version.set(header, kLivoxControlVersion);
  kLivoxControl.length.set(header, bytes);
  kLivoxControl.sequence.set(header, frame.sequence);
  kLivoxControl.command.set(header, frame.command);
  kLivoxControl.kind.set(header, static_cast<std::uint64_t>(frame.kind));
  kLivoxControl.sender.set(header, static_cast<std::uint64_t>(frame.sender));
  kLivoxControl.header_crc.set(header, crc16(buffer.first(kLivoxControlCheckedBytes), kLivoxHeaderCrcInitial));
  kLivoxControl.data_crc.set(header, data_crc(frame.data));
  std::ranges::copy(frame.data, buffer.begin() + kLivoxControlHeaderBytes);
  return buffer.first(bytes);
}

}  // namespace lxd
