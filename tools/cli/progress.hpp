// SPDX-License-Identifier: Apache-2.0
// How a replay shows that it goes on: one line that is rewritten on a terminal, a plain line every few seconds
// elsewhere.
#pragma once

#include <chrono>
#include <cstdio>
#include <string>

#include "board/replay_system.hpp"

namespace lxd {

// "sweep 120/154  35.2/s  3.5x real time  dropped 0  left 1 s"
std::string progress_line(const ReplayProgress& progress);

class ProgressDisplay {
 public:
  explicit ProgressDisplay(std::FILE* out);

  void show(const ReplayProgress& progress);  // writes only when its time has come
  void finish();                              // the last state, and the end of the line

 private:
  using Clock = std::chrono::steady_clock;
  void write(const ReplayProgress& progress);

  std::FILE* out_;
  bool terminal_;
  Clock::time_point next_;
  ReplayProgress last_;
};

}  // namespace lxd
