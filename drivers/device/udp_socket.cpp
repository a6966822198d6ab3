// SPDX-License-Identifier: Apache-2.0
#include "drivers/device/udp_socket.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include "drivers/device/file_descriptor.hpp"
#include "drivers/device/receive_stamp.hpp"

namespace lxd {
namespace {

constexpr int kBatch = 16;  // datagrams a system call

sockaddr_in address_of(std::uint32_t address, std::uint16_t port) {
  sockaddr_in end{};
  end.sin_family = AF_INET;
  end.sin_addr.s_addr = htonl(address);
  end.sin_port = htons(port);
  return end;
}

sockaddr* generic(sockaddr_in& end) { return reinterpret_cast<sockaddr*>(&end); }

}  // namespace

struct UdpSocket::Batch {
  explicit Batch(std::size_t datagram_max) : storage(kBatch * datagram_max) {
    for (std::size_t i = 0; i < kBatch; ++i) {
      pieces[i] = {storage.data() + i * datagram_max, datagram_max};
      messages[i].msg_hdr.msg_iov = &pieces[i];
      messages[i].msg_hdr.msg_iovlen = 1;
      messages[i].msg_hdr.msg_name = &senders[i];
      messages[i].msg_hdr.msg_control = notes[i].data();
    }
  }

  // Whose lengths the kernel has changed.
  void make_ready() {
    for (mmsghdr& message : messages) {
      message.msg_hdr.msg_namelen = sizeof(sockaddr_in);
      message.msg_hdr.msg_controllen = kMessageNotesBytes;
    }
  }

  FileDescriptor socket;
  LossCount losses;
  std::vector<std::uint8_t> storage;
  std::array<iovec, kBatch> pieces{};
  std::array<mmsghdr, kBatch> messages{};
  std::array<sockaddr_in, kBatch> senders{};
  alignas(cmsghdr) std::array<std::array<std::uint8_t, kMessageNotesBytes>, kBatch> notes{};
};

UdpSocket::UdpSocket(const UdpConfig& config, const HostClock& clock)
    : config_(config), clock_(clock), batch_(std::make_unique<Batch>(config.datagram_max)) {}

UdpSocket::~UdpSocket() = default;

Result<std::unique_ptr<UdpSocket>> UdpSocket::open(const UdpConfig& config, const HostClock& clock) {
  std::unique_ptr<UdpSocket> socket(new UdpSocket(config, clock));
  const Status started = socket->start();
  if (!started) return Error{fmt::format("udp port {}: {}", config.port, started.error().message)};
  return socket;
}

int UdpSocket::fd() const { return batch_->socket.get(); }

Status UdpSocket::start() {
  batch_->socket = FileDescriptor(::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (!batch_->socket) return Error{fmt::format("found no socket: {}", std::strerror(errno))};
  const int on = 1;
  // Others may listen to a group too; a sensor's own port has one listener.
  if (config_.multicast_group != 0) (void)::setsockopt(fd(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
  sockaddr_in end = address_of(INADDR_ANY, config_.port);
  if (::bind(fd(), generic(end), sizeof(end)) != 0)
    return Error{fmt::format("cannot be listened to: {}", std::strerror(errno))};
  socklen_t bytes = sizeof(end);
  ::getsockname(fd(), generic(end), &bytes);
  port_ = ntohs(end.sin_port);
  name_ = fmt::format("udp {}", port_);
  ask_for_buffer();
  (void)ask_for_notes(fd());
  ++counts_.openings;
  return join();
}

// The first needs CAP_NET_ADMIN, the second keeps to net.core.rmem_max. The kernel doubles what it is asked for, and
// says so; half of it is for its own records.
void UdpSocket::ask_for_buffer() {
  const int wanted = static_cast<int>(config_.receive_buffer_bytes);
  if (::setsockopt(fd(), SOL_SOCKET, SO_RCVBUFFORCE, &wanted, sizeof(wanted)) != 0)
    (void)::setsockopt(fd(), SOL_SOCKET, SO_RCVBUF, &wanted, sizeof(wanted));
  int granted = 0;
  socklen_t bytes = sizeof(granted);
  ::getsockopt(fd(), SOL_SOCKET, SO_RCVBUF, &granted, &bytes);
  granted_bytes_ = static_cast<std::size_t>(granted) / 2;
}

Status UdpSocket::join() {
  if (config_.multicast_group == 0) return success();
  ip_mreqn group{};
  group.imr_multiaddr.s_addr = htonl(config_.multicast_group);
  if (::setsockopt(fd(), IPPROTO_IP, IP_ADD_MEMBERSHIP, &group, sizeof(group)) == 0) return success();
  return Error{fmt::format("the multicast group cannot be joined: {}", std::strerror(errno))};
}

void UdpSocket::read(ChunkSink& sink) {
  for (int read = 0; read < kChunksPerRead;) {
    batch_->make_ready();
    const int count = ::recvmmsg(fd(), batch_->messages.data(), kBatch, MSG_DONTWAIT, nullptr);
    if (count <= 0) {
      if (count < 0 && errno != EAGAIN && errno != EINTR) ++counts_.read_errors;
      return;
    }
    for (int i = 0; i < count; ++i) deliver(i, sink);
    if (count < kBatch) return;
    read += count;
  }
}

void UdpSocket::deliver(int i, ChunkSink& sink) {
  const auto at = static_cast<std::size_t>(i);
  const mmsghdr& message = batch_->messages[at];
  const MessageNotes notes = notes_of(message.msg_hdr, clock_);
  if (notes.lost) counts_.kernel_overflow += batch_->losses.since(*notes.lost);
  const std::uint32_t address = ntohl(batch_->senders[at].sin_addr.s_addr);
  const UdpSource* const source = source_of(address);
  if (source == nullptr) {
    ++counts_.foreign;
    return;
  }
  if ((message.msg_hdr.msg_flags & MSG_TRUNC) != 0) {
    ++counts_.cut;
    return;
  }
  if (!notes.received) ++counts_.no_stamp;
  ++counts_.chunks;
  counts_.bytes += message.msg_len;
  sink.take({notes.received.value_or(clock_.now()),
             {address, notes.destination_address, ntohs(batch_->senders[at].sin_port), port_},
             source->channel,
             {static_cast<const std::uint8_t*>(batch_->pieces[at].iov_base), message.msg_len}});
}

const UdpSource* UdpSocket::source_of(std::uint32_t address) const {
  const auto named = std::ranges::find(config_.sources, address, &UdpSource::address);
  const auto found =
      named != config_.sources.end() ? named : std::ranges::find(config_.sources, 0U, &UdpSource::address);
  return found == config_.sources.end() ? nullptr : &*found;
}

}  // namespace lxd
