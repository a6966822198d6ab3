// SPDX-License-Identifier: Apache-2.0
#include "drivers/replay/serial_log.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <fmt/format.h>

namespace lxd {
namespace {

// Half of what int64 nanoseconds hold, so that differences cannot overflow.
constexpr std::int64_t kFarthest_ns = std::int64_t{1} << 62;

}  // namespace

Result<SerialLog> SerialLog::open(const std::filesystem::path& path) {
  std::error_code ignored;  // a folder opens like a file, and fails when it is read
  if (std::filesystem::is_directory(path, ignored))
    return Error{fmt::format("{}: found a folder, wanted a recorded serial line", path.string())};
  std::FILE* const stream = std::fopen(path.c_str(), "rb");
  if (stream == nullptr) return Error{fmt::format("{}: cannot be read: {}", path.string(), std::strerror(errno))};
  return from_stream(stream, path.string());
}

Result<SerialLog> SerialLog::from_stream(std::FILE* stream, const std::string& name) {
  Stream owned(stream);
  std::array<std::uint8_t, kSerialLogMagic.size()> found{};
  const std::size_t read = std::fread(found.data(), 1, found.size(), stream);
  const auto [wrong, wanted] = std::ranges::mismatch(std::span(found).first(read), kSerialLogMagic);
  if (wanted == kSerialLogMagic.end()) return SerialLog(std::move(owned));
  const auto offset = wanted - kSerialLogMagic.begin();
  if (static_cast<std::size_t>(offset) == read)
    return Error{fmt::format("{}: ends at offset {}, wanted \"LXDSER1\" and a newline", name, offset)};
  return Error{fmt::format("{}: offset {}: found 0x{:02x}, wanted 0x{:02x} (\"LXDSER1\" and a newline)", name, offset,
                           *wrong, *wanted)};
}

bool SerialLog::next(SerialChunk& chunk, Rejections& rejected) {
  while (read_chunk(chunk, rejected)) {
    if (chunk.received.ns() > -kFarthest_ns && chunk.received.ns() < kFarthest_ns) {
      if (chunk.received < last_) count_rejected(rejected, "time_backwards");
      last_ = chunk.received;
      return true;
    }
    count_rejected(rejected, "bad_time");
  }
  return false;
}

bool SerialLog::read_chunk(SerialChunk& chunk, Rejections& rejected) {
  if (ended_) return false;
  std::array<std::uint8_t, kSerialChunkHeaderBytes> header{};
  const std::size_t header_read = std::fread(header.data(), 1, header.size(), stream_.get());
  if (header_read == 0) return end(rejected, nullptr);
  if (header_read < header.size()) return end(rejected, "truncated_file");
  const auto wanted = static_cast<std::size_t>(kSerialChunkBytes.get(header.data()));
  if (wanted > storage_.size()) return end(rejected, "oversized_chunk");
  const std::size_t read = std::fread(storage_.data(), 1, wanted, stream_.get());
  chunk.received = RigTime::from_ns(static_cast<std::int64_t>(kSerialChunkTime.get(header.data())));
  chunk.bytes = std::span(storage_).first(read);
  if (read < wanted) end(rejected, "truncated_file");
  return true;
}

bool SerialLog::end(Rejections& rejected, const char* cause) {
  if (cause != nullptr) count_rejected(rejected, cause);
  ended_ = true;
  return false;
}

}  // namespace lxd
