// SPDX-License-Identifier: Apache-2.0
// See video_stream.hpp. Source: the kernel's Documentation/userspace-api/media/v4l and linux/videodev2.h.
#include "drivers/camera/video_stream.hpp"

#include <cerrno>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "drivers/camera/video_controls.hpp"

namespace lxd {
namespace {

constexpr double kExposureUnit_s = 100e-6;  // of V4L2_CID_EXPOSURE_ABSOLUTE

std::string name_of(std::uint32_t fourcc_code) {
  std::string name;
  for (unsigned i = 0; i < 4; ++i) name += static_cast<char>(fourcc_code >> 8U * i & 0xFFU);
  return name;
}

v4l2_buffer buffer_of(std::uint32_t index) {
  v4l2_buffer buffer{};
  buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  buffer.memory = V4L2_MEMORY_MMAP;
  buffer.index = index;
  return buffer;
}

}  // namespace

VideoStream::VideoStream(VideoStream&& other) noexcept
    : api_(other.api_),
      fd_(std::exchange(other.fd_, -1)),
      path_(std::move(other.path_)),
      layout_(other.layout_),
      buffers_(std::move(other.buffers_)) {
  other.buffers_.clear();
}

VideoStream& VideoStream::operator=(VideoStream&& other) noexcept {
  std::swap(api_, other.api_);
  std::swap(fd_, other.fd_);
  std::swap(path_, other.path_);
  std::swap(layout_, other.layout_);
  std::swap(buffers_, other.buffers_);
  return *this;
}

VideoStream::~VideoStream() { take_down(); }

Error VideoStream::refused(const std::string& what) const {
  return Error{fmt::format("{}: {}: {}", path_, what, std::strerror(errno))};
}

Result<VideoStream> VideoStream::open(const VideoConfig& config, SystemCalls& api) {
  VideoStream stream(api.open(config.path), api);
  stream.path_ = config.path;
  if (stream.fd_ < 0) return stream.refused("cannot be opened");
  if (const Status done = stream.set_up(config); !done) return done.error();
  return stream;
}

Status VideoStream::set_up(const VideoConfig& config) {
  if (const Status able = check_abilities(); !able) return able;
  if (const Status chosen = choose_format(config); !chosen) return chosen;
  if (const Status chosen = choose_rate(config.rate_hz); !chosen) return chosen;
  if (const Status set = set_controls(config); !set) return set;
  if (const Status mapped = map_buffers(); !mapped) return mapped;
  return start();
}

Status VideoStream::check_abilities() {
  v4l2_capability able{};
  if (api_->control(fd_, VIDIOC_QUERYCAP, &able) < 0) return refused("no video device");
  const std::uint32_t has = (able.capabilities & V4L2_CAP_DEVICE_CAPS) != 0 ? able.device_caps : able.capabilities;
  constexpr std::uint32_t kWanted = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
  if ((has & kWanted) == kWanted) return success();
  return Error{fmt::format("{}: found abilities {:#x}, wanted capture and streaming ({:#x})", path_, has, kWanted)};
}

// A driver that has no such format answers with one that it has.
Status VideoStream::choose_format(const VideoConfig& config) {
  v4l2_format format{};
  format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  format.fmt.pix.width = config.width;
  format.fmt.pix.height = config.height;
  format.fmt.pix.pixelformat = config.fourcc;
  format.fmt.pix.field = V4L2_FIELD_NONE;
  if (api_->control(fd_, VIDIOC_S_FMT, &format) < 0) return refused("VIDIOC_S_FMT");
  const v4l2_pix_format& got = format.fmt.pix;
  const auto known = find_pixel_format(got.pixelformat);
  if (!known || got.pixelformat != config.fourcc || got.width != config.width || got.height != config.height)
    return Error{fmt::format("{}: found {} of {} x {} pixels, wanted {} of {} x {}", path_, name_of(got.pixelformat),
                             got.width, got.height, name_of(config.fourcc), config.width, config.height)};
  layout_ = {*known, got.width, got.height, *known == PixelFormat::mjpeg ? 0 : got.bytesperline};
  return success();
}

// Cameras that follow a trigger, or have one rate, do not know the call: ENOTTY.
Status VideoStream::choose_rate(double rate_hz) {
  if (rate_hz <= 0) return success();
  constexpr std::uint32_t kMilli = 1000;
  v4l2_streamparm parameters{};
  parameters.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  parameters.parm.capture.timeperframe = {kMilli, static_cast<std::uint32_t>(std::lround(rate_hz * kMilli))};
  if (api_->control(fd_, VIDIOC_S_PARM, &parameters) < 0 && errno != ENOTTY) return refused("VIDIOC_S_PARM");
  return success();
}

Status VideoStream::set_control(const std::string& name, std::uint32_t id, std::int32_t value) {
  v4l2_control control{id, value};
  if (api_->control(fd_, VIDIOC_S_CTRL, &control) == 0) return success();
  return refused(fmt::format("control {} = {}", name, value));
}

Status VideoStream::set_controls(const VideoConfig& config) {
  if (config.exposure_s) {
    const auto units = static_cast<std::int32_t>(std::lround(*config.exposure_s / kExposureUnit_s));
    const Status manual = set_control("exposure_auto", V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_MANUAL);
    const Status set = set_control("exposure_absolute", V4L2_CID_EXPOSURE_ABSOLUTE, units);
    if (!set) return manual ? set : manual;
  }
  for (const auto& [name, value] : config.controls) {
    const auto id = find_video_control(*api_, fd_, name);
    if (!id)
      return Error{
          fmt::format("{}: found no control {}, wanted one of: {}", path_, name, video_control_names(*api_, fd_))};
    if (const Status set = set_control(name, *id, value); !set) return set;
  }
  return success();
}

Status VideoStream::map_buffers() {
  v4l2_requestbuffers request{};
  request.count = kBuffers;
  request.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  request.memory = V4L2_MEMORY_MMAP;
  if (api_->control(fd_, VIDIOC_REQBUFS, &request) < 0) return refused("VIDIOC_REQBUFS");
  constexpr std::uint32_t kFewest = 2;
  if (request.count < kFewest)
    return Error{fmt::format("{}: found {} buffers, wanted at least {}", path_, request.count, kFewest)};
  for (std::uint32_t i = 0; i < request.count; ++i) {
    if (const Status mapped = map_buffer(i); !mapped) return mapped;
  }
  return success();
}

Status VideoStream::map_buffer(std::uint32_t index) {
  v4l2_buffer buffer = buffer_of(index);
  if (api_->control(fd_, VIDIOC_QUERYBUF, &buffer) < 0) return refused("VIDIOC_QUERYBUF");
  void* const begin = api_->map(fd_, buffer.length, static_cast<off_t>(buffer.m.offset));
  if (begin == nullptr) return refused("mmap");
  buffers_.push_back({begin, buffer.length});
  return success();
}

Status VideoStream::start() {
  for (std::uint32_t i = 0; i < buffers_.size(); ++i) {
    v4l2_buffer buffer = buffer_of(i);
    if (give_back(buffer) != 0) return refused("VIDIOC_QBUF");
  }
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  if (api_->control(fd_, VIDIOC_STREAMON, &type) < 0) return refused("VIDIOC_STREAMON");
  return success();
}

int VideoStream::take(v4l2_buffer& buffer) {
  buffer = buffer_of(0);
  return api_->control(fd_, VIDIOC_DQBUF, &buffer) < 0 ? errno : 0;
}

int VideoStream::give_back(v4l2_buffer& buffer) { return api_->control(fd_, VIDIOC_QBUF, &buffer) < 0 ? errno : 0; }

std::span<const std::uint8_t> VideoStream::content(const v4l2_buffer& buffer) const {
  if (buffer.index >= buffers_.size() || buffer.bytesused > buffers_[buffer.index].bytes) return {};
  return {static_cast<const std::uint8_t*>(buffers_[buffer.index].begin), buffer.bytesused};
}

void VideoStream::take_down() {
  if (fd_ < 0) return;
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  (void)api_->control(fd_, VIDIOC_STREAMOFF, &type);  // of a camera that was pulled out: ENODEV
  for (const Mapped& buffer : buffers_) api_->unmap(buffer.begin, buffer.bytes);
  buffers_.clear();
  api_->close(std::exchange(fd_, -1));
}

}  // namespace lxd
