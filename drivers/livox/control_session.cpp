// SPDX-License-Identifier: Apache-2.0
// See control_session.hpp. A sensor pushes its state once a second and answers every command; the times below are
// multiples of that. Commands are those of Livox-SDK2.
#include "drivers/livox/control_session.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace lxd {
namespace {

Duration seconds(double s) { return Duration::from_seconds(s); }

const Duration kDiscoveryEvery = seconds(1);
const Duration kAnswer = seconds(0.5);        // a command without an answer is sent again
constexpr int kTries = 6;                     // and after so many the sensor is gone
const Duration kSilent = seconds(2);          // without points: started again
const Duration kSpinUp = seconds(30);         // self check and the motor's start take as long at most
const Duration kNoSignOfLife = seconds(1.5);  // asked for one
const Duration kGone = seconds(5);
constexpr int kRestartsBeforeReboot = 3;
constexpr std::uint64_t kRebootDelay_ms = 100;

LivoxControlFrame command(LivoxCommand which, std::uint32_t sequence, std::span<const std::uint8_t> data) {
  return {sequence, static_cast<std::uint16_t>(which), LivoxControlKind::kCommand, LivoxControlSender::kHost, data};
}

struct ModelPorts {
  LivoxPorts state, points, imu;
};

ModelPorts ports_of(LivoxDevice device) {
  const bool is_hap = device == LivoxDevice::kHap || device == LivoxDevice::kIndustrialHap;
  return is_hap ? ModelPorts{hap::kState, hap::kPoints, hap::kImu}
                : ModelPorts{mid360::kState, mid360::kPoints, mid360::kImu};
}

LivoxPorts with_host(LivoxPorts ports, std::uint16_t host) { return {ports.sensor, host == 0 ? ports.host : host}; }

std::string text_of(const std::array<char, 16>& padded) { return {padded.begin(), std::ranges::find(padded, '\0')}; }

}  // namespace

void LivoxSession::seek(std::string why) {
  if (phase_ != LivoxPhase::seeking) ++counts_.lost;
  phase_ = LivoxPhase::seeking;
  trouble_ = std::move(why);
  next_ = kNever;
}

void LivoxSession::set_up(RigTime now) {
  phase_ = LivoxPhase::setting_up;
  tries_ = 0;
  next_ = now;
}

void LivoxSession::run(RigTime now) {
  phase_ = LivoxPhase::running;
  trouble_.clear();
  running_since_ = last_points_ = now;
  next_ = now;
}

void LivoxSession::step(RigTime now, LivoxControlWire& wire) {
  if (phase_ == LivoxPhase::running) return watch(now, wire);
  if (now < next_) return;
  if (phase_ == LivoxPhase::seeking) {
    send_discovery(wire);
    next_ = now + kDiscoveryEvery;
  } else if (tries_++ < kTries) {
    send_parameters(wire);
    next_ = now + kAnswer;
  } else {
    seek(trouble_.empty() ? "does not answer" : trouble_);
  }
}

// Of the way from standing to sampling.
bool LivoxSession::starting(RigTime now) const {
  if (!state_ || !state_->mode || now - running_since_ > kSpinUp) return false;
  return *state_->mode == LivoxWorkMode::kSelfCheck || *state_->mode == LivoxWorkMode::kMotorStart;
}

void LivoxSession::watch(RigTime now, LivoxControlWire& wire) {
  if (now - std::max(last_life_, last_points_) > kGone) return seek("fell silent");
  if (last_points_ > running_since_) restarts_ = 0;
  if (now - last_points_ > kSilent && !starting(now)) {
    if (restarts_++ < kRestartsBeforeReboot) {
      ++counts_.restarts;
      return set_up(now);
    }
    restarts_ = 0;
    ++counts_.reboots;
    send_reboot(wire);
    return seek("rebooted, as it sent no points");
  }
  if (now - last_life_ > kNoSignOfLife && now >= next_) {
    ask_for_sign_of_life(wire);
    next_ = now + kAnswer;
  }
}

void LivoxSession::send(const LivoxControlFrame& frame, LivoxControlWire& wire) {
  std::array<std::uint8_t, kLivoxControlMaxBytes> buffer;
  wire.send(*address_, control_port_, encode_livox_control(frame, buffer));
}

void LivoxSession::send_discovery(LivoxControlWire& wire) {
  std::array<std::uint8_t, kLivoxControlMaxBytes> buffer;
  const auto datagram = encode_livox_control(livox_discovery(++sequence_), buffer);
  wire.send(config_.sensor.value_or(kLivoxBroadcast), config_.discovery_port, datagram);
}

void LivoxSession::send_parameters(LivoxControlWire& wire) {
  const ModelPorts ports = ports_of(device_);
  LivoxParameterWriter list;  // has room for these
  list.add_number(LivoxKey::kPointType, config_.point_type, 1);
  list.add_host(LivoxKey::kStateHost, config_.host, with_host(ports.state, config_.state_port));
  list.add_host(LivoxKey::kPointHost, config_.host, with_host(ports.points, config_.points_port));
  list.add_host(LivoxKey::kImuHost, config_.host, with_host(ports.imu, config_.imu_port));
  list.add_number(LivoxKey::kImuEnable, config_.imu ? 1 : 0, 1);
  list.add_number(LivoxKey::kWorkMode, static_cast<std::uint64_t>(LivoxWorkMode::kSampling), 1);
  parameters_sequence_ = ++sequence_;
  send(livox_set_parameters(parameters_sequence_, list.data()), wire);
}

// The data: in how many milliseconds, two bytes.
void LivoxSession::send_reboot(LivoxControlWire& wire) {
  std::array<std::uint8_t, 2> delay{};
  bytes_at(0, 2).set(delay.data(), kRebootDelay_ms);
  send(command(LivoxCommand::kReboot, ++sequence_, delay), wire);
}

// The data: a count, two reserved bytes, the keys.
void LivoxSession::ask_for_sign_of_life(LivoxControlWire& wire) {
  std::array<std::uint8_t, 6> keys{};
  bytes_at(0, 2).set(keys.data(), 1);
  bytes_at(4, 2).set(keys.data(), static_cast<std::uint64_t>(LivoxKey::kWorkState));
  send(command(LivoxCommand::kGetParameters, ++sequence_, keys), wire);
}

bool LivoxSession::take_discovered(const LivoxDiscovered& found, RigTime now) {
  const bool wanted_address = !config_.sensor || *config_.sensor == found.address;
  const bool wanted_serial = config_.serial.empty() || config_.serial == text_of(found.serial);
  if (!wanted_address || !wanted_serial) return false;
  last_life_ = now;
  if (phase_ != LivoxPhase::seeking || found.result != 0) return true;
  ++counts_.found;
  address_ = found.address;
  control_port_ = found.control_port;
  device_ = found.device;
  serial_ = text_of(found.serial);
  state_.reset();
  trouble_.clear();
  set_up(now);
  return true;
}

bool LivoxSession::take(const LivoxControlFrame& frame, RigTime now) {
  last_life_ = now;
  if (frame.is(LivoxCommand::kSetParameters, LivoxControlKind::kAck)) return take_parameters_set(frame, now);
  if (frame.is(LivoxCommand::kPushState, LivoxControlKind::kCommand) ||
      frame.is(LivoxCommand::kPushState, LivoxControlKind::kAck))
    return take_state(frame, now);
  return true;
}

bool LivoxSession::take_parameters_set(const LivoxControlFrame& frame, RigTime now) {
  const auto answer = read_livox_parameters_set(frame.data);
  if (!answer) return false;
  if (phase_ != LivoxPhase::setting_up || frame.sequence != parameters_sequence_) return true;
  if (answer->result == 0) {
    run(now);
  } else {
    ++counts_.refusals;
    trouble_ = fmt::format("refused parameter {:#06x} (code {})", answer->wrong_key, answer->result);
  }
  return true;
}

// A sensor that was switched off and on again, or was told so by another host, is not sampling.
bool LivoxSession::take_state(const LivoxControlFrame& frame, RigTime now) {
  const auto state = read_livox_state(frame.data);
  if (!state) return false;
  ++counts_.states;
  state_ = *state;
  const bool settled = now - running_since_ > kSilent;
  const bool stands = state->mode && (*state->mode == LivoxWorkMode::kIdle || *state->mode == LivoxWorkMode::kSleep ||
                                      *state->mode == LivoxWorkMode::kReady);
  if (phase_ == LivoxPhase::running && settled && stands) {
    ++counts_.restarts;
    set_up(now);
  }
  return true;
}

}  // namespace lxd
