// SPDX-License-Identifier: Apache-2.0
// Entry of lxd-slam. The program itself is in tools/cli/program.cpp, where tests can reach it.
#include "tools/cli/program.hpp"

int main(int argc, char** argv) { return lxd::run_program(argc, argv); }
