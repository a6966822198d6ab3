// SPDX-License-Identifier: Apache-2.0
// A sensor's way into its file: the reading thread puts chunks into a ring of fixed size, the writing thread takes them
// out. What has no room, or no file any more, is counted.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "board/chunk_file.hpp"
#include "rt/byte_ring.hpp"

namespace lxd {

struct StreamCounts {
  std::uint64_t chunks = 0, bytes = 0;  // handed over by the device
  std::uint64_t no_room = 0;            // chunks: the disk was too slow for too long, or longer than any should be
  std::uint64_t refused = 0;            // chunks: images shorter than the camera's
  std::uint64_t not_written = 0;        // chunks: after the file's end, or in the buffer that ended it
};

class RecordingStream {
 public:
  // longest: of its chunks, bytes; 0: as long as a datagram may be.
  RecordingStream(LiveChannel channel, std::unique_ptr<ChunkFile> file, std::size_t longest = 0);

  // Reading thread.
  void put(const Chunk& chunk);

  // Writing thread, as all below. Into the file's buffer; false: nothing waited.
  bool write();
  // With the system; with the disk. A file that cannot be written ends, and failure() says why.
  void flush() { check(file_->flush()); }
  void sync() { check(file_->sync()); }
  void close();

  [[nodiscard]] LiveChannel channel() const { return channel_; }
  [[nodiscard]] bool ended() const { return !failure_.empty(); }
  [[nodiscard]] const std::string& failure() const { return failure_; }
  // Whole records that killing the process does not lose.
  [[nodiscard]] std::uint64_t written_bytes() const { return file_->flushed_bytes(); }
  [[nodiscard]] StreamCounts counts() const;

 private:
  void check(const Status& status);

  LiveChannel channel_;
  std::size_t longest_;
  std::unique_ptr<ChunkFile> file_;
  std::vector<std::uint8_t> storage_;  // of the ring
  ByteRing ring_;
  std::vector<std::uint8_t> record_;  // the one in hand
  std::string failure_;
  std::atomic<std::uint64_t> chunks_{0}, bytes_{0}, no_room_{0};  // written by the reading thread
  std::uint64_t unflushed_ = 0, not_written_ = 0;                 // chunks
};

}  // namespace lxd
