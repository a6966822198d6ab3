// SPDX-License-Identifier: Apache-2.0
#include "drivers/replay/wheel_source.hpp"

#include <fmt/format.h>

#include "drivers/replay/can_log.hpp"
#include "drivers/replay/csv_log.hpp"

namespace lxd {
namespace {

namespace fs = std::filesystem;

class CanWheels final : public WheelLogSource {
 public:
  CanWheels(CanLogReader log, std::vector<CanMessage> messages, WheelDecoderConfig config)
      : log_(std::move(log)), messages_(std::move(messages)), decoder_((config.messages = messages_, config)) {}

  bool next(WheelSample& sample) override {
    CanLogRecord record;
    while (log_.next(record)) {
      const auto decoded = decoder_.decode(record.frame);
      if (!decoded) continue;
      sample = *decoded;
      return true;
    }
    return false;
  }

  [[nodiscard]] Rejections rejected() const override {
    Rejections rejected = rejections_of(decoder_.counts());
    count_rejected(rejected, "bad_line", log_.garbage());
    return rejected;
  }

 private:
  CanLogReader log_;
  std::vector<CanMessage> messages_;
  WheelDecoder decoder_;
};

class TextWheels final : public WheelLogSource {
 public:
  explicit TextWheels(CsvLog<2> log) : log_(std::move(log)) {}

  bool next(WheelSample& sample) override {
    CsvLog<2>::Row row;
    if (!log_.next(row)) return false;
    sample = {row.t, row.values[0], row.values[1], Duration()};
    return true;
  }

  [[nodiscard]] Rejections rejected() const override { return log_.rejected(); }

 private:
  CsvLog<2> log_;
};

}  // namespace

Result<std::unique_ptr<WheelLogSource>> open_wheel_source(const fs::path& recording, std::vector<CanMessage> messages,
                                                          const WheelDecoderConfig& decoder) {
  using Opened = Result<std::unique_ptr<WheelLogSource>>;
  std::error_code ignored;
  if (fs::is_regular_file(recording / kCanLogFile, ignored)) {
    auto log = CanLogReader::open(recording / kCanLogFile);
    return log ? Opened(std::make_unique<CanWheels>(std::move(*log), std::move(messages), decoder))
               : Opened(log.error());
  }
  if (fs::is_regular_file(recording / kWheelTextFile, ignored)) {
    auto log = CsvLog<2>::open(recording / kWheelTextFile);
    return log ? Opened(std::make_unique<TextWheels>(std::move(*log))) : Opened(log.error());
  }
  return Error{fmt::format("{}: found no recording of wheels, wanted {} or {}", recording.string(), kCanLogFile,
                           kWheelTextFile)};
}

}  // namespace lxd
