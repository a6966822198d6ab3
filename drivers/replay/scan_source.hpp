// SPDX-License-Identifier: Apache-2.0
// The source behind every folder of scan files. What tells the kinds apart is given to it: the sweeps' times, and a
// decoder of points.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/replay/point_filter.hpp"
#include "drivers/replay/scan_folder.hpp"
#include "drivers/replay/source.hpp"
#include "drivers/replay/stamp_gate.hpp"

namespace lxd {

struct SweepTiming {
  RigTime begin, end, stamp;
};

// Turns a file's floats into points. The sweep comes with its times set; a decoder that knows better changes them.
class ScanDecoder {
 public:
  virtual ~ScanDecoder() = default;
  [[nodiscard]] virtual std::size_t floats_per_point() const = 0;
  virtual void decode(std::span<const float> floats, Sweep& sweep, PointCounts& counts) const = 0;
};

// What an opener found in a folder. timings: by scan number; none: the recording has no time for it.
struct ScanRecording {
  std::string kind{};
  std::vector<ScanFile> files{};
  std::vector<std::optional<SweepTiming>> timings{};
  LidarTraits traits{};
  std::vector<std::string> notes{};
};

class ScanSource final : public SweepSource {
 public:
  ScanSource(ScanRecording recording, std::unique_ptr<const ScanDecoder> decoder);

  Result<bool> next(Sweep& sweep) override;  // never an Error
  [[nodiscard]] std::optional<std::uint64_t> size() const override { return recording_.files.size(); }
  [[nodiscard]] std::string kind() const override { return recording_.kind; }
  [[nodiscard]] LidarTraits traits() const override { return recording_.traits; }
  [[nodiscard]] const Rejections& rejected() const override { return rejected_; }
  [[nodiscard]] std::vector<std::string> notes() const override { return recording_.notes; }

 private:
  bool read(const ScanFile& file, Sweep& sweep);
  std::optional<SweepTiming> admit_time(std::uint32_t number);
  void count_missing_files();

  ScanRecording recording_;
  std::unique_ptr<const ScanDecoder> decoder_;
  ScanFileReader reader_;
  StampGate gate_;
  std::vector<bool> leaps_;  // by scan number, as the timings
  std::size_t next_ = 0;
  Rejections rejected_;
};

}  // namespace lxd
