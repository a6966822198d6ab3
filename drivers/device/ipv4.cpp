// SPDX-License-Identifier: Apache-2.0
#include "drivers/device/ipv4.hpp"

#include <array>

#include <arpa/inet.h>

namespace lxd {

std::optional<std::uint32_t> parse_ipv4(const std::string& text) {
  in_addr address{};
  if (::inet_pton(AF_INET, text.c_str(), &address) != 1) return std::nullopt;
  return ntohl(address.s_addr);
}

std::string ipv4_text(std::uint32_t address) {
  std::array<char, INET_ADDRSTRLEN> text{};
  const in_addr wire{htonl(address)};
  ::inet_ntop(AF_INET, &wire, text.data(), text.size());
  return text.data();
}

}  // namespace lxd
