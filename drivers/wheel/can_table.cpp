// SPDX-License-Identifier: Apache-2.0
// Sources of the checksums: opendbc `toyotacan.py`, `hondacan.py`.
#include "drivers/wheel/can_table.hpp"

#include <functional>
#include <numeric>

namespace lxd {
namespace {

using Before = std::span<const std::uint8_t>;  // the bytes before the last

unsigned sum_of(Before bytes) { return std::accumulate(bytes.begin(), bytes.end(), 0U); }

unsigned toyota_checksum(const CanMessage& message, Before bytes) {
  unsigned sum = message.length + sum_of(bytes);
  for (std::uint32_t id = message.id; id != 0; id >>= 8U) sum += id & 0xFFU;
  return sum;
}

unsigned honda_checksum(const CanMessage& message, Before bytes, std::uint8_t last) {
  constexpr unsigned kHalf = 4, kHalfMask = 0xF, kBegin = 8, kExtended = 3;
  unsigned sum = last >> kHalf;
  for (const std::uint8_t byte : bytes) sum += (byte >> kHalf) + (byte & kHalfMask);
  for (std::uint32_t id = message.id; id != 0; id >>= kHalf) sum += id & kHalfMask;
  return (kBegin + (message.extended ? kExtended : 0) - sum) & kHalfMask;
}

// Which bits of the last byte are the checksum.
unsigned mask_of(const CanMessage& message) { return message.checksum == CanChecksum::honda ? 0x0F : 0xFF; }

std::uint8_t checksum(const CanMessage& message, const CanData& data) {
  const Before before = std::span(data).first(message.length - 1U);
  switch (message.checksum) {
    case CanChecksum::toyota:
      return static_cast<std::uint8_t>(toyota_checksum(message, before));
    case CanChecksum::honda:
      return static_cast<std::uint8_t>(honda_checksum(message, before, data[before.size()]));
    case CanChecksum::sum:
      return static_cast<std::uint8_t>(sum_of(before));
    case CanChecksum::exclusive_or:
      return std::accumulate(before.begin(), before.end(), std::uint8_t{0}, std::bit_xor<std::uint8_t>());
    case CanChecksum::none:
      break;
  }
  return 0;
}

}  // namespace

const CanMessage* find_message(std::span<const CanMessage> table, std::uint32_t id, bool extended) {
  for (const CanMessage& message : table)
    if (message.id == id && message.extended == extended) return &message;
  return nullptr;
}

const CanSignal* find_signal(const CanMessage& message, std::string_view name) {
  for (const CanSignal& signal : message.signals)
    if (signal.name == name) return &signal;
  return nullptr;
}

bool checksum_holds(const CanMessage& message, const CanData& data) {
  return message.checksum == CanChecksum::none ||
         (data[message.length - 1U] & mask_of(message)) == checksum(message, data);
}

void set_checksum(const CanMessage& message, CanData& data) {
  if (message.checksum == CanChecksum::none) return;
  std::uint8_t& last = data[message.length - 1U];
  last = static_cast<std::uint8_t>((last & ~mask_of(message)) | checksum(message, data));
}

CanValues decode_signals(const CanMessage& message, const CanData& data) {
  CanValues values;
  for (const CanSignal& signal : message.signals) {
    if (signal.faulty(data)) {
      values.fault = true;
    } else {
      values.by_role[static_cast<std::size_t>(signal.role)] = {&signal, signal.raw(data)};
    }
  }
  return values;
}

}  // namespace lxd
