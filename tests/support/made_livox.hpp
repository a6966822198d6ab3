// SPDX-License-Identifier: Apache-2.0
// A Livox sensor on the loopback, as far as its control protocol goes: it answers discovery and commands, pushes its
// state, and can be told to fall silent, to refuse, to be switched off. Its answers are put together by hand.
#pragma once

#include <array>
#include <string>
#include <vector>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include "drivers/device/file_descriptor.hpp"
#include "drivers/livox/control_messages.hpp"

namespace lxd::test {

class MadeLivox {
 public:
  MadeLivox(LivoxAddress address, std::string serial) : address_(address), serial_(std::move(serial)) { switch_on(); }

  bool answers = true;
  std::uint16_t refuses_key = 0;  // 0: takes every parameter
  LivoxWorkMode mode = LivoxWorkMode::kIdle;
  // What it was told.
  int discoveries = 0, settings = 0, questions = 0, reboots = 0;
  std::uint16_t points_port = 0, state_port = 0;

  [[nodiscard]] const LivoxAddress& address() const { return address_; }
  [[nodiscard]] std::uint16_t port() const { return port_; }  // of discovery and of commands
  [[nodiscard]] bool sampling() const { return static_cast<bool>(socket_) && mode == LivoxWorkMode::kSampling; }

  void switch_off() { socket_.reset(); }
  void switch_on() {
    socket_ = FileDescriptor(::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK, 0));
    sockaddr_in here = end(address_, port_);
    socklen_t bytes = sizeof here;
    ASSERT_EQ(::bind(socket_.get(), reinterpret_cast<const sockaddr*>(&here), bytes), 0);
    ASSERT_EQ(::getsockname(socket_.get(), reinterpret_cast<sockaddr*>(&here), &bytes), 0);
    port_ = ntohs(here.sin_port);
    mode = LivoxWorkMode::kIdle;
    state_port = 0;
  }

  // Reads and answers all that waits.
  void step() {
    std::array<std::uint8_t, 2048> buffer;
    sockaddr_in from{};
    socklen_t bytes = sizeof from;
    for (;;) {
      const ssize_t got =
          ::recvfrom(socket_.get(), buffer.data(), buffer.size(), 0, reinterpret_cast<sockaddr*>(&from), &bytes);
      if (got < 0) return;
      LivoxControlFrame frame;
      if (parser_.parse(std::span(buffer).first(static_cast<std::size_t>(got)), frame)) answer(frame, from);
    }
  }

  // As it does once a second.
  void push_state() {
    if (state_port == 0) return;
    LivoxParameterWriter state;
    state.add_number(LivoxKey::kWorkState, static_cast<std::uint64_t>(mode), 1);
    send({++pushed_, static_cast<std::uint16_t>(LivoxCommand::kPushState), LivoxControlKind::kCommand,
          LivoxControlSender::kLidar, state.data()},
         end(host_, state_port));
  }

  // Any bytes to a port of the host.
  void send_bytes(std::span<const std::uint8_t> bytes, std::uint16_t port) const {
    const sockaddr_in to = end({127, 0, 0, 1}, port);
    ::sendto(socket_.get(), bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
  }

 private:
  static sockaddr_in end(const LivoxAddress& address, std::uint16_t port) {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_addr.s_addr = htonl(std::uint32_t{address[0]} << 24U | std::uint32_t{address[1]} << 16U |
                               std::uint32_t{address[2]} << 8U | address[3]);
    to.sin_port = htons(port);
    return to;
  }

  void answer(const LivoxControlFrame& frame, const sockaddr_in& to) {
    const auto is = [&](LivoxCommand command) { return frame.is(command, LivoxControlKind::kCommand); };
    discoveries += is(LivoxCommand::kDiscovery) ? 1 : 0;
    settings += is(LivoxCommand::kSetParameters) ? 1 : 0;
    questions += is(LivoxCommand::kGetParameters) ? 1 : 0;
    reboots += is(LivoxCommand::kReboot) ? 1 : 0;
    if (!answers) return;
    if (is(LivoxCommand::kDiscovery)) acknowledge(frame, discovered(), to);
    if (is(LivoxCommand::kSetParameters)) acknowledge(frame, set(frame), to);
    if (is(LivoxCommand::kGetParameters)) acknowledge(frame, {0, 0, 0}, to);
    if (is(LivoxCommand::kReboot)) acknowledge(frame, {0}, to);
  }

  // ret_code, dev_type, sn[16], ip[4], cmd_port.
  [[nodiscard]] std::vector<std::uint8_t> discovered() const {
    std::vector<std::uint8_t> data(24, 0);
    data[1] = static_cast<std::uint8_t>(LivoxDevice::kMid360);
    std::copy_n(serial_.begin(), std::min<std::size_t>(serial_.size(), 16), data.begin() + 2);
    std::copy(address_.begin(), address_.end(), data.begin() + 18);
    data[22] = static_cast<std::uint8_t>(port_ & 0xFFU);
    data[23] = static_cast<std::uint8_t>(port_ >> 8U);
    return data;
  }

  // ret_code, error_key.
  std::vector<std::uint8_t> set(const LivoxControlFrame& frame) {
    if (refuses_key != 0)
      return {1, static_cast<std::uint8_t>(refuses_key & 0xFFU), static_cast<std::uint8_t>(refuses_key >> 8U)};
    const auto list = LivoxParameters::read(frame.data);
    EXPECT_TRUE(list);
    if (const auto wanted = list->number(LivoxKey::kWorkMode)) mode = static_cast<LivoxWorkMode>(*wanted);
    points_port = host_port(*list, LivoxKey::kPointHost);
    state_port = host_port(*list, LivoxKey::kStateHost);
    return {0, 0, 0};
  }
  std::uint16_t host_port(const LivoxParameters& list, LivoxKey key) {
    const auto value = list.find(key);
    EXPECT_TRUE(value && value->size() == 8);
    std::copy_n(value->begin(), host_.size(), host_.begin());
    return static_cast<std::uint16_t>((*value)[4] | (*value)[5] << 8U);
  }

  void acknowledge(const LivoxControlFrame& frame, const std::vector<std::uint8_t>& data, const sockaddr_in& to) {
    send({frame.sequence, frame.command, LivoxControlKind::kAck, LivoxControlSender::kLidar, data}, to);
  }
  void send(const LivoxControlFrame& frame, const sockaddr_in& to) {
    std::array<std::uint8_t, kLivoxControlMaxBytes> buffer;
    const auto bytes = encode_livox_control(frame, buffer);
    ::sendto(socket_.get(), bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
  }

  LivoxAddress address_;
  std::string serial_;
  FileDescriptor socket_;
  std::uint16_t port_ = 0;
  LivoxAddress host_{};
  std::uint32_t pushed_ = 0;
  LivoxControlParser parser_;
};

}  // namespace lxd::test
