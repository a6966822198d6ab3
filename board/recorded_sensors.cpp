// SPDX-License-Identifier: Apache-2.0
#include "board/recorded_sensors.hpp"

#include <vector>

#include "board/wheel_table.hpp"
#include "drivers/gnss/nmea_parser.hpp"
#include "drivers/replay/can_log.hpp"
#include "drivers/replay/imu_log.hpp"
#include "drivers/replay/nmea_log.hpp"

namespace lxd {
namespace {

namespace fs = std::filesystem;

bool is_there(const fs::path& file) {
  std::error_code ignored;
  return fs::is_regular_file(file, ignored);
}

template <typename Sample>
void give(const std::function<void(const Sample&)>& reader, const Sample& sample) {
  if (reader) reader(sample);
}

Result<Rejections> read_imu(const fs::path& file, const ImuRig& rig, const SensorReaders& readers) {
  auto log = ImuLog::open(file, find_imu_protocol(rig.protocol).value_or(ImuProtocol::kVectorNav), rig.baud_rate);
  if (!log) return log.error();
  ImuSample sample;
  while (log->next(sample)) give(readers.imu, sample);
  return log->rejected();
}

Result<Rejections> read_wheel(const fs::path& file, const WheelRig& rig, const SensorReaders& readers) {
  auto log = CanLogReader::open(file);
  if (!log) return log.error();
  const std::vector<CanMessage> messages = wheel_messages(rig);
  WheelDecoder decoder(wheel_decoder_config(rig, messages));
  CanLogRecord record;
  while (log->next(record)) {
    if (const auto sample = decoder.decode(record.frame)) give(readers.wheel, *sample);
  }
  Rejections rejected = rejections_of(decoder.counts());
  count_rejected(rejected, "bad_line", log->garbage());
  return rejected;
}

Result<Rejections> read_gnss(const fs::path& file, const SensorReaders& readers) {
  auto log = NmeaLog::open(file);
  if (!log) return log.error();
  NmeaParser parser;
  NmeaChunk chunk;
  const auto take = [&](const GnssFix& fix) { give(readers.gnss, fix); };
  while (log->next(chunk)) parser.feed(chunk.bytes, chunk.received, take);
  if (const auto last = parser.flush()) take(*last);
  Rejections rejected = rejections_of(parser);
  count_rejected(rejected, "bad_line", log->garbage());
  return rejected;
}

}  // namespace

Result<std::map<std::string, Rejections>> read_recorded_sensors(const fs::path& recording, const Rig& rig,
                                                                const SensorReaders& readers) {
  std::map<std::string, Rejections> rejected;
  const auto keep = [&](const char* sensor, const Result<Rejections>& read) -> Status {
    if (!read) return read.error();
    if (!read->empty()) rejected[sensor] = *read;
    return success();
  };
  Status status = success();
  const fs::path imu = recording / "imu.serial", wheel = recording / "can.log", gnss = recording / "gnss.nmea";
  if (rig.imu && !rig.imu->of_lidar() && is_there(imu)) status = keep("imu", read_imu(imu, *rig.imu, readers));
  if (status && rig.wheel && is_there(wheel)) status = keep("wheel", read_wheel(wheel, *rig.wheel, readers));
  if (status && rig.gnss && is_there(gnss)) status = keep("gnss", read_gnss(gnss, readers));
  if (!status) return status.error();
  return rejected;
}

}  // namespace lxd
