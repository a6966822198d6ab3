// SPDX-License-Identifier: Apache-2.0
#include "drivers/replay/imu_source.hpp"

#include <fmt/format.h>

#include "drivers/replay/csv_log.hpp"
#include "drivers/replay/imu_log.hpp"
#include "drivers/sync/clock_model.hpp"

namespace lxd {
namespace {

namespace fs = std::filesystem;

// A sample that says no time of its own has that of its arrival.
class SerialImu final : public ImuSource {
 public:
  explicit SerialImu(ImuLog log) : log_(std::move(log)), clock_(ClockModelConfig{}) {}

  bool next(ImuSample& sample) override {
    while (log_.next(sample)) {
      if (!sample.sensor_ns) return true;
      if (clock_.add(*sample.sensor_ns, sample.t) == ClockVerdict::refused) continue;
      sample.t = clock_.to_rig(*sample.sensor_ns);
      return true;
    }
    return false;
  }

  [[nodiscard]] Rejections rejected() const override {
    Rejections rejected = log_.rejected();
    count_rejected(rejected, "clock_step", clock_.counts().steps);
    count_rejected(rejected, "clock_outlier", clock_.counts().refused);
    return rejected;
  }

 private:
  ImuLog log_;
  ClockModel clock_;
};

class TextImu final : public ImuSource {
 public:
  explicit TextImu(CsvLog<6> log) : log_(std::move(log)) {}

  bool next(ImuSample& sample) override {
    CsvLog<6>::Row row;
    if (!log_.next(row)) return false;
    sample = {};
    sample.t = sample.received = row.t;
    sample.gyro_radps = {row.values[0], row.values[1], row.values[2]};
    sample.accel_mps2 = {row.values[3], row.values[4], row.values[5]};
    return true;
  }

  [[nodiscard]] Rejections rejected() const override { return log_.rejected(); }

 private:
  CsvLog<6> log_;
};

}  // namespace

Result<std::unique_ptr<ImuSource>> open_imu_source(const fs::path& recording, ImuProtocol protocol, double baud_rate) {
  using Opened = Result<std::unique_ptr<ImuSource>>;
  std::error_code ignored;
  if (fs::is_regular_file(recording / kImuSerialFile, ignored)) {
    auto log = ImuLog::open(recording / kImuSerialFile, protocol, baud_rate);
    return log ? Opened(std::make_unique<SerialImu>(std::move(*log))) : Opened(log.error());
  }
  if (fs::is_regular_file(recording / kImuTextFile, ignored)) {
    auto log = CsvLog<6>::open(recording / kImuTextFile);
    return log ? Opened(std::make_unique<TextImu>(std::move(*log))) : Opened(log.error());
  }
  return Error{fmt::format("{}: found no recording of an IMU, wanted {} or {}", recording.string(), kImuSerialFile,
                           kImuTextFile)};
}

}  // namespace lxd
