// SPDX-License-Identifier: Apache-2.0
// A kernel with one camera, as much of it as V4L2's streaming shows: formats, controls, buffers, and being pulled out.
#pragma once

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <deque>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <linux/videodev2.h>

#include "drivers/device/system_calls.hpp"
#include "tests/support/made_kernel.hpp"

namespace lxd::test {

class MadeCamera final : public SystemCalls {
 public:
  struct Frame {
    std::uint32_t sequence = 0;
    std::int64_t stamp_us = 0;
    std::uint32_t flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC | V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
    std::string content = "frame";
    std::uint32_t bytesused = 0;  // 0: as long as the content
  };
  static constexpr int kFd = 1000;  // of no open file
  static constexpr std::uint32_t kTriggerMode = V4L2_CID_BASE + 0x1000;

  // What the camera is.
  bool present = true;
  std::uint32_t abilities = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
  std::uint32_t only_fourcc = V4L2_PIX_FMT_GREY;
  std::uint32_t most_buffers = 4, buffer_bytes = 64;
  int fails_with = 0;  // the next dequeue

  // What it was told.
  std::map<std::uint32_t, std::int32_t> controls;
  double rate_hz = 0;
  bool streaming = false;
  int open_files = 0, mapped = 0, queued = 0;

  void send(Frame frame) { waiting_.push_back(std::move(frame)); }

  int open(const std::string&) override {
    if (!present) return failed_call(ENOENT);
    ++open_files;
    return kFd;
  }
  void close(int) override { --open_files; }
  void* map(int, std::size_t bytes, off_t offset) override {
    ++mapped;
    memory_.resize(std::max(memory_.size(), static_cast<std::size_t>(offset) + bytes));
    return memory_.data() + offset;
  }
  void unmap(void*, std::size_t) override { --mapped; }

  int control(int, unsigned long request, void* argument) override {
    if (!present) return failed_call(ENODEV);
    switch (request) {
      case VIDIOC_QUERYCAP:
        return query(*static_cast<v4l2_capability*>(argument));
      case VIDIOC_S_FMT:
        return set(*static_cast<v4l2_format*>(argument));
      case VIDIOC_S_PARM:
        return set(*static_cast<v4l2_streamparm*>(argument));
      case VIDIOC_S_CTRL:
        return set(*static_cast<v4l2_control*>(argument));
      case VIDIOC_QUERYCTRL:
        return query(*static_cast<v4l2_queryctrl*>(argument));
      case VIDIOC_REQBUFS:
        return request_buffers(*static_cast<v4l2_requestbuffers*>(argument));
      case VIDIOC_QUERYBUF:
        return query(*static_cast<v4l2_buffer*>(argument));
      case VIDIOC_QBUF:
        return enqueue(static_cast<v4l2_buffer*>(argument)->index);
      case VIDIOC_DQBUF:
        return dequeue(*static_cast<v4l2_buffer*>(argument));
      case VIDIOC_STREAMON:
        streaming = true;
        return 0;
      case VIDIOC_STREAMOFF:
        streaming = false;
        return 0;
      default:
        return failed_call(ENOTTY);
    }
  }

 private:
  int query(v4l2_capability& able) const {
    able.capabilities = abilities | V4L2_CAP_DEVICE_CAPS;
    able.device_caps = abilities;
    return 0;
  }
  int set(v4l2_format& format) const {
    format.fmt.pix.pixelformat = only_fourcc;
    format.fmt.pix.bytesperline = format.fmt.pix.width;
    return 0;
  }
  int set(const v4l2_streamparm& parameters) {
    const v4l2_fract& time = parameters.parm.capture.timeperframe;
    rate_hz = static_cast<double>(time.denominator) / time.numerator;
    return 0;
  }
  int set(const v4l2_control& control) {
    if (control.id == kTriggerMode && control.value > 1) return failed_call(ERANGE);
    controls[control.id] = control.value;
    return 0;
  }
  static int query(v4l2_queryctrl& control) {
    const std::uint32_t after = control.id & ~V4L2_CTRL_FLAG_NEXT_CTRL;
    control.type = V4L2_CTRL_TYPE_INTEGER;
    for (const auto& [id, name] :
         std::map<std::uint32_t, const char*>{{V4L2_CID_GAIN, "Gain"}, {kTriggerMode, "Trigger Mode"}}) {
      if (id <= after) continue;
      control.id = id;
      std::strncpy(reinterpret_cast<char*>(control.name), name, sizeof control.name - 1);
      return 0;
    }
    return failed_call(EINVAL);
  }
  int request_buffers(v4l2_requestbuffers& request) const {
    request.count = std::min(request.count, most_buffers);
    return 0;
  }
  int query(v4l2_buffer& buffer) {
    buffer.length = buffer_bytes;
    buffer.m.offset = buffer.index * buffer_bytes;
    memory_.reserve(static_cast<std::size_t>(most_buffers) * buffer_bytes);  // what is mapped does not move
    return 0;
  }
  int enqueue(std::uint32_t index) {
    free_.push_back(index);
    ++queued;
    return 0;
  }
  int dequeue(v4l2_buffer& buffer) {
    if (fails_with != 0) return failed_call(std::exchange(fails_with, 0));
    if (waiting_.empty() || free_.empty()) return failed_call(EAGAIN);
    const Frame frame = waiting_.front();
    waiting_.pop_front();
    buffer.index = free_.front();
    free_.pop_front();
    --queued;
    std::memcpy(memory_.data() + std::size_t{buffer.index} * buffer_bytes, frame.content.data(), frame.content.size());
    buffer.bytesused = frame.bytesused != 0 ? frame.bytesused : static_cast<std::uint32_t>(frame.content.size());
    buffer.sequence = frame.sequence;
    buffer.flags = frame.flags;
    buffer.timestamp.tv_sec = frame.stamp_us / 1'000'000;
    buffer.timestamp.tv_usec = frame.stamp_us % 1'000'000;
    return 0;
  }

  std::deque<Frame> waiting_;
  std::deque<std::uint32_t> free_;
  std::vector<std::uint8_t> memory_;
};

}  // namespace lxd::test
