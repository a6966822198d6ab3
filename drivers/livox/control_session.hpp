// SPDX-License-Identifier: Apache-2.0
// The host's side of Livox SDK2's control protocol with one sensor: found, set up, watched, started again when it falls
// silent, sought again when it is gone. A state machine of datagrams and time: it neither waits nor owns a socket.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "drivers/livox/control_messages.hpp"
#include "rt/time.hpp"

namespace lxd {

struct LivoxSessionConfig {
  LivoxAddress host{};                   // of this host, as the sensor sees it
  std::optional<LivoxAddress> sensor{};  // none: whoever answers the broadcast
  std::string serial{};                  // empty: any
  std::uint8_t point_type = 1;           // of LivoxKey::kPointType: 1 Cartesian mm, 2 Cartesian cm, 3 spherical
  bool imu = true;                       // its inertial data are wanted
  // This host's ports; the sensor's own are those of its model. 0: the model's.
  std::uint16_t points_port = 0, imu_port = 0, state_port = 0;
  std::uint16_t discovery_port = kLivoxDiscoveryPort;  // the sensor's
};

enum class LivoxPhase : std::uint8_t {
  seeking,     // discovery goes out once a second
  setting_up,  // parameters are sent, not acknowledged yet
  running
};

struct LivoxSessionCounts {
  std::uint64_t found = 0, lost = 0;  // the sensor
  std::uint64_t restarts = 0;         // silent, or fallen out of sampling: parameters sent again
  std::uint64_t reboots = 0;          // as that did not help
  std::uint64_t refusals = 0;         // of parameters
  std::uint64_t states = 0;           // pushed by the sensor
};
inline constexpr std::array<std::pair<const char*, std::uint64_t LivoxSessionCounts::*>, 6> kLivoxSessionCountNames{{
    {"found", &LivoxSessionCounts::found},
    {"lost", &LivoxSessionCounts::lost},
    {"restarts", &LivoxSessionCounts::restarts},
    {"reboots", &LivoxSessionCounts::reboots},
    {"refusals", &LivoxSessionCounts::refusals},
    {"states", &LivoxSessionCounts::states},
}};

// Where commands go.
class LivoxControlWire {
 public:
  virtual ~LivoxControlWire() = default;
  virtual void send(const LivoxAddress& to, std::uint16_t port, std::span<const std::uint8_t> datagram) = 0;
};
inline constexpr LivoxAddress kLivoxBroadcast{255, 255, 255, 255};

class LivoxSession {
 public:
  explicit LivoxSession(LivoxSessionConfig config) : config_(std::move(config)) {}

  // Sends what is due. Every 100 ms or so.
  void step(RigTime now, LivoxControlWire& wire);
  // An answer to discovery from any address. False: not this session's sensor.
  bool take_discovered(const LivoxDiscovered& found, RigTime now);
  // Any other sound frame of the sensor's. False: its data are no such message.
  bool take(const LivoxControlFrame& frame, RigTime now);
  // Points came from the sensor.
  void heard_points(RigTime now) { last_points_ = now; }

  [[nodiscard]] LivoxPhase phase() const { return phase_; }
  // None before it was found.
  [[nodiscard]] const std::optional<LivoxAddress>& address() const { return address_; }
  [[nodiscard]] const std::string& serial() const { return serial_; }
  [[nodiscard]] LivoxDevice device() const { return device_; }
  [[nodiscard]] const std::optional<LivoxState>& state() const { return state_; }
  [[nodiscard]] const std::string& trouble() const { return trouble_; }  // empty: it runs
  [[nodiscard]] const LivoxSessionCounts& counts() const { return counts_; }

 private:
  void seek(std::string why);
  void set_up(RigTime now);
  void run(RigTime now);
  void send_discovery(LivoxControlWire& wire);
  void send_parameters(LivoxControlWire& wire);
  void send_reboot(LivoxControlWire& wire);
  void ask_for_sign_of_life(LivoxControlWire& wire);
  void send(const LivoxControlFrame& frame, LivoxControlWire& wire);
  void watch(RigTime now, LivoxControlWire& wire);
  [[nodiscard]] bool starting(RigTime now) const;
  bool take_parameters_set(const LivoxControlFrame& frame, RigTime now);
  bool take_state(const LivoxControlFrame& frame, RigTime now);

  LivoxSessionConfig config_;
  LivoxPhase phase_ = LivoxPhase::seeking;
  std::optional<LivoxAddress> address_;
  std::uint16_t control_port_ = 0;
  LivoxDevice device_{};
  std::string serial_;
  std::optional<LivoxState> state_;
  std::string trouble_ = "not found yet";
  std::uint32_t sequence_ = 0, parameters_sequence_ = 0;
  RigTime next_ = kNever;       // the next thing that is due in this phase
  RigTime last_life_ = kNever;  // any frame of the sensor's
  RigTime last_points_ = kNever;
  RigTime running_since_ = kNever;
  int tries_ = 0;     // of parameters without an answer
  int restarts_ = 0;  // in a row, without points between
  LivoxSessionCounts counts_;
};

}  // namespace lxd
