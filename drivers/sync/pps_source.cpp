// SPDX-License-Identifier: Apache-2.0
// See pps_source.hpp. Source: linux/pps.h (RFC 2783). Stamps are those of CLOCK_REALTIME.
#include "drivers/sync/pps_source.hpp"

#include <cerrno>
#include <cstring>
#include <utility>

#include <fmt/format.h>
#include <linux/pps.h>

namespace lxd {

PpsSource::PpsSource(std::string path, Edge edge, const HostClock& clock, SystemCalls& calls)
    : path_(std::move(path)), edge_(edge), clock_(clock), calls_(calls) {}

void PpsSource::close() {
  if (fd_ >= 0) calls_.close(std::exchange(fd_, -1));
}

void PpsSource::leave(int cause) {
  close();
  trouble_ = fmt::format("{}: {}", path_, std::strerror(cause));
  ++counts_.departures;
}

void PpsSource::tend(RigTime now) {
  if (there() || !reopening_.due(now)) return;
  if (const Status opened = open(); !opened) {
    close();
    trouble_ = opened.error().message;
    reopening_.failed(now);
    return;
  }
  trouble_.clear();
  ++counts_.openings;
}

Status PpsSource::open() {
  fd_ = calls_.open(path_);
  if (fd_ < 0) return Error{fmt::format("{}: cannot be opened: {}", path_, std::strerror(errno))};
  if (const Status able = check_edge(); !able) return able;
  // A pulse that was there before we came may be old: it only begins the count.
  PpsPulse newest;
  bool sound = false;
  if (const int failed = ask(Duration::from_ns(0), newest, sound); failed != 0 && failed != ETIMEDOUT)
    return Error{fmt::format("{}: PPS_FETCH: {}", path_, std::strerror(failed))};
  last_ = newest.sequence;
  return success();
}

// Sources stamp the assert edge by default; the other must be asked for.
Status PpsSource::check_edge() {
  const int wanted = edge_ == Edge::assert ? PPS_CAPTUREASSERT : PPS_CAPTURECLEAR;
  int able = 0;
  if (calls_.control(fd_, PPS_GETCAP, &able) < 0)
    return Error{fmt::format("{}: no pulse source: {}", path_, std::strerror(errno))};
  if ((able & wanted) == 0)
    return Error{fmt::format("{}: found abilities {:#x}, wanted to stamp the {} edge", path_, able,
                             edge_ == Edge::assert ? "assert" : "clear")};
  pps_kparams parameters{};
  if (calls_.control(fd_, PPS_GETPARAMS, &parameters) < 0 || (parameters.mode & wanted) != 0) return success();
  parameters.mode |= wanted | PPS_TSFMT_TSPEC;
  if (calls_.control(fd_, PPS_SETPARAMS, &parameters) == 0) return success();
  return Error{fmt::format("{}: the edge cannot be chosen: {}", path_, std::strerror(errno))};
}

int PpsSource::ask(Duration wait, PpsPulse& newest, bool& sound) {
  pps_fdata data{};
  data.timeout.sec = wait.ns() / kNanosPerSecond;
  data.timeout.nsec = static_cast<std::int32_t>(wait.ns() % kNanosPerSecond);
  if (calls_.control(fd_, PPS_FETCH, &data) < 0) return errno;
  const bool asserted = edge_ == Edge::assert;
  const pps_ktime& stamp = asserted ? data.info.assert_tu : data.info.clear_tu;
  sound = stamp.sec != 0 || stamp.nsec != 0;
  newest = {clock_.of_realtime(stamp.sec * kNanosPerSecond + stamp.nsec),
            asserted ? data.info.assert_sequence : data.info.clear_sequence};
  return 0;
}

std::optional<PpsPulse> PpsSource::fetch(Duration wait) {
  if (!there()) return std::nullopt;
  PpsPulse newest;
  bool sound = false;
  if (const int failed = ask(wait, newest, sound); failed != 0) {
    if (failed != ETIMEDOUT) leave(failed);
    return std::nullopt;
  }
  if (newest.sequence == last_) return std::nullopt;
  counts_.missed += newest.sequence - last_ - 1;
  last_ = newest.sequence;
  ++(sound ? counts_.pulses : counts_.unsound);
  if (!sound) return std::nullopt;
  reopening_.works();
  return newest;
}

}  // namespace lxd
