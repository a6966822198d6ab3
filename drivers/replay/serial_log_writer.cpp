// SPDX-License-Identifier: Apache-2.0
#include "drivers/replay/serial_log_writer.hpp"

#include <algorithm>
#include <array>

#include "drivers/replay/serial_log.hpp"

namespace lxd {

Result<SerialLogWriter> SerialLogWriter::create(const std::filesystem::path& path) {
  auto file = GrowingFile::create(path);
  if (!file) return file.error();
  if (const Status written = file->append({kSerialLogMagic}); !written) return written.error();
  return SerialLogWriter(std::move(*file));
}

Status SerialLogWriter::append(RigTime received, std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const auto chunk = bytes.first(std::min(bytes.size(), kSerialChunkMax));
    std::array<std::uint8_t, kSerialChunkHeaderBytes> header{};
    kSerialChunkTime.set(header.data(), static_cast<std::uint64_t>(received.ns()));
    kSerialChunkBytes.set(header.data(), chunk.size());
    if (Status written = file_.append({header, chunk}); !written) return written;
    bytes = bytes.subspan(chunk.size());
  }
  return success();
}

}  // namespace lxd
