// SPDX-License-Identifier: Apache-2.0
// See control_device.hpp. Discovery leaves from the discovery socket, for sensors answer to where it came from;
// commands leave from the control socket.
#include "drivers/livox/control_device.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/epoll.h>
#include <sys/socket.h>

namespace lxd {
namespace {

sockaddr_in end_of(const LivoxAddress& address, std::uint16_t port) {
  sockaddr_in end{};
  end.sin_family = AF_INET;
  std::memcpy(&end.sin_addr.s_addr, address.data(), address.size());
  end.sin_port = htons(port);
  return end;
}

LivoxAddress address_of(const sockaddr_in& end) {
  LivoxAddress address{};
  std::memcpy(address.data(), &end.sin_addr.s_addr, address.size());
  return address;
}

std::uint16_t port_of(int socket) {
  sockaddr_in end{};
  socklen_t bytes = sizeof end;
  return ::getsockname(socket, reinterpret_cast<sockaddr*>(&end), &bytes) == 0 ? ntohs(end.sin_port) : 0;
}

}  // namespace

LivoxControl::LivoxControl(std::vector<LivoxSessionConfig> sessions, const LivoxHostPorts& ports)
    : configs_(std::move(sessions)), ports_(ports), trouble_("not opened yet") {}

// A port is bound on all addresses: broadcasts reach no socket of one address.
Status LivoxControl::open(Role role, std::uint16_t port) {
  const auto failed = [&](const char* what) {
    return Error{fmt::format("udp {}: {}: {}", port, what, std::strerror(errno))};
  };
  FileDescriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (!socket) return failed("no socket");
  const int yes = 1;
  if (::setsockopt(socket.get(), SOL_SOCKET, SO_BROADCAST, &yes, sizeof yes) != 0) return failed("no broadcasts");
  const sockaddr_in here = end_of({0, 0, 0, 0}, port);
  if (::bind(socket.get(), reinterpret_cast<const sockaddr*>(&here), sizeof here) != 0) return failed("cannot be had");
  epoll_event event{};
  event.events = EPOLLIN;
  if (::epoll_ctl(poll_.get(), EPOLL_CTL_ADD, socket.get(), &event) != 0) return failed("epoll");
  sockets_[role] = std::move(socket);
  return success();
}

Status LivoxControl::open() {
  poll_ = FileDescriptor(::epoll_create1(EPOLL_CLOEXEC));
  if (!poll_) return Error{fmt::format("epoll: {}", std::strerror(errno))};
  if (const Status opened = open(kDiscovery, ports_.discovery); !opened) return opened;
  const bool one_socket = ports_.control == ports_.discovery && ports_.control != 0;
  if (!one_socket) {
    if (const Status opened = open(kControl, ports_.control); !opened) return opened;
  }
  const bool own_state = ports_.state == 0 || (ports_.state != ports_.discovery && ports_.state != ports_.control);
  if (own_state) {
    if (const Status opened = open(kState, ports_.state); !opened) return opened;
  }
  return success();
}

void LivoxControl::tend(RigTime now) {
  now_ = now;
  if (sessions_.empty()) {
    if (const Status opened = open(); !opened) {
      trouble_ = opened.error().message;
      for (FileDescriptor& socket : sockets_) socket.reset();
      poll_.reset();
      return;
    }
    trouble_.clear();
    ++counts_.openings;
    const std::uint16_t state = sockets_[kState] ? port_of(sockets_[kState].get()) : ports_.state;
    for (LivoxSessionConfig config : configs_) {
      if (config.state_port == 0) config.state_port = state;
      sessions_.emplace_back(std::move(config));
    }
  }
  for (LivoxSession& session : sessions_) session.step(now, *this);
}

const std::string& LivoxControl::trouble() const {
  if (!trouble_.empty()) return trouble_;
  const auto troubled = std::ranges::find_if(sessions_, [](const auto& session) { return !session.trouble().empty(); });
  return troubled == sessions_.end() ? trouble_ : troubled->trouble();
}

void LivoxControl::read(ChunkSink&) {
  for (const FileDescriptor& socket : sockets_) {
    if (socket) read(socket.get());
  }
}

void LivoxControl::read(int socket) {
  std::array<std::uint8_t, kLivoxControlMaxBytes + 1> buffer;  // what fills it is too long for a frame
  for (int i = 0; i < kChunksPerRead; ++i) {
    sockaddr_in from{};
    socklen_t bytes = sizeof from;
    const ssize_t got = ::recvfrom(socket, buffer.data(), buffer.size(), 0, reinterpret_cast<sockaddr*>(&from), &bytes);
    if (got < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return;
    if (got < 0) {
      ++counts_.read_errors;  // such as an earlier command's "port unreachable": the sensor is gone, which is noticed
      continue;
    }
    ++counts_.chunks;
    counts_.bytes += static_cast<std::uint64_t>(got);
    take(address_of(from), std::span(buffer).first(static_cast<std::size_t>(got)));
  }
}

void LivoxControl::take(const LivoxAddress& from, std::span<const std::uint8_t> datagram) {
  LivoxControlFrame frame;
  if (!parser_.parse(datagram, frame)) return;
  if (frame.sender != LivoxControlSender::kLidar) return;  // our own broadcast comes back
  const bool sound =
      frame.is(LivoxCommand::kDiscovery, LivoxControlKind::kAck) ? discovered(frame) : dispatch(from, frame);
  if (!sound) parser_.count_bad_values();
}

// A sensor belongs to the session that has it; a new one to the first session that is without.
bool LivoxControl::discovered(const LivoxControlFrame& frame) {
  const auto found = read_livox_discovered(frame.data);
  if (!found) return false;
  for (LivoxSession& session : sessions_) {
    if (session.address() == found->address && session.take_discovered(*found, now_)) return true;
  }
  for (LivoxSession& session : sessions_) {
    if (session.phase() == LivoxPhase::seeking && session.take_discovered(*found, now_)) return true;
  }
  ++counts_.foreign;
  return true;
}

bool LivoxControl::dispatch(const LivoxAddress& from, const LivoxControlFrame& frame) {
  for (LivoxSession& session : sessions_) {
    if (session.address() == from) return session.take(frame, now_);
  }
  ++counts_.foreign;
  return true;
}

void LivoxControl::send(const LivoxAddress& to, std::uint16_t port, std::span<const std::uint8_t> datagram) {
  const bool discovery =
      kLivoxControl.command.get(datagram.data()) == static_cast<std::uint64_t>(LivoxCommand::kDiscovery);
  const FileDescriptor& socket = discovery || !sockets_[kControl] ? sockets_[kDiscovery] : sockets_[kControl];
  const sockaddr_in end = end_of(to, port);
  const ssize_t sent =
      ::sendto(socket.get(), datagram.data(), datagram.size(), 0, reinterpret_cast<const sockaddr*>(&end), sizeof end);
  if (sent < 0) ++counts_.read_errors;  // the network is down: sessions try again
}

}  // namespace lxd
