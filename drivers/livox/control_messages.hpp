// SPDX-License-Identifier: Apache-2.0
// What control frames say: discovery, parameters and their answers, the state that a sensor pushes. Readers and writers
// of a frame's data; each reader checks every length before it reads. Pure, allocates nothing.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "drivers/livox/control_frame.hpp"

namespace lxd {

// A sensor's answer to discovery.
struct LivoxDiscovered {
  std::uint8_t result = 0;  // 0: fine
  LivoxDevice device{};     // or a number that is not known here
  std::array<char, 16> serial{};
  LivoxAddress address{};
  std::uint16_t control_port = 0;
};

// A sensor's answer to new parameters.
struct LivoxParametersSet {
  std::uint8_t result = 0;      // 0: fine
  std::uint16_t wrong_key = 0;  // the first that it did not take
};

// A list of parameters, as commands set it and states have it; a view of its bytes.
class LivoxParameters {
 public:
  // None: the list does not hold together, or does not fill the data.
  static std::optional<LivoxParameters> read(std::span<const std::uint8_t> data);

  [[nodiscard]] std::uint16_t count() const { return count_; }
  [[nodiscard]] std::optional<std::span<const std::uint8_t>> find(LivoxKey key) const;
  // A number of that key's own size, 1 to 8 bytes; none: no such key, or no such size.
  [[nodiscard]] std::optional<std::uint64_t> number(LivoxKey key) const;

 private:
  LivoxParameters(std::uint16_t count, std::span<const std::uint8_t> list) : count_(count), list_(list) {}
  std::uint16_t count_;
  std::span<const std::uint8_t> list_;
};

// What matters of a pushed state; each may be missing.
struct LivoxState {
  std::optional<LivoxWorkMode> mode;
  std::optional<double> core_degC;
  std::optional<std::uint8_t> time_sync;  // as LivoxClock
  std::optional<std::uint64_t> local_time_ns;
  bool healthy = true;  // no health code is set
};

// Each: none where the data are not such a message.
std::optional<LivoxDiscovered> read_livox_discovered(std::span<const std::uint8_t> data);
std::optional<LivoxParametersSet> read_livox_parameters_set(std::span<const std::uint8_t> data);
std::optional<LivoxState> read_livox_state(std::span<const std::uint8_t> data);

// The data of a command that sets parameters, or of a state: add() them, then data().
class LivoxParameterWriter {
 public:
  // False: no room; the list stays as it is.
  bool add(LivoxKey key, std::span<const std::uint8_t> value);
  bool add_number(LivoxKey key, std::uint64_t value, std::size_t bytes);
  // Where the sensor sends points, inertial data or its state.
  bool add_host(LivoxKey key, const LivoxAddress& host, const LivoxPorts& ports);
  [[nodiscard]] std::span<const std::uint8_t> data() const { return std::span(bytes_).first(size_); }

 private:
  static constexpr std::size_t kHeadBytes = 4, kCapacity = 256;
  std::array<std::uint8_t, kCapacity> bytes_{};
  std::size_t size_ = kHeadBytes;
};

// Commands of the host.
LivoxControlFrame livox_discovery(std::uint32_t sequence);
// The data must outlive the frame.
LivoxControlFrame livox_set_parameters(std::uint32_t sequence, std::span<const std::uint8_t> data);

}  // namespace lxd
