// SPDX-License-Identifier: Apache-2.0
// `lxd-slam budget`: the static memory table, made by making the system.
#include <memory>

#include <fmt/format.h>

#include "board/memory.hpp"
#include "board/slam_core.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/exit_status.hpp"

namespace lxd {
namespace {

int run_budget(bool json) {
  Arena arena = static_arena();
  const SlamCore core(Configuration{}, Star{}, arena);
  fmt::print("{}", json ? budget_json(arena) : budget_table(arena));
  if (!arena.exhausted()) return exit_status::kDone;
  fmt::print(stderr, "lxd-slam budget: {} bytes are wanted, the profile has {}\n", arena.wanted_bytes(),
             arena.capacity_bytes());
  return exit_status::kFailed;
}

}  // namespace

void add_budget_command(CLI::App& app, int& exit_status) {
  const auto json = std::make_shared<bool>(false);
  CLI::App* const command = app.add_subcommand("budget", "Print the static memory table");
  command->add_flag("--json", *json, "For programs");
  command->callback([=, &exit_status] { exit_status = run_budget(*json); });
}

}  // namespace lxd
