// SPDX-License-Identifier: Apache-2.0
// Entry of lxd-slam-import, which `lxd-slam import` becomes.
#include "tools/cli/commands.hpp"
#include "tools/cli/program.hpp"

int main(int argc, char** argv) { return lxd::run_program(argc, argv, lxd::add_import_command); }
