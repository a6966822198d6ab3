// SPDX-License-Identifier: Apache-2.0
// A kernel with one pulse source, as much of it as /dev/ppsN shows, and being pulled out.
#pragma once

#include <cerrno>
#include <cstdint>
#include <string>

#include <linux/pps.h>

#include "drivers/device/system_calls.hpp"
#include "rt/time.hpp"
#include "tests/support/made_kernel.hpp"

namespace lxd::test {

// The host's realtime clock is the rig's as long as nobody sets it.
inline std::int64_t realtime_of(RigTime t) { return t.ns(); }

class MadePps final : public SystemCalls {
 public:
  bool present = true;
  int able = PPS_CAPTUREASSERT | PPS_CANWAIT | PPS_TSFMT_TSPEC, mode = PPS_CAPTUREASSERT;
  std::uint32_t sequence = 0;
  std::int64_t edge_ns = 0;
  int open_files = 0;

  void pulse(RigTime t) {
    ++sequence;
    edge_ns = realtime_of(t);
  }

  int open(const std::string&) override {
    if (!present) return failed_call(ENOENT);
    ++open_files;
    return 1000;
  }
  void close(int) override { --open_files; }
  void* map(int, std::size_t, off_t) override { return nullptr; }
  void unmap(void*, std::size_t) override {}
  int control(int, unsigned long request, void* argument) override {
    if (!present) return failed_call(ENODEV);
    switch (request) {
      case PPS_GETCAP:
        return *static_cast<int*>(argument) = able, 0;
      case PPS_GETPARAMS:
        return static_cast<pps_kparams*>(argument)->mode = mode, 0;
      case PPS_SETPARAMS:
        return mode = static_cast<pps_kparams*>(argument)->mode, 0;
      case PPS_FETCH:
        return fetch(*static_cast<pps_fdata*>(argument));
      default:
        return failed_call(ENOTTY);
    }
  }

 private:
  int fetch(pps_fdata& data) const {
    if (data.timeout.sec != 0 || data.timeout.nsec != 0) return failed_call(ETIMEDOUT);
    const pps_ktime stamp{edge_ns / kNanosPerSecond, static_cast<std::int32_t>(edge_ns % kNanosPerSecond), 0};
    data.info = {sequence, sequence, stamp, stamp, mode};
    return 0;
  }
};

}  // namespace lxd::test
