// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/program.hpp"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "tools/cli/commands.hpp"
#include "tools/cli/companion.hpp"
#include "tools/cli/exit_status.hpp"
#include "tools/cli/say.hpp"

namespace lxd {
namespace {

constexpr const char* kAbout =
    "Dense LiDAR SLAM: sweeps in, a path and a mesh with its uncertainty out.\n"
    "Exit status: 0 done, 1 failed at run time, 2 bad usage, rig or recording.";

void add_all_commands(CLI::App& app, int& status) {
  add_run_command(app, status);
  add_record_command(app, status);
  add_replay_command(app, status);
  add_evaluate_command(app, status);
  add_export_command(app, status);
  add_check_command(app, status);
  add_budget_command(app, status);
  add_doctor_command(app, status);
  for (const Companion& companion : companions()) app.add_subcommand(std::string(companion.command), companion.about);
}

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands(nullptr)) names.push_back(command->get_name());
  return names;
}

// Whether the first argument stands where a command is due but is none; CLI11 would only say that one is missing.
bool is_unknown_command(std::string_view word, std::span<const std::string> names) {
  return !word.starts_with('-') && std::ranges::find(names, word) == names.end();
}

int refuse(std::string_view word, std::span<const std::string> names) {
  say("lxd-slam: found the command '{}', wanted one of {}\n", word, fmt::join(names, ", "));
  return exit_status::kBadUsage;
}

int parse_and_run(CLI::App& app, int argc, const char* const* argv, const int& status) {
  const std::vector<std::string> names = command_names(app);
  if (argc > 1 && is_unknown_command(argv[1], names)) return refuse(argv[1], names);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked_for_help) {
    return app.exit(asked_for_help);
  } catch (const CLI::ParseError& wrong) {
    app.exit(wrong);
    return exit_status::kBadUsage;
  }
  return status;
}

// A script must not take half of what was printed for all of it.
int delivered(int status) {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return status;
  say("lxd-slam: standard output: cannot be written\n");
  return status == exit_status::kDone ? exit_status::kFailed : status;
}

}  // namespace

int run_program(int argc, const char* const* argv) {
  if (const auto status = become_companion(argc, argv)) return *status;
  return run_program(argc, argv, add_all_commands);
}

int run_program(int argc, const char* const* argv, AddCommands add_commands) {
  try {
    int status = exit_status::kDone;
    CLI::App app(kAbout, "lxd-slam");
    app.set_version_flag("--version", LXD_VERSION);
    app.require_subcommand(1);
    add_commands(app, status);
    return delivered(parse_and_run(app, argc, argv, status));
  } catch (const std::exception& e) {
    say("lxd-slam: {}\n", e.what());
    return delivered(exit_status::kFailed);
  }
}

}  // namespace lxd
