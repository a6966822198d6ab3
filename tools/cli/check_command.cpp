// SPDX-License-Identifier: Apache-2.0
// `lxd-slam check`: what is wrong with a rig file, all of it at once.
#include <memory>
#include <string>

#include <fmt/format.h>

#include "board/rig_file.hpp"
#include "board/settings.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/exit_status.hpp"

namespace lxd {
namespace {

struct CheckOptions {
  std::string rig;
  bool settings = false;
};

std::string sensors_of(const Rig& rig) {
  std::string names = "lidar0";
  if (rig.lidar1) names += " lidar1";
  if (rig.camera0) names += " camera0";
  if (rig.imu) names += " imu";
  if (rig.wheel) names += " wheel";
  if (rig.gnss) names += " gnss";
  return names;
}

int check_rig(const std::string& path) {
  const RigFile file = load_rig(path);
  for (const std::string& remark : file.remarks) fmt::print("note: {}\n", remark);
  if (file.ok()) {
    fmt::print("{}: good: {}; the path is that of {}\n", path, sensors_of(file.rig), file.rig.reference);
    return exit_status::kDone;
  }
  fmt::print("{}\n", text_of(file.problems));
  fmt::print(stderr, "lxd-slam check: {} problem{}\n", file.problems.size(), file.problems.size() == 1 ? "" : "s");
  return exit_status::kBadUsage;
}

int run_check(const CheckOptions& options) {
  if (options.settings) fmt::print("{}", settings_reference());
  return options.rig.empty() ? exit_status::kDone : check_rig(options.rig);
}

}  // namespace

void add_check_command(CLI::App& app, int& exit_status) {
  const auto options = std::make_shared<CheckOptions>();
  CLI::App* const command = app.add_subcommand("check", "Say what is wrong with a rig file, all of it at once");
  CLI::Option* const rig = command->add_option("rig", options->rig, "The rig file")->type_name("RIG.yaml");
  CLI::Option* const settings =
      command->add_flag("--settings", options->settings,
                        "List every setting with its default and range: for --set and the rig's `settings`");
  command->callback([=, &exit_status] {
    if (rig->count() == 0 && settings->count() == 0) throw CLI::RequiredError("RIG.yaml");
    exit_status = run_check(*options);
  });
}

}  // namespace lxd
