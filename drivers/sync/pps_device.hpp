// SPDX-License-Identifier: Apache-2.0
// A pulse source as a device of the thread that polls: a timer beside it is readable ten times a second, and then the
// source is asked for the newest pulse without waiting.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "drivers/device/device.hpp"
#include "drivers/device/file_descriptor.hpp"
#include "drivers/sync/pps_source.hpp"

namespace lxd {

class PpsDevice final : public Device {
 public:
  static constexpr Duration kAsked = Duration::from_ns(100'000'000);

  // Away until tend() opens it. `clock` and `calls` outlive the device.
  PpsDevice(std::string path, PpsSource::Edge edge, std::uint8_t channel, const HostClock& clock,
            SystemCalls& calls = kernel_calls());

  [[nodiscard]] const std::string& name() const override { return source_.name(); }
  [[nodiscard]] int fd() const override { return source_.there() ? timer_.get() : -1; }
  // A chunk a pulse, as drivers/sync/pulse_wire.hpp has it.
  void read(ChunkSink& sink) override;
  void tend(RigTime now) override;
  [[nodiscard]] const std::string& trouble() const override { return source_.trouble(); }
  [[nodiscard]] const DeviceCounts& counts() const override { return counts_; }

 private:
  void note_counts();

  PpsSource source_;
  std::uint8_t channel_;
  FileDescriptor timer_;
  DeviceCounts counts_;
};

}  // namespace lxd
