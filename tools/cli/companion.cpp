// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/companion.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include <unistd.h>

#include "tools/cli/exit_status.hpp"
#include "tools/cli/say.hpp"

namespace lxd {
namespace {

constexpr std::array<Companion, 2> kCompanions{
    {{"simulate", "Make a recording of a simulated rig, with exact truth", "lxd-slam-simulate",
      "wanted the simulator beside the program (a build without LXD_SIMULATOR has none)"},
     {"import", "Turn bags of ROS 1 into a folder that replay runs", "lxd-slam-import",
      "wanted the importer beside the program: install librosbag-storage-dev, configure and build again"}}};

}  // namespace

std::span<const Companion> companions() { return kCompanions; }

std::optional<int> become_companion(int argc, const char* const* argv) {
  const auto* const companion =
      argc > 1 ? std::ranges::find(kCompanions, std::string_view(argv[1]), &Companion::command) : kCompanions.end();
  if (companion == kCompanions.end()) return std::nullopt;
  std::error_code error;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
  const std::filesystem::path program = self.parent_path() / companion->program;
  execv(program.c_str(), const_cast<char* const*>(argv));  // does not change them: execve(2), rationale
  say("lxd-slam {}: {}: {}; {}\n", companion->command, program.string(), std::strerror(errno), companion->wanted);
  return exit_status::kFailed;
}

}  // namespace lxd
