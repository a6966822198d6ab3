// SPDX-License-Identifier: Apache-2.0
// Puts frames onto a CAN bus, as another of its nodes.
#pragma once

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>

#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "drivers/device/file_descriptor.hpp"
#include "drivers/wheel/can_frame.hpp"

namespace lxd::hil {

class CanSender {
 public:
  explicit CanSender(const std::string& interface) : socket_(::socket(PF_CAN, SOCK_RAW, CAN_RAW)) {
    sockaddr_can here{};
    here.can_family = AF_CAN;
    here.can_ifindex = static_cast<int>(::if_nametoindex(interface.c_str()));
    if (here.can_ifindex == 0 || ::bind(socket_.get(), reinterpret_cast<const sockaddr*>(&here), sizeof here) != 0)
      throw std::runtime_error(interface + " is not there");
  }

  // Waits while the bus is busy or down; that it was down meanwhile, the kernel tells once.
  void send(const CanFrame& frame) const {
    can_frame wire{};
    wire.can_id = frame.id | (frame.extended ? CAN_EFF_FLAG : 0U);
    wire.can_dlc = frame.length;
    std::memcpy(wire.data, frame.data.data(), frame.data.size());
    while (::write(socket_.get(), &wire, sizeof wire) < 0) {
      if (errno != ENOBUFS && errno != ENETDOWN)
        throw std::runtime_error(std::string("a CAN frame was not sent: ") + std::strerror(errno));
      ::poll(nullptr, 0, 1);
    }
  }

  // A frame of eight bytes, of which the first four are the number.
  void send(std::uint32_t id, std::uint32_t number) const {
    CanFrame frame;
    frame.id = id;
    frame.length = CAN_MAX_DLEN;
    std::memcpy(frame.data.data(), &number, sizeof number);
    send(frame);
  }

 private:
  FileDescriptor socket_;
};

}  // namespace lxd::hil
