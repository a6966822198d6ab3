// SPDX-License-Identifier: Apache-2.0
// Commands that are programs of their own, beside lxd-slam.
#pragma once

#include <optional>
#include <span>
#include <string_view>

namespace lxd {

struct Companion {
  std::string_view command;
  const char* about;    // in the help
  const char* program;  // beside lxd-slam
  const char* wanted;   // what to do when it is not there
};

std::span<const Companion> companions();

// Where the first argument is the command of a companion, becomes that program, with the same arguments. Returns only
// when it is none, or is not there: then the exit status.
std::optional<int> become_companion(int argc, const char* const* argv);

}  // namespace lxd
