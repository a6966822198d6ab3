// SPDX-License-Identifier: Apache-2.0
#include "drivers/device/receive_stamp.hpp"

#include <cstring>
#include <ctime>

#include <arpa/inet.h>
#include <netinet/in.h>

namespace lxd {
namespace {

template <typename Value>
Value value_of(const cmsghdr& header) {
  Value value{};
  std::memcpy(&value, CMSG_DATA(&header), sizeof(value));
  return value;
}

RigTime stamp_of(const timespec& stamp, const HostClock& clock) {
  return clock.of_realtime(std::int64_t{stamp.tv_sec} * kNanosPerSecond + stamp.tv_nsec);
}

}  // namespace

MessageNotes notes_of(const msghdr& message, const HostClock& clock) {
  MessageNotes notes;
  auto* const at = const_cast<msghdr*>(&message);  // the macros do not change it: cmsg(3)
  for (cmsghdr* header = CMSG_FIRSTHDR(at); header != nullptr; header = CMSG_NXTHDR(at, header)) {
    if (header->cmsg_level == IPPROTO_IP && header->cmsg_type == IP_PKTINFO)
      notes.destination_address = ntohl(value_of<in_pktinfo>(*header).ipi_addr.s_addr);
    if (header->cmsg_level != SOL_SOCKET) continue;
    if (header->cmsg_type == SCM_TIMESTAMPNS) notes.received = stamp_of(value_of<timespec>(*header), clock);
    if (header->cmsg_type == SO_RXQ_OVFL) notes.lost = value_of<std::uint32_t>(*header);
  }
  return notes;
}

bool ask_for_notes(int socket) {
  const int on = 1;
  (void)::setsockopt(socket, SOL_SOCKET, SO_RXQ_OVFL, &on, sizeof(on));  // where it is not known nothing is counted
  (void)::setsockopt(socket, IPPROTO_IP, IP_PKTINFO, &on, sizeof(on));   // only datagrams have it
  return ::setsockopt(socket, SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof(on)) == 0;
}

}  // namespace lxd
