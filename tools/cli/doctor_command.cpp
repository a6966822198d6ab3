// SPDX-License-Identifier: Apache-2.0
// `lxd-slam doctor`: what this machine lacks for real time, and how to mend it.
#include <algorithm>

#include <fmt/format.h>

#include "board/doctor/diagnosis.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/exit_status.hpp"

namespace lxd {
namespace {

int run_doctor() {
  const std::vector<Finding> findings = diagnose(read_machine_facts("/"), needs_of_this_profile());
  fmt::print("{}", diagnosis_text(findings));
  const bool lacking = std::ranges::find(findings, Verdict::lack, &Finding::verdict) != findings.end();
  return lacking ? exit_status::kFailed : exit_status::kDone;
}

}  // namespace

void add_doctor_command(CLI::App& app, int& exit_status) {
  CLI::App* const command = app.add_subcommand(
      "doctor", "Say what this machine lacks for real time, and how to mend it (status 1: something)");
  command->callback([&exit_status] { exit_status = run_doctor(); });
}

}  // namespace lxd
