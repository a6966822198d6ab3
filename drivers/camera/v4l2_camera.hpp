// SPDX-License-Identifier: Apache-2.0
// A V4L2 camera that may be pulled out and put in again. Its frames come with the kernel's stamps on the rig's clock,
// and with the word whether those are of the exposure's start or of the frame's end.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "drivers/camera/video_stream.hpp"
#include "drivers/device/device.hpp"
#include "drivers/device/host_clock.hpp"
#include "drivers/device/reopening.hpp"

namespace lxd {

enum class FrameInstant : std::uint8_t {
  end_of_frame,      // its last pixel was taken in
  start_of_exposure  // as USB cameras say
};

// Of the frame that a chunk holds.
struct FrameFacts {
  RigTime stamp;
  FrameInstant instant = FrameInstant::end_of_frame;
  std::uint32_t sequence = 0;  // the driver's count since it began
};

struct CameraCounts {
  std::uint64_t frames = 0;       // delivered
  std::uint64_t lost = 0;         // by gaps in the driver's count
  std::uint64_t corrupt = 0;      // the driver says that they may be: left out
  std::uint64_t other_clock = 0;  // not stamped by the monotonic clock: left out
  std::uint64_t empty = 0;        // without content, or larger than their buffer: left out
};
inline constexpr std::array<std::pair<const char*, std::uint64_t CameraCounts::*>, 5> kCameraCountNames{{
    {"frames", &CameraCounts::frames},
    {"lost", &CameraCounts::lost},
    {"corrupt", &CameraCounts::corrupt},
    {"other_clock", &CameraCounts::other_clock},
    {"empty", &CameraCounts::empty},
}};

class V4l2Camera final : public Device {
 public:
  // Away until tend() opens it. `clock` and `api` outlive the camera.
  V4l2Camera(VideoConfig config, std::uint8_t channel, const HostClock& clock, SystemCalls& api = kernel_calls())
      : config_(std::move(config)), channel_(channel), clock_(clock), api_(api) {}

  [[nodiscard]] const std::string& name() const override { return config_.path; }
  [[nodiscard]] int fd() const override { return stream_ ? stream_->fd() : -1; }
  // A chunk a frame, its bytes the kernel's own buffer; received is the frame's stamp, origin.frame its facts.
  void read(ChunkSink& sink) override;
  void tend(RigTime now) override;
  [[nodiscard]] const std::string& trouble() const override { return trouble_; }
  [[nodiscard]] const DeviceCounts& counts() const override { return counts_; }
  void add_counts(std::map<std::string, std::uint64_t>& counts) const override;

  // During take(): of the frame that is being delivered.
  [[nodiscard]] const FrameFacts& frame() const { return frame_; }
  // For the converter of the frames; none before the camera was there.
  [[nodiscard]] const std::optional<FrameLayout>& layout() const { return layout_; }
  [[nodiscard]] const CameraCounts& camera_counts() const { return camera_counts_; }

 private:
  bool read_one(ChunkSink& sink);
  void deliver(const v4l2_buffer& buffer, ChunkSink& sink);
  void count_lost(std::uint32_t sequence);
  void leave(std::string why);

  VideoConfig config_;
  std::uint8_t channel_;
  const HostClock& clock_;
  SystemCalls& api_;
  std::optional<VideoStream> stream_;
  std::optional<FrameLayout> layout_;
  std::optional<std::uint32_t> last_sequence_;
  int failures_ = 0;  // in a row
  FrameFacts frame_;
  Reopening reopening_;
  std::string trouble_ = "not opened yet";
  DeviceCounts counts_;
  CameraCounts camera_counts_;
};

}  // namespace lxd
