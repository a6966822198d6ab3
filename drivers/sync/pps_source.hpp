// SPDX-License-Identifier: Apache-2.0
// A pulse per second from /dev/ppsN: the kernel stamps the edge in its interrupt and keeps the newest. Asked ten times
// a second without waiting, or waited for by a thread of its own, it gives each pulse once. Polling for it is of no
// use: kernels before 6.13 call it readable at all times.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "drivers/device/host_clock.hpp"
#include "drivers/device/reopening.hpp"
#include "drivers/device/system_calls.hpp"
#include "rt/result.hpp"

namespace lxd {

struct PpsPulse {
  RigTime edge;
  std::uint32_t sequence = 0;  // the kernel's count of edges
};

struct PpsCounts {
  std::uint64_t pulses = 0;   // given
  std::uint64_t missed = 0;   // by gaps in the kernel's count: nobody asked in time
  std::uint64_t unsound = 0;  // without a stamp
  std::uint64_t openings = 0, departures = 0;
};

class PpsSource {
 public:
  enum class Edge : std::uint8_t { assert, clear };

  // Away until tend() opens it. `clock` and `calls` outlive the source.
  PpsSource(std::string path, Edge edge, const HostClock& clock, SystemCalls& calls = kernel_calls());
  PpsSource(const PpsSource&) = delete;
  PpsSource& operator=(const PpsSource&) = delete;
  ~PpsSource() { close(); }

  [[nodiscard]] const std::string& name() const { return path_; }
  [[nodiscard]] bool there() const { return fd_ >= 0; }
  [[nodiscard]] const std::string& trouble() const { return trouble_; }
  [[nodiscard]] const PpsCounts& counts() const { return counts_; }

  // Opens what is away, at growing intervals.
  void tend(RigTime now);
  // The newest pulse that was not given yet; waits for one at most so long, 0: not at all. None: there is none, or the
  // source is away.
  std::optional<PpsPulse> fetch(Duration wait);

 private:
  Status open();
  Status check_edge();
  // 0 or the error number.
  int ask(Duration wait, PpsPulse& newest, bool& sound);
  void close();
  void leave(int cause);

  std::string path_;
  Edge edge_;
  const HostClock& clock_;
  SystemCalls& calls_;
  int fd_ = -1;
  std::uint32_t last_ = 0;  // given, or there before we came
  Reopening reopening_;
  std::string trouble_ = "not opened yet";
  PpsCounts counts_;
};

}  // namespace lxd
