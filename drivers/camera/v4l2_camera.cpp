// SPDX-License-Identifier: Apache-2.0
// See v4l2_camera.hpp.
#include "drivers/camera/v4l2_camera.hpp"

#include <cerrno>
#include <cstring>

namespace lxd {
namespace {

// The kernel's stamp; a timeval of microseconds.
std::int64_t stamp_ns(const v4l2_buffer& buffer) {
  constexpr std::int64_t kNanosPerMicro = 1000;
  return std::int64_t{buffer.timestamp.tv_sec} * kNanosPerSecond + buffer.timestamp.tv_usec * kNanosPerMicro;
}

bool is_monotonic(const v4l2_buffer& buffer) {
  return (buffer.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) == V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
}

FrameInstant instant_of(const v4l2_buffer& buffer) {
  const bool start = (buffer.flags & V4L2_BUF_FLAG_TSTAMP_SRC_MASK) == V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
  return start ? FrameInstant::start_of_exposure : FrameInstant::end_of_frame;
}

}  // namespace

void V4l2Camera::tend(RigTime now) {
  if (stream_ || !reopening_.due(now)) return;
  Result<VideoStream> opened = VideoStream::open(config_, api_);
  if (!opened) {
    reopening_.failed(now);
    trouble_ = opened.error().message;
    return;
  }
  stream_.emplace(std::move(*opened));
  layout_ = stream_->layout();
  last_sequence_.reset();
  failures_ = 0;
  trouble_.clear();
  ++counts_.openings;
}

void V4l2Camera::read(ChunkSink& sink) {
  for (int i = 0; stream_ && i < kChunksPerRead; ++i) {
    if (!read_one(sink)) return;
  }
}

// EIO is said of a signal that was lost for a moment; a camera that says nothing else is gone.
bool V4l2Camera::read_one(ChunkSink& sink) {
  constexpr int kFailuresMax = 20;
  v4l2_buffer buffer{};
  const int failed = stream_->take(buffer);
  if (failed == EAGAIN) return false;
  if (failed == EIO && ++failures_ < kFailuresMax) {
    ++counts_.read_errors;
    return false;
  }
  if (failed != 0) {
    leave(std::strerror(failed));
    return false;
  }
  failures_ = 0;
  deliver(buffer, sink);
  if (const int refused = stream_->give_back(buffer); refused != 0) leave(std::strerror(refused));
  return stream_.has_value();
}

void V4l2Camera::deliver(const v4l2_buffer& buffer, ChunkSink& sink) {
  count_lost(buffer.sequence);
  const auto bytes = stream_->content(buffer);
  if ((buffer.flags & V4L2_BUF_FLAG_ERROR) != 0) {
    ++camera_counts_.corrupt;
  } else if (!is_monotonic(buffer)) {
    ++camera_counts_.other_clock;
  } else if (bytes.empty()) {
    ++camera_counts_.empty;
  } else {
    reopening_.works();
    frame_ = {clock_.of_monotonic(stamp_ns(buffer)), instant_of(buffer), buffer.sequence};
    ++camera_counts_.frames;
    ++counts_.chunks;
    counts_.bytes += bytes.size();
    ChunkOrigin origin;
    origin.frame = {frame_.sequence, layout_->bytes_per_line, frame_.instant == FrameInstant::start_of_exposure};
    sink.take({frame_.stamp, origin, channel_, bytes});
  }
}

// A count that goes back has begun anew.
void V4l2Camera::count_lost(std::uint32_t sequence) {
  if (last_sequence_ && sequence > *last_sequence_) camera_counts_.lost += sequence - *last_sequence_ - 1;
  last_sequence_ = sequence;
}

void V4l2Camera::add_counts(std::map<std::string, std::uint64_t>& counts) const {
  for (const auto& [name, count] : kCameraCountNames)
    if (camera_counts_.*count > 0) counts[name] = camera_counts_.*count;
}

void V4l2Camera::leave(std::string why) {
  stream_.reset();
  trouble_ = config_.path + ": " + std::move(why);
  ++counts_.departures;
}

}  // namespace lxd
