// SPDX-License-Identifier: Apache-2.0
// IPv4 addresses as people write them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace lxd {

// "192.168.1.10" in host byte order; nothing: no such address.
std::optional<std::uint32_t> parse_ipv4(const std::string& text);
std::string ipv4_text(std::uint32_t address);

// 224.0.0.0 to 239.255.255.255 (RFC 5771).
constexpr bool is_multicast(std::uint32_t address) { return address >> 28U == 0xEU; }

}  // namespace lxd
