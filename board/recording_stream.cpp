// SPDX-License-Identifier: Apache-2.0
#include "board/recording_stream.hpp"

#include <cstring>

namespace lxd {
namespace {

// A disk may stand still for about so long: 30 MB a second is a dense LiDAR, 100 kB a fast serial line.
constexpr std::size_t kLidarRingBytes = 32U << 20U;  // 1 s
constexpr std::size_t kLineRingBytes = 1U << 20U;    // 10 s
constexpr std::size_t kChunkMax = 65'536;            // no datagram is longer

struct RecordHead {
  RigTime received;
  ChunkOrigin origin;
};

bool is_lidar(LiveChannel channel) { return channel == LiveChannel::lidar0 || channel == LiveChannel::lidar1; }

}  // namespace

RecordingStream::RecordingStream(LiveChannel channel, std::unique_ptr<ChunkFile> file)
    : channel_(channel),
      file_(std::move(file)),
      storage_(is_lidar(channel) ? kLidarRingBytes : kLineRingBytes),
      ring_(storage_),
      record_(sizeof(RecordHead) + kChunkMax) {}

void RecordingStream::put(const Chunk& chunk) {
  const RecordHead head{chunk.received, chunk.origin};
  chunks_.fetch_add(1, std::memory_order_relaxed);
  bytes_.fetch_add(chunk.bytes.size(), std::memory_order_relaxed);
  if (!ring_.push({reinterpret_cast<const std::uint8_t*>(&head), sizeof(head)}, chunk.bytes))
    no_room_.fetch_add(1, std::memory_order_relaxed);
}

bool RecordingStream::write() {
  const auto record = ring_.pop(record_);
  if (record.empty()) return false;
  ++unflushed_;
  RecordHead head;
  std::memcpy(&head, record.data(), sizeof(head));
  const std::uint64_t before = file_->file().flushed_bytes();
  const Status appended = file_->append({head.received, head.origin, 0, record.subspan(sizeof(head))});
  if (file_->file().flushed_bytes() != before) unflushed_ = 1;  // all before this one
  if (!appended) check(appended);
  return true;
}

void RecordingStream::close() { check(file_->close()); }

void RecordingStream::check(const Status& status) {
  if (!status) {
    if (failure_.empty()) failure_ = status.error().message;
    not_written_ += unflushed_;
  }
  unflushed_ = 0;
}

StreamCounts RecordingStream::counts() const {
  return {chunks_.load(std::memory_order_relaxed), bytes_.load(std::memory_order_relaxed),
          no_room_.load(std::memory_order_relaxed), not_written_};
}

}  // namespace lxd
