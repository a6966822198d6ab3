// SPDX-License-Identifier: Apache-2.0
#include "drivers/replay/imu_source.hpp"

#include <fmt/format.h>

#include "drivers/replay/csv_log.hpp"
#include "drivers/replay/imu_log.hpp"
#include "drivers/replay/pps_log.hpp"

namespace lxd {
namespace {

namespace fs = std::filesystem;

class SerialImu final : public ImuSource {
 public:
  SerialImu(ImuLog log, std::vector<RigTime> pulses) : log_(std::move(log)), clock_(std::move(pulses)) {}

  bool next(ImuSample& sample) override {
    while (log_.next(sample)) {
      if (clock_.place(sample)) return true;
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
  ImuClock clock_;
};

class TextImu final : public ImuSource {
 public:
  explicit TextImu(CsvLog<6> log) : log_(std::move(log)) {}

  // A row whose time lies behind the next one's is a leap: nothing that follows would be later.
  bool next(ImuSample& sample) override {
    if (!begun_) ahead_ = log_.next(next_);
    begun_ = true;
    CsvLog<6>::Row row;
    do {
      if (!ahead_) return false;
      row = next_;
      ahead_ = log_.next(next_);
      leaps_ += ahead_ && next_.t < row.t;
    } while (ahead_ && next_.t < row.t);
    sample = {};
    sample.t = sample.received = row.t;
    sample.gyro_radps = {row.values[0], row.values[1], row.values[2]};
    sample.accel_mps2 = {row.values[3], row.values[4], row.values[5]};
    return true;
  }

  [[nodiscard]] Rejections rejected() const override {
    Rejections rejected = log_.rejected();
    count_rejected(rejected, "time_leap", leaps_);
    return rejected;
  }

 private:
  CsvLog<6> log_;
  CsvLog<6>::Row next_;
  bool begun_ = false, ahead_ = false;
  std::uint64_t leaps_ = 0;
};

}  // namespace

Result<std::unique_ptr<ImuSource>> open_imu_source(const fs::path& recording, ImuProtocol protocol, double baud_rate,
                                                   bool pulsed) {
  using Opened = Result<std::unique_ptr<ImuSource>>;
  std::error_code ignored;
  if (fs::is_regular_file(recording / kImuSerialFile, ignored)) {
    auto log = ImuLog::open(recording / kImuSerialFile, protocol, baud_rate);
    auto pulses = recorded_pulses(recording, pulsed);
    if (!pulses) return pulses.error();
    return log ? Opened(std::make_unique<SerialImu>(std::move(*log), std::move(*pulses))) : Opened(log.error());
  }
  if (fs::is_regular_file(recording / kImuTextFile, ignored)) {
    auto log = CsvLog<6>::open(recording / kImuTextFile);
    return log ? Opened(std::make_unique<TextImu>(std::move(*log))) : Opened(log.error());
  }
  return Error{fmt::format("{}: found no recording of an IMU, wanted {} or {}", recording.string(), kImuSerialFile,
                           kImuTextFile)};
}

}  // namespace lxd
