// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/progress.hpp"

#include <utility>

#include <fmt/format.h>
#include <unistd.h>

namespace lxd {
namespace {

constexpr std::chrono::milliseconds kTerminalPeriod{100};
constexpr std::chrono::milliseconds kPlainPeriod{5000};

double ratio(double a, double b) { return b > 0 ? a / b : 0; }

}  // namespace

std::string progress_line(const ReplayProgress& progress) {
  const auto sweeps = static_cast<double>(progress.sweeps);
  const double rate = ratio(sweeps, progress.elapsed_s);
  std::string line = fmt::format("sweep {}", progress.sweeps);
  if (progress.total) line += fmt::format("/{}", *progress.total);
  line += fmt::format("  {:.1f}/s  {:.1f}x real time  dropped {}", rate, ratio(progress.recorded_s, progress.elapsed_s),
                      progress.dropped);
  if (progress.untracked > 0) line += fmt::format("  untracked {}", progress.untracked);
  const double left =
      progress.total ? static_cast<double>(*progress.total) - sweeps - static_cast<double>(progress.dropped) : 0;
  if (left > 0 && rate > 0) line += fmt::format("  left {:.0f} s", left / rate);
  return line;
}

ProgressDisplay::ProgressDisplay(std::FILE* out)
    : out_(out),
      terminal_(isatty(fileno(out)) == 1),
      next_(Clock::now() + (terminal_ ? kTerminalPeriod : kPlainPeriod)) {}

void ProgressDisplay::show(std::string line) {
  last_ = std::move(line);
  const Clock::time_point now = Clock::now();
  if (now < next_) return;
  next_ = now + (terminal_ ? kTerminalPeriod : kPlainPeriod);
  write();
}

void ProgressDisplay::finish() {
  write();
  if (terminal_) (void)std::fputs("\n", out_);
}

void ProgressDisplay::write() const {
  constexpr const char* kRewrite = "\r\x1b[K";  // to the line's start, and clear it
  // Not fmt::print, which throws where `out_` is full: progress is not worth a run.
  (void)std::fputs(fmt::format("{}{}{}", terminal_ ? kRewrite : "", last_, terminal_ ? "" : "\n").c_str(), out_);
  std::fflush(out_);
}

}  // namespace lxd
