// SPDX-License-Identifier: Apache-2.0
// The sockets of Livox SDK2's control protocol: discovery, commands and pushed states of all Livox sensors of a rig,
// each with its session. Their points and inertial data come by sockets of their own (drivers/device).
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "drivers/device/device.hpp"
#include "drivers/device/file_descriptor.hpp"
#include "drivers/livox/control_session.hpp"
#include "rt/result.hpp"

namespace lxd {

// Ports of this host; 0: the kernel chooses. Equal ones are one socket, as a HAP wants it.
struct LivoxHostPorts {
  std::uint16_t discovery = kLivoxDiscoveryPort;
  std::uint16_t control = mid360::kControl.host;
  std::uint16_t state = mid360::kState.host;
};

class LivoxControl final : public Device, private LivoxControlWire {
 public:
  // All sessions have the same host address; where they name no state port, they get that of `ports`.
  LivoxControl(std::vector<LivoxSessionConfig> sessions, const LivoxHostPorts& ports);

  [[nodiscard]] const std::string& name() const override { return name_; }
  // Of all its sockets (epoll).
  [[nodiscard]] int fd() const override { return poll_.get(); }
  // Reads what the sensors say; the sink gets nothing of it.
  void read(ChunkSink& sink) override;
  // Opens the sockets, and sends what is due. What is read counts as of the last call's time.
  void tend(RigTime now) override;
  // Of the sockets, else of the first session that has one.
  [[nodiscard]] const std::string& trouble() const override;
  [[nodiscard]] const DeviceCounts& counts() const override { return counts_; }

  [[nodiscard]] std::span<const LivoxSession> sessions() const { return sessions_; }
  // Points came from that session's sensor.
  void heard_points(std::size_t session, RigTime now) { sessions_[session].heard_points(now); }
  [[nodiscard]] const LivoxControlCounts& frame_counts() const { return parser_.counts(); }

 private:
  static constexpr std::size_t kSockets = 3;
  enum Role : std::size_t { kDiscovery, kControl, kState };

  Status open();
  Status open(Role role, std::uint16_t port);
  void read(int socket);
  void take(const LivoxAddress& from, std::span<const std::uint8_t> datagram);
  bool dispatch(const LivoxAddress& from, const LivoxControlFrame& frame);
  bool discovered(const LivoxControlFrame& frame);
  void send(const LivoxAddress& to, std::uint16_t port, std::span<const std::uint8_t> datagram) override;

  std::vector<LivoxSessionConfig> configs_;
  LivoxHostPorts ports_;
  std::string name_ = "livox control";
  std::vector<LivoxSession> sessions_;
  std::array<FileDescriptor, kSockets> sockets_;
  FileDescriptor poll_;
  LivoxControlParser parser_;
  std::string trouble_;
  RigTime now_ = kNever;
  DeviceCounts counts_;
};

}  // namespace lxd
