// SPDX-License-Identifier: Apache-2.0
// One HTTP request to a sensor, while loading: with a deadline for all of it, and no more than was asked for.
#pragma once

#include <cstdint>
#include <string>

#include "rt/result.hpp"
#include "rt/time.hpp"

namespace lxd {

struct HttpTarget {
  std::string address;  // IPv4 or IPv6, no name: resolving has no deadline
  std::uint16_t port = 80;
};

struct HttpAnswer {
  int status = 0;    // 200, 404, …
  std::string body;  // whole
};

// GET of a path that begins with '/'. Errors name the target and what failed: no connection, no answer in time, an
// answer that is no HTTP, longer than `bytes_max`, or cut off. Another status than 200 is an answer.
Result<HttpAnswer> http_get(const HttpTarget& target, const std::string& path, Duration deadline,
                            std::size_t bytes_max = std::size_t{1} << 20U);

}  // namespace lxd
