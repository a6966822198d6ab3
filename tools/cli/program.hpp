// SPDX-License-Identifier: Apache-2.0
// The command-line program: reads the arguments, runs one command, returns the process's exit status.
#pragma once

namespace lxd {

int run_program(int argc, const char* const* argv);

}  // namespace lxd
