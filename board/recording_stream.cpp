// SPDX-License-Identifier: Apache-2.0
#include "board/recording_stream.hpp"

#include <algorithm>
#include <bit>
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

// Of a camera so many frames, within bounds.
constexpr std::size_t kFrames = 16;
constexpr std::size_t kImageRingMin = 8U << 20U, kImageRingMax = 256U << 20U;

bool is_lidar(LiveChannel channel) { return channel == LiveChannel::lidar0 || channel == LiveChannel::lidar1; }

std::size_t ring_bytes(LiveChannel channel, std::size_t longest) {
  if (channel == LiveChannel::camera0)
    return std::clamp(std::bit_ceil(kFrames * longest), kImageRingMin, kImageRingMax);
  return is_lidar(channel) ? kLidarRingBytes : kLineRingBytes;
}

}  // namespace

RecordingStream::RecordingStream(LiveChannel channel, std::unique_ptr<ChunkFile> file, std::size_t longest)
    : channel_(channel),
      longest_(std::max(longest, kChunkMax)),
      file_(std::move(file)),
      storage_(ring_bytes(channel, longest_)),
      ring_(storage_),
      record_(sizeof(RecordHead) + longest_) {}

void RecordingStream::put(const Chunk& chunk) {
  const RecordHead head{chunk.received, chunk.origin};
  chunks_.fetch_add(1, std::memory_order_relaxed);
  bytes_.fetch_add(chunk.bytes.size(), std::memory_order_relaxed);
  const bool fits = chunk.bytes.size() <= longest_;
  if (!fits || !ring_.push({reinterpret_cast<const std::uint8_t*>(&head), sizeof(head)}, chunk.bytes))
    no_room_.fetch_add(1, std::memory_order_relaxed);
}

bool RecordingStream::write() {
  const auto record = ring_.pop(record_);
  if (record.empty()) return false;
  ++unflushed_;
  RecordHead head;
  std::memcpy(&head, record.data(), sizeof(head));
  const std::uint64_t before = file_->flushed_bytes();
  const Status appended = file_->append({head.received, head.origin, 0, record.subspan(sizeof(head))});
  if (file_->flushed_bytes() != before) unflushed_ = 1;  // all before this one
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
          no_room_.load(std::memory_order_relaxed), file_->refused(), not_written_};
}

}  // namespace lxd
