// SPDX-License-Identifier: Apache-2.0
#include "drivers/replay/serial_log_writer.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <fmt/format.h>

#include "drivers/replay/serial_log.hpp"

namespace lxd {

Result<SerialLogWriter> SerialLogWriter::create(const std::filesystem::path& path) {
  SerialLogWriter writer(std::fopen(path.c_str(), "wb"), path.string());
  if (!writer.stream_) return writer.failure();
  if (const Status written = writer.write(kSerialLogMagic); !written) return written.error();
  return writer;
}

Status SerialLogWriter::append(RigTime received, std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const auto chunk = bytes.first(std::min(bytes.size(), kSerialChunkMax));
    std::array<std::uint8_t, kSerialChunkHeaderBytes> header{};
    kSerialChunkTime.set(header.data(), static_cast<std::uint64_t>(received.ns()));
    kSerialChunkBytes.set(header.data(), chunk.size());
    if (Status written = write(header); !written) return written;
    if (Status written = write(chunk); !written) return written;
    bytes = bytes.subspan(chunk.size());
  }
  return success();
}

Status SerialLogWriter::close() {
  if (std::fclose(stream_.release()) != 0) return failure();
  return success();
}

Status SerialLogWriter::write(std::span<const std::uint8_t> bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), stream_.get()) != bytes.size()) return failure();
  return success();
}

Error SerialLogWriter::failure() const {
  return Error{fmt::format("{}: cannot be written: {}", name_, std::strerror(errno))};
}

}  // namespace lxd
