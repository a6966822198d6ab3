// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/companion.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>

#include <unistd.h>

#include "tools/cli/exit_status.hpp"
#include "tools/cli/say.hpp"

namespace lxd {

int become_simulator(const char* const* argv) {
  std::error_code error;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
  const std::filesystem::path simulator = self.parent_path() / "lxd-slam-simulate";
  execv(simulator.c_str(), const_cast<char* const*>(argv));  // does not change them: execve(2), rationale
  say("lxd-slam simulate: {}: {}; wanted the simulator beside the program (a build without LXD_SIMULATOR has none)\n",
      simulator.string(), std::strerror(errno));
  return exit_status::kFailed;
}

}  // namespace lxd
