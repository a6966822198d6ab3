// SPDX-License-Identifier: Apache-2.0
// How long work shows that it goes on: one line that is rewritten on a terminal, a plain line every few seconds
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

  void show(std::string line);  // is written only when its time has come
  void finish();                // the last line, and its end

 private:
  using Clock = std::chrono::steady_clock;
  void write() const;

  std::FILE* out_;
  bool terminal_;
  Clock::time_point next_;
  std::string last_;
};

}  // namespace lxd
