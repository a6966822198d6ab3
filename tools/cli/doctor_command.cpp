// SPDX-License-Identifier: Apache-2.0
// `lxd-slam doctor`: what this machine lacks for real time, and how to mend it.
#include <algorithm>
#include <iterator>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "board/doctor/diagnosis.hpp"
#include "board/doctor/rig_devices.hpp"
#include "board/rig_file.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/exit_status.hpp"
#include "tools/cli/say.hpp"

namespace lxd {
namespace {

int run_doctor(const std::string& rig) {
  std::vector<Finding> findings = diagnose(read_machine_facts("/"), needs_of_this_profile());
  if (!rig.empty()) {
    const RigFile file = load_rig(rig);
    if (!file.ok()) {
      say("lxd-slam doctor: {}\n", text_of(file.problems));
      return exit_status::kBadUsage;
    }
    std::ranges::move(diagnose_devices(file.rig, "/"), std::back_inserter(findings));
  }
  fmt::print("{}", diagnosis_text(findings));
  const bool lacking = std::ranges::find(findings, Verdict::lack, &Finding::verdict) != findings.end();
  return lacking ? exit_status::kFailed : exit_status::kDone;
}

}  // namespace

void add_doctor_command(CLI::App& app, int& exit_status) {
  CLI::App* const command = app.add_subcommand(
      "doctor", "Say what this machine lacks for real time, and how to mend it (status 1: something)");
  const auto rig = std::make_shared<std::string>();
  command->add_option("--rig", *rig, "Look for the devices that this rig file names, too")->type_name("RIG.yaml");
  command->callback([=, &exit_status] { exit_status = run_doctor(*rig); });
}

}  // namespace lxd
