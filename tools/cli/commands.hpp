// SPDX-License-Identifier: Apache-2.0
// The commands of lxd-slam, one source file each. An add function describes the command's options to `app`; when the
// command is chosen it runs and leaves its status in `exit_status`, which must outlive the parsing.
#pragma once

#include <CLI/CLI.hpp>

namespace lxd {

void add_run_command(CLI::App& app, int& exit_status);
void add_record_command(CLI::App& app, int& exit_status);
void add_replay_command(CLI::App& app, int& exit_status);
void add_evaluate_command(CLI::App& app, int& exit_status);
void add_export_command(CLI::App& app, int& exit_status);
void add_check_command(CLI::App& app, int& exit_status);
void add_simulate_command(CLI::App& app, int& exit_status);
void add_import_command(CLI::App& app, int& exit_status);
void add_budget_command(CLI::App& app, int& exit_status);
void add_doctor_command(CLI::App& app, int& exit_status);

}  // namespace lxd
