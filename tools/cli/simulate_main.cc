// SPDX-License-Identifier: Apache-2.0
// Entry of lxd-slam-simulate, which `lxd-slam simulate` becomes.
#include "tools/cli/commands.hpp"
#include "tools/cli/program.hpp"

int main(int argc, char** argv) { return lxd::run_program(argc, argv, lxd::add_simulate_command); }
