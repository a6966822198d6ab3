// SPDX-License-Identifier: Apache-2.0
// The command-line program: reads the arguments, runs one command, returns the process's exit status.
#pragma once

#include <CLI/CLI.hpp>

namespace lxd {

// lxd-slam.
int run_program(int argc, const char* const* argv);

// A program of the commands that `add_commands` adds; they leave their exit status in its second argument.
using AddCommands = void (*)(CLI::App& app, int& exit_status);
int run_program(int argc, const char* const* argv, AddCommands add_commands);

}  // namespace lxd
