// SPDX-License-Identifier: Apache-2.0
// See control_messages.hpp.
#include "drivers/livox/control_messages.hpp"

#include <algorithm>

namespace lxd {
namespace {

using Bytes = std::span<const std::uint8_t>;

// Discovery's answer.
constexpr BitField kResult = bytes_at(0, 1), kDevice = bytes_at(1, 1), kControlPort = bytes_at(22, 2);
constexpr std::size_t kSerialAt = 2, kAddressAt = 18, kDiscoveredBytes = 24;
// The answer to new parameters.
constexpr BitField kWrongKey = bytes_at(1, 2);
constexpr std::size_t kParametersSetBytes = 3;
// A list: how many, two bytes reserved, then each.
constexpr BitField kCount = bytes_at(0, 2);
constexpr std::size_t kListHeadBytes = 4;
constexpr BitField kKey = bytes_at(0, 2), kLength = bytes_at(2, 2);
constexpr std::size_t kItemHeadBytes = 4;

constexpr double kTemperatureUnit_degC = 0.01;

// The value at a list's begin; none: the list ends before it does.
std::optional<Bytes> first_value(Bytes list) {
  if (list.size() < kItemHeadBytes) return std::nullopt;
  const auto bytes = static_cast<std::size_t>(kLength.get(list.data()));
  if (list.size() - kItemHeadBytes < bytes) return std::nullopt;
  return list.subspan(kItemHeadBytes, bytes);
}

}  // namespace

std::optional<LivoxParameters> LivoxParameters::read(Bytes data) {
  if (data.size() < kListHeadBytes) return std::nullopt;
  const auto count = static_cast<std::uint16_t>(kCount.get(data.data()));
  const Bytes list = data.subspan(kListHeadBytes);
  Bytes rest = list;
  for (std::uint16_t i = 0; i < count; ++i) {
    const auto value = first_value(rest);
    if (!value) return std::nullopt;
    rest = rest.subspan(kItemHeadBytes + value->size());
  }
  if (!rest.empty()) return std::nullopt;
  return LivoxParameters(count, list);
}

std::optional<Bytes> LivoxParameters::find(LivoxKey key) const {
  for (Bytes rest = list_; !rest.empty();) {
    const Bytes value = *first_value(rest);
    if (kKey.get(rest.data()) == static_cast<std::uint64_t>(key)) return value;
    rest = rest.subspan(kItemHeadBytes + value.size());
  }
  return std::nullopt;
}

std::optional<std::uint64_t> LivoxParameters::number(LivoxKey key) const {
  const auto value = find(key);
  if (!value || value->empty() || value->size() > sizeof(std::uint64_t)) return std::nullopt;
  return bytes_at(0, static_cast<int>(value->size())).get(value->data());
}

std::optional<LivoxDiscovered> read_livox_discovered(Bytes data) {
  if (data.size() != kDiscoveredBytes) return std::nullopt;
  LivoxDiscovered found;
  found.result = static_cast<std::uint8_t>(kResult.get(data.data()));
  found.device = static_cast<LivoxDevice>(kDevice.get(data.data()));
  std::ranges::copy(data.subspan(kSerialAt, found.serial.size()), found.serial.begin());
  std::ranges::copy(data.subspan(kAddressAt, found.address.size()), found.address.begin());
  found.control_port = static_cast<std::uint16_t>(kControlPort.get(data.data()));
  return found;
}

std::optional<LivoxParametersSet> read_livox_parameters_set(Bytes data) {
  if (data.size() != kParametersSetBytes) return std::nullopt;
  return LivoxParametersSet{static_cast<std::uint8_t>(kResult.get(data.data())),
                            static_cast<std::uint16_t>(kWrongKey.get(data.data()))};
}

std::optional<LivoxState> read_livox_state(Bytes data) {
  const auto parameters = LivoxParameters::read(data);
  if (!parameters) return std::nullopt;
  LivoxState state;
  if (const auto mode = parameters->number(LivoxKey::kWorkState)) state.mode = static_cast<LivoxWorkMode>(*mode);
  if (const auto raw = parameters->number(LivoxKey::kCoreTemperature))
    state.core_degC = kTemperatureUnit_degC * static_cast<std::int32_t>(*raw);
  if (const auto sync = parameters->number(LivoxKey::kTimeSync)) state.time_sync = static_cast<std::uint8_t>(*sync);
  state.local_time_ns = parameters->number(LivoxKey::kLocalTime);
  if (const auto codes = parameters->find(LivoxKey::kHealth))
    state.healthy = std::ranges::all_of(*codes, [](std::uint8_t byte) { return byte == 0; });
  return state;
}

bool LivoxParameterWriter::add(LivoxKey key, Bytes value) {
  if (value.size() > kCapacity || size_ + kItemHeadBytes + value.size() > kCapacity) return false;
  std::uint8_t* const at = bytes_.data() + size_;
  kKey.set(at, static_cast<std::uint64_t>(key));
  kLength.set(at, value.size());
  std::ranges::copy(value, at + kItemHeadBytes);
  size_ += kItemHeadBytes + value.size();
  kCount.set(bytes_.data(), kCount.get(bytes_.data()) + 1);
  return true;
}

bool LivoxParameterWriter::add_number(LivoxKey key, std::uint64_t value, std::size_t bytes) {
  std::array<std::uint8_t, sizeof value> little{};
  bytes_at(0, static_cast<int>(little.size())).set(little.data(), value);
  return bytes <= little.size() && add(key, std::span(little).first(bytes));
}

bool LivoxParameterWriter::add_host(LivoxKey key, const LivoxAddress& host, const LivoxPorts& ports) {
  std::array<std::uint8_t, 8> value{host[0], host[1], host[2], host[3]};
  bytes_at(4, 2).set(value.data(), ports.host);
  bytes_at(6, 2).set(value.data(), ports.sensor);
  return add(key, value);
}

LivoxControlFrame livox_discovery(std::uint32_t sequence) {
  return {sequence,
          static_cast<std::uint16_t>(LivoxCommand::kDiscovery),
          LivoxControlKind::kCommand,
          LivoxControlSender::kHost,
          {}};
}

LivoxControlFrame livox_set_parameters(std::uint32_t sequence, Bytes data) {
  return {sequence, static_cast<std::uint16_t>(LivoxCommand::kSetParameters), LivoxControlKind::kCommand,
          LivoxControlSender::kHost, data};
}

}  // namespace lxd
