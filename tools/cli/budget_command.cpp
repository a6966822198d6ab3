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

// A rig with every sensor, which takes the most.
Configuration fullest() {
  Configuration configuration;
  configuration.sensors = {.extra_lidar = true, .camera = true, .imu = true, .wheel = true, .gnss = true};
  Rig& rig = configuration.rig;
  rig.lidar1.emplace();
  rig.camera0.emplace();
  rig.imu.emplace();
  rig.wheel.emplace();
  rig.gnss.emplace();
  return configuration;
}

int run_budget(bool json) {
  Arena arena = static_arena();
  const Configuration configuration = fullest();
  const SlamCore core(configuration, resolve_star(configuration.rig, configuration.sensors).value(), arena);
  fmt::print("{}", json ? budget_json(arena) : budget_table(arena));
  if (!arena.exhausted()) return exit_status::kDone;
  fmt::print(stderr, "lxd-slam budget: {} bytes are wanted, the profile has {}\n", arena.wanted_bytes(),
             arena.capacity_bytes());
  return exit_status::kFailed;
}

}  // namespace

void add_budget_command(CLI::App& app, int& exit_status) {
  const auto json = std::make_shared<bool>(false);
  CLI::App* const command = app.add_subcommand("budget", "Print the static memory table, of a rig with every sensor");
  command->add_flag("--json", *json, "For programs");
  command->callback([=, &exit_status] { exit_status = run_budget(*json); });
}

}  // namespace lxd
