// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/program.hpp"

#include <exception>
#include <string>

#include <fmt/format.h>

#include "tools/cli/commands.hpp"
#include "tools/cli/exit_status.hpp"

namespace lxd {
namespace {

constexpr const char* kAbout =
    "Dense LiDAR SLAM: sweeps in, a path and a mesh with its uncertainty out.\n"
    "Exit status: 0 done, 1 failed at run time, 2 bad usage, rig or recording.";

void add_commands(CLI::App& app, int& status) {
  add_replay_command(app, status);
  add_evaluate_command(app, status);
  add_export_command(app, status);
  add_check_command(app, status);
  add_budget_command(app, status);
}

// The first argument where a command is due but none of that name exists; CLI11 would only say that one is missing.
std::string unknown_command(const CLI::App& app, int argc, const char* const* argv) {
  if (argc < 2 || argv[1][0] == '-') return {};
  return app.get_subcommand_no_throw(argv[1]) == nullptr ? argv[1] : "";
}

std::string command_names(const CLI::App& app) {
  std::string names;
  for (const CLI::App* command : app.get_subcommands(nullptr)) {
    if (!names.empty()) names += ", ";
    names += command->get_name();
  }
  return names;
}

int parse_and_run(CLI::App& app, int argc, const char* const* argv, const int& status) {
  const std::string unknown = unknown_command(app, argc, argv);
  if (!unknown.empty()) {
    fmt::print(stderr, "lxd-slam: found the command '{}', wanted one of {}\n", unknown, command_names(app));
    return exit_status::kBadUsage;
  }
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

}  // namespace

int run_program(int argc, const char* const* argv) {
  try {
    int status = exit_status::kDone;
    CLI::App app(kAbout, "lxd-slam");
    app.set_version_flag("--version", LXD_VERSION);
    app.require_subcommand(1);
    add_commands(app, status);
    return parse_and_run(app, argc, argv, status);
  } catch (const std::exception& e) {
    fmt::print(stderr, "lxd-slam: {}\n", e.what());
    return exit_status::kFailed;
  }
}

}  // namespace lxd
