// SPDX-License-Identifier: Apache-2.0
// A video device that streams into buffers mapped from the kernel: opened, set up, and taken down again. What a V4L2
// camera holds while it is there.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <linux/videodev2.h>

#include "drivers/camera/pixel_format.hpp"
#include "drivers/device/system_calls.hpp"
#include "rt/result.hpp"

namespace lxd {

struct VideoConfig {
  std::string path;                     // "/dev/video0"; best one below /dev/v4l/by-id
  std::uint32_t fourcc = 0;             // a format that find_pixel_format() knows
  std::uint32_t width = 0, height = 0;  // pixels
  double rate_hz = 0;                   // 0: as the camera has it, or by a trigger
  std::optional<double> exposure_s{};   // none: the camera's own choice stays
  // By the names that v4l2-ctl lists: the driver's own, in lower case with underscores ("trigger_mode", "gain").
  std::vector<std::pair<std::string, std::int32_t>> controls{};
};

class VideoStream {
 public:
  // Error: what was refused, by which call, found and wanted.
  static Result<VideoStream> open(const VideoConfig& config, SystemCalls& api);
  VideoStream(VideoStream&& other) noexcept;
  VideoStream& operator=(VideoStream&& other) noexcept;
  ~VideoStream();

  [[nodiscard]] int fd() const { return fd_; }
  [[nodiscard]] const FrameLayout& layout() const { return layout_; }
  // The next buffer that is filled; the caller gives it back. 0 or the error number (EAGAIN: none is).
  int take(v4l2_buffer& buffer);
  int give_back(v4l2_buffer& buffer);
  // What of a taken buffer is filled; empty: the kernel names none of ours.
  [[nodiscard]] std::span<const std::uint8_t> content(const v4l2_buffer& buffer) const;

 private:
  struct Mapped {
    void* begin = nullptr;
    std::size_t bytes = 0;
  };
  static constexpr std::uint32_t kBuffers = 4;  // one with the reader, one being filled, two waiting

  VideoStream(int fd, SystemCalls& api) : api_(&api), fd_(fd) {}
  Status set_up(const VideoConfig& config);
  Status check_abilities();
  Status choose_format(const VideoConfig& config);
  Status choose_rate(double rate_hz);
  Status set_controls(const VideoConfig& config);
  Status set_control(const std::string& name, std::uint32_t id, std::int32_t value);
  Status map_buffers();
  Status map_buffer(std::uint32_t index);
  Status start();
  void take_down();
  [[nodiscard]] Error refused(const std::string& what) const;

  SystemCalls* api_;
  int fd_ = -1;
  std::string path_;
  FrameLayout layout_;
  std::vector<Mapped> buffers_;
};

}  // namespace lxd
