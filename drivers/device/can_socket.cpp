// SPDX-License-Identifier: Apache-2.0
#include "drivers/device/can_socket.hpp"

#include <cerrno>
#include <cstring>

#include <fmt/format.h>
#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

namespace lxd {
namespace {

std::vector<can_filter> filters_of(const std::vector<CanId>& ids) {
  std::vector<can_filter> filters;
  for (const CanId& id : ids) {
    const canid_t mask = (id.extended ? CAN_EFF_MASK : CAN_SFF_MASK) | CAN_EFF_FLAG;
    filters.push_back({id.id | (id.extended ? CAN_EFF_FLAG : 0U), mask});
  }
  return filters;
}

Error last_error(const char* what) { return Error{fmt::format("{}: {}", what, std::strerror(errno))}; }

// Its number, when it is there and up.
Result<int> interface_up(int socket, const std::string& name) {
  ifreq request{};
  name.copy(request.ifr_name, IFNAMSIZ - 1);
  if (::ioctl(socket, SIOCGIFFLAGS, &request) != 0) return last_error("no such interface");
  if ((request.ifr_flags & IFF_UP) == 0) return Error{"the interface is down"};
  if (::ioctl(socket, SIOCGIFINDEX, &request) != 0) return last_error("no such interface");
  return request.ifr_ifindex;
}

}  // namespace

CanSocket::CanSocket(CanConfig config, const HostClock& clock, FileDescriptor socket)
    : CanSocket(std::move(config), clock) {
  socket_ = std::move(socket);
  (void)ask_for_notes(socket_.get());
  trouble_.clear();
  ++counts_.openings;
}

void CanSocket::tend(RigTime now) {
  if (socket_ || !reopening_.due(now)) return;
  const Status opened = open();
  if (opened) {
    trouble_.clear();
    ++counts_.openings;
    return;
  }
  socket_.reset();
  trouble_ = opened.error().message;
  reopening_.failed(now);
}

Status CanSocket::open() {
  socket_ = FileDescriptor(::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW));
  if (!socket_) return last_error("this kernel gives no CAN sockets");
  const auto index = interface_up(fd(), config_.interface);
  if (!index) return index.error();
  Status chosen = choose(fd());
  if (!chosen) return chosen;
  (void)ask_for_notes(fd());
  losses_.begin_again();
  sockaddr_can end{};
  end.can_family = AF_CAN;
  end.can_ifindex = *index;
  if (::bind(fd(), reinterpret_cast<const sockaddr*>(&end), sizeof(end)) != 0)
    return last_error("cannot be listened to");
  return success();
}

// Before bind(), so that not one unwanted frame comes.
Status CanSocket::choose(int socket) const {
  const can_err_mask_t errors = CAN_ERR_MASK;
  if (::setsockopt(socket, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &errors, sizeof(errors)) != 0)
    return last_error("error frames are refused");
  const std::vector<can_filter> filters = filters_of(config_.ids);
  const auto bytes = static_cast<socklen_t>(filters.size() * sizeof(can_filter));
  if (!filters.empty() && ::setsockopt(socket, SOL_CAN_RAW, CAN_RAW_FILTER, filters.data(), bytes) != 0)
    return last_error("the filters are refused");
  return success();
}

void CanSocket::read(ChunkSink& sink) {
  for (int i = 0; i < kChunksPerRead && socket_; ++i)
    if (!read_one(sink)) return;
}

// False: nothing waits, or the interface is gone.
bool CanSocket::read_one(ChunkSink& sink) {
  std::array<std::uint8_t, kCanWireBytes> wire{};
  alignas(cmsghdr) std::array<std::uint8_t, kMessageNotesBytes> room{};
  iovec piece{wire.data(), wire.size()};
  msghdr message{};
  message.msg_iov = &piece;
  message.msg_iovlen = 1;
  message.msg_control = room.data();
  message.msg_controllen = room.size();
  const ssize_t count = ::recvmsg(fd(), &message, MSG_DONTWAIT);
  if (count < 0) {
    if (errno != EAGAIN && errno != EINTR) leave(errno);
    return false;
  }
  const MessageNotes notes = notes_of(message, clock_);
  if (notes.lost) counts_.kernel_overflow += losses_.since(*notes.lost);
  const auto frame = can_frame_of(std::span(wire).first(static_cast<std::size_t>(count)), kNever);
  if (!frame || (message.msg_flags & MSG_TRUNC) != 0) {
    ++counts_.cut;
    return true;
  }
  note(*frame);
  if (!notes.received) ++counts_.no_stamp;  // the first frame after stamps were asked for may carry none
  reopening_.works();
  ++counts_.chunks;
  counts_.bytes += kCanWireBytes;
  sink.take({notes.received.value_or(clock_.now()), {}, config_.channel, wire});
  return true;
}

void CanSocket::note(const CanFrame& frame) {
  const bool error = frame.kind == CanKind::error;
  const CanTrouble trouble = error ? trouble_of(frame) : CanTrouble{};
  counts_.error_frames += error;
  counts_.error_passive += trouble.passive;
  counts_.bus_off += trouble.bus_off;
  if (bus_off_ && (!error || trouble.back)) {
    bus_off_ = false;
    ++counts_.bus_back;
  }
  if (trouble.bus_off) bus_off_ = true;
}

// ENETDOWN: taken down; ENODEV: the adapter is gone.
void CanSocket::leave(int cause) {
  socket_.reset();
  trouble_ = std::strerror(cause);
  ++counts_.departures;
  reopening_.failed(clock_.now());
}

}  // namespace lxd
