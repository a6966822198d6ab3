// SPDX-License-Identifier: Apache-2.0
// Datagrams to one receiver, without ever waiting for it.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "drivers/device/file_descriptor.hpp"
#include "rt/result.hpp"

namespace lxd {

struct UdpEndpoint {
  std::uint32_t address = 0;  // IPv4, host byte order
  std::uint16_t port = 0;
};

// "192.168.1.5:4711". Error: what was found and what is wanted.
Result<UdpEndpoint> parse_endpoint(const std::string& text);

class UdpOutlet {
 public:
  // Error: there is no way to that address.
  static Result<UdpOutlet> open(const UdpEndpoint& to);

  // One thread; no allocation. What the kernel has no room for, or nobody hears, is gone and counted.
  void send(std::span<const std::uint8_t> datagram) noexcept;

  [[nodiscard]] std::uint64_t sent() const { return sent_; }
  [[nodiscard]] std::uint64_t unheard() const { return unheard_; }

 private:
  FileDescriptor socket_;
  std::uint64_t sent_ = 0, unheard_ = 0;
};

}  // namespace lxd
