// SPDX-License-Identifier: Apache-2.0
// The file of a recorded serial line (`imu.serial`): what the port delivered, in the pieces in which it delivered them.
//
//   8 bytes "LXDSER1\n", then for each read of the port
//   int64 LE   receive time, ns of the host's clock since 1970
//   uint32 LE  number of bytes, at most kSerialChunkMax
//   the bytes
#pragma once

#include <array>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "drivers/ouster/bit_field.hpp"
#include "drivers/replay/rejections.hpp"
#include "rt/result.hpp"
#include "rt/time.hpp"

namespace lxd {

inline constexpr std::array<std::uint8_t, 8> kSerialLogMagic{'L', 'X', 'D', 'S', 'E', 'R', '1', '\n'};
inline constexpr BitField kSerialChunkTime = bytes_at(0, 8);
inline constexpr BitField kSerialChunkBytes = bytes_at(8, 4);
inline constexpr std::size_t kSerialChunkHeaderBytes = 12;
inline constexpr std::size_t kSerialChunkMax = 65'536;  // what one read of a port can give, with much room

struct SerialChunk {
  RigTime received;
  std::span<const std::uint8_t> bytes;  // valid until the next read
};

class SerialLog {
 public:
  // Errors name the file and, where it is no recording of a serial line, the offset of the first byte that differs.
  static Result<SerialLog> open(const std::filesystem::path& path);
  // Takes the stream over; name is for messages.
  static Result<SerialLog> from_stream(std::FILE* stream, const std::string& name);

  // False at the end. A chunk whose time is beyond +-146 years is passed over and counted ("bad_time"). A file that
  // ends within a chunk is counted ("truncated_file"; what there is of the chunk's bytes is delivered), and so is a
  // chunk that claims more than a port can give ("oversized_chunk"): nothing behind it can be found again. A time
  // before that of the chunk before is counted ("time_backwards") and delivered.
  bool next(SerialChunk& chunk, Rejections& rejected);

 private:
  struct Close {
    void operator()(std::FILE* stream) const { std::fclose(stream); }
  };
  using Stream = std::unique_ptr<std::FILE, Close>;
  explicit SerialLog(Stream stream) : stream_(std::move(stream)), storage_(kSerialChunkMax) {}
  bool read_chunk(SerialChunk& chunk, Rejections& rejected);
  bool end(Rejections& rejected, const char* cause);

  Stream stream_;
  std::vector<std::uint8_t> storage_;
  RigTime last_ = RigTime::from_ns(INT64_MIN);
  bool ended_ = false;
};

}  // namespace lxd
