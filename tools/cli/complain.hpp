// SPDX-License-Identifier: Apache-2.0
// How a command ends in an error: one line that names the command, and the status it exits with.
#pragma once

#include <string_view>

#include "rt/result.hpp"
#include "tools/cli/say.hpp"

namespace lxd {

[[nodiscard]] inline int complain(std::string_view command, const Error& error, int status) {
  say("lxd-slam {}: {}\n", command, error.message);
  return status;
}

}  // namespace lxd
