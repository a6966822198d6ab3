// SPDX-License-Identifier: Apache-2.0
#include "drivers/replay/imu_log.hpp"

namespace lxd {

Result<ImuLog> ImuLog::open(const std::filesystem::path& path, ImuProtocol protocol, double baud_rate) {
  Result<SerialLog> log = SerialLog::open(path);
  if (!log) return log.error();
  return ImuLog(std::move(*log), protocol, baud_rate);
}

ImuLog::ImuLog(SerialLog log, ImuProtocol protocol, double baud_rate)
    : log_(std::move(log)), stream_(protocol, baud_rate) {}

bool ImuLog::next(ImuSample& sample) {
  for (;;) {
    if (stream_.next(sample)) {
      ++samples_;
      return true;
    }
    if (!feed()) return false;
  }
}

// The parser has taken all samples out of what it holds, so there is room.
bool ImuLog::feed() {
  while (chunk_.bytes.empty()) {
    if (!log_.next(chunk_, file_rejected_)) return false;
  }
  const std::size_t taken = stream_.feed(chunk_.bytes, chunk_.received);
  bytes_ += taken;
  chunk_.bytes = chunk_.bytes.subspan(taken);
  return true;
}

Rejections ImuLog::rejected() const {
  Rejections rejected = file_rejected_;
  for (const auto& [cause, times] : stream_.rejected()) rejected[cause] += times;
  return rejected;
}

}  // namespace lxd
