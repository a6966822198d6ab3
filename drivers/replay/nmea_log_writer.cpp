// SPDX-License-Identifier: Apache-2.0
#include "drivers/replay/nmea_log_writer.hpp"

#include <string>

#include <fmt/format.h>

namespace lxd {
namespace {

std::span<const std::uint8_t> bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

}  // namespace

Result<NmeaLogWriter> NmeaLogWriter::create(const std::filesystem::path& path) {
  auto file = GrowingFile::create(path);
  if (!file) return file.error();
  return NmeaLogWriter(std::move(*file));
}

Status NmeaLogWriter::append(RigTime received, std::span<const std::uint8_t> bytes) {
  for (const std::uint8_t byte : bytes)
    if (Status pushed = push(byte, received); !pushed) return pushed;
  return success();
}

// A `$` within a line cuts it off: the next sentence has begun.
Status NmeaLogWriter::push(std::uint8_t byte, RigTime received) {
  const bool line_end = byte == '\n' || byte == '\r';
  if (line_end || byte == '$' || size_ == line_.size()) {
    if (Status ended = end_line(); !ended) return ended;
  }
  if (line_end) return success();
  if (size_ == 0) received_ = received;
  line_[size_++] = byte;
  return success();
}

Status NmeaLogWriter::end_line() {
  if (size_ == 0) return success();
  const std::string time = fmt::format("{}.{:09} ", received_.ns() / kNanosPerSecond, received_.ns() % kNanosPerSecond);
  static constexpr std::array<std::uint8_t, 1> kLineEnd{'\n'};
  Status written = file_.append({bytes_of(time), std::span(line_).first(size_), kLineEnd});
  size_ = 0;
  return written;
}

Status NmeaLogWriter::close() {
  Status ended = end_line();
  Status closed = file_.close();
  return ended ? closed : ended;
}

}  // namespace lxd
