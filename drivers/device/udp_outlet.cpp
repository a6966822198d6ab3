// SPDX-License-Identifier: Apache-2.0
#include "drivers/device/udp_outlet.hpp"

#include <cerrno>
#include <charconv>
#include <cstring>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <sys/socket.h>

#include "drivers/device/ipv4.hpp"

namespace lxd {

Result<UdpEndpoint> parse_endpoint(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  UdpEndpoint endpoint;
  const auto address = parse_ipv4(text.substr(0, colon));
  const char* const end = text.data() + text.size();
  const char* const port = colon == std::string::npos ? end : text.data() + colon + 1;
  const auto [rest, failed] = std::from_chars(port, end, endpoint.port);
  if (!address || failed != std::errc() || rest != end || endpoint.port == 0)
    return Error{fmt::format("found '{}', wanted an IPv4 address and a port, such as 127.0.0.1:4711", text)};
  endpoint.address = *address;
  return endpoint;
}

Result<UdpOutlet> UdpOutlet::open(const UdpEndpoint& to) {
  UdpOutlet outlet;
  outlet.socket_ = FileDescriptor(::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  sockaddr_in end{};
  end.sin_family = AF_INET;
  end.sin_addr.s_addr = htonl(to.address);
  end.sin_port = htons(to.port);
  if (::connect(outlet.socket_.get(), reinterpret_cast<const sockaddr*>(&end), sizeof(end)) != 0)
    return Error{fmt::format("no way to {}:{}: {}", ipv4_text(to.address), to.port, std::strerror(errno))};
  return outlet;
}

void UdpOutlet::send(std::span<const std::uint8_t> datagram) noexcept {
  const bool gone = ::send(socket_.get(), datagram.data(), datagram.size(), 0) == std::ssize(datagram);
  ++(gone ? sent_ : unheard_);
}

}  // namespace lxd
