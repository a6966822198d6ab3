// SPDX-License-Identifier: Apache-2.0
#include "board/camera_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "drivers/camera/pixel_format.hpp"
#include "drivers/device/file_descriptor.hpp"
#include "drivers/replay/camera_folder.hpp"
#include "drivers/replay/growing_file.hpp"

namespace lxd {
namespace {

namespace fs = std::filesystem;
using Bytes = std::span<const std::uint8_t>;

constexpr const char* kFramesHeader = "image,sequence,exposure_begin_s,exposure_s,gain,received_s,corrupt\n";
constexpr mode_t kEveryoneReads = 0644;
constexpr std::size_t kChannels = 3;

Bytes bytes_of(const std::string& text) { return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}; }

std::string seconds_text(std::int64_t ns) {
  return fmt::format("{}.{:09d}", ns / kNanosPerSecond, ns % kNanosPerSecond);
}

// 0 or the error number.
int write_all(int file, Bytes bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(file, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return errno;
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  return 0;
}

// Whole, or not there.
Status write_image(const fs::path& path, Bytes head, Bytes body) {
  const FileDescriptor file(::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, kEveryoneReads));
  int cause = file ? write_all(file.get(), head) : errno;
  if (cause == 0) cause = write_all(file.get(), body);
  if (cause == 0) return success();
  ::unlink(path.c_str());
  return Error{fmt::format("{}: cannot be written: {}", path.string(), std::strerror(cause))};
}

class CameraFile final : public ChunkFile {
 public:
  CameraFile(const CameraRig& rig, fs::path folder, GrowingFile times, GrowingFile frames)
      : rig_(rig),
        format_(*find_pixel_format(fourcc_of_format(rig.wire.pixel_format).value_or(0))),
        timing_(exposure_timing_of(rig.wire)),
        folder_(std::move(folder)),
        times_(std::move(times)),
        frames_(std::move(frames)),
        directory_(::open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {}

  Status append(const Chunk& chunk) override {
    if (!failed_.empty()) return Error{failed_};
    Status done = write(chunk);
    if (done) return done;
    failed_ = done.error().message;
    (void)flush();  // what is whole is kept
    return done;
  }

  // The images are with the system already.
  Status flush() override {
    Status done = frames_.flush();
    if (done) done = times_.flush();
    if (done) acknowledged_ = image_bytes_ + times_.flushed_bytes() + frames_.flushed_bytes();
    return done;
  }
  Status sync() override {
    Status done = flush();
    if (done && ::syncfs(directory_.get()) != 0)
      done = Error{fmt::format("{}: cannot be written: {}", folder_.string(), std::strerror(errno))};
    return done;
  }
  Status close() override {
    Status synced = sync(), listed = frames_.close(), timed = times_.close();
    if (!synced) return synced;
    return listed ? timed : listed;
  }
  [[nodiscard]] std::uint64_t flushed_bytes() override { return acknowledged_; }
  [[nodiscard]] std::uint64_t refused() const override { return refused_; }

 protected:
  [[nodiscard]] GrowingFile& file() override { return times_; }

 private:
  [[nodiscard]] const char* extension() const {
    if (format_ == PixelFormat::mjpeg) return "jpg";
    return format_ == PixelFormat::rgb ? "ppm" : "pgm";
  }

  Status write(const Chunk& chunk) {
    const Bytes pixels = pixels_of(chunk);
    if (pixels.empty()) {
      ++refused_;
      return success();
    }
    const std::string name = fmt::format("{:06d}.{}", count_, extension());
    const std::string head = head_of();
    Status done = write_image(folder_ / name, bytes_of(head), pixels);
    if (!done) return done;
    image_bytes_ += head.size() + pixels.size();
    if (format_ == PixelFormat::yuyv) done = write_colour(chunk);
    if (!done) return done;
    ++count_;
    return list(name, chunk);
  }

  // Beside the luma, which features are followed in as a live run does.
  Status write_colour(const Chunk& chunk) {
    if (chunk.received - coloured_ < kColourPeriod) return success();
    coloured_ = chunk.received;
    auto converter = PixelConverter::create(layout_of(chunk));
    if (!converter) return success();
    pixels_.resize(converter->bgr_bytes());
    if (!converter->to_bgr(chunk.bytes, pixels_)) return success();
    for (std::size_t i = 0; i < pixels_.size(); i += kChannels) std::swap(pixels_[i], pixels_[i + 2]);
    const std::string head = netpbm_head('6');
    image_bytes_ += head.size() + pixels_.size();
    return write_image(folder_ / kColourFolder / fmt::format("{:06d}.ppm", count_), bytes_of(head), pixels_);
  }

  [[nodiscard]] FrameLayout layout_of(const Chunk& chunk) const {
    return {format_, rig_.resolution[0], rig_.resolution[1], chunk.origin.frame.bytes_per_line};
  }

  [[nodiscard]] std::string head_of() const {
    if (format_ == PixelFormat::mjpeg) return {};
    return netpbm_head(format_ == PixelFormat::rgb ? '6' : '5');
  }

  [[nodiscard]] std::string netpbm_head(char kind) const {
    return fmt::format("P{}\n{} {}\n255\n", kind, rig_.resolution[0], rig_.resolution[1]);
  }

  // Without gaps between the lines; empty: shorter than an image.
  Bytes pixels_of(const Chunk& chunk) {
    if (format_ == PixelFormat::mjpeg) return chunk.bytes;
    const FrameLayout layout = layout_of(chunk);
    if (format_ == PixelFormat::rgb) return rgb_of(layout, chunk.bytes);
    auto converter = PixelConverter::create(layout);
    if (!converter) return {};
    pixels_.resize(converter->grey_bytes());
    return converter->to_grey(chunk.bytes, pixels_) ? Bytes(pixels_) : Bytes();
  }

  Bytes rgb_of(const FrameLayout& layout, Bytes frame) {
    const std::size_t row = kChannels * layout.width;
    const std::size_t stride = std::max<std::size_t>(layout.bytes_per_line, row);
    if (layout.height == 0 || frame.size() < stride * (layout.height - 1) + row) return {};
    pixels_.resize(row * layout.height);
    for (std::size_t y = 0; y < layout.height; ++y)
      std::memcpy(pixels_.data() + y * row, frame.data() + y * stride, row);
    return pixels_;
  }

  Status list(const std::string& name, const Chunk& chunk) {
    const FrameOrigin& frame = chunk.origin.frame;
    const std::string begin = seconds_text(timing_.begin(chunk.received, frame.at_start).ns());
    const std::string line = fmt::format("{},{},{},{},,{},0\n", name, frame.sequence, begin,
                                         seconds_text(timing_.exposure.ns()), seconds_text(chunk.received.ns()));
    const std::string time = begin + "\n";
    Status done = frames_.append({bytes_of(line)});
    if (done) done = times_.append({bytes_of(time)});
    return done;
  }

  CameraRig rig_;
  PixelFormat format_;
  ExposureTiming timing_;
  fs::path folder_;
  GrowingFile times_, frames_;
  FileDescriptor directory_;
  std::vector<std::uint8_t> pixels_;
  RigTime coloured_ = kNever;  // the last that was kept in colour
  std::uint64_t count_ = 0, refused_ = 0;
  std::uint64_t image_bytes_ = 0, acknowledged_ = 0;
  std::string failed_;
};

}  // namespace

std::size_t frame_bytes_max(const CameraRig& rig) {
  constexpr std::size_t kBytesPerPixel = 4;  // three of RGB3, and room for gaps between the lines
  return kBytesPerPixel * rig.resolution[0] * rig.resolution[1];
}

ExposureTiming exposure_timing_of(const CameraWire& wire) {
  return {find_frame_stamp(wire.stamp).value_or(FrameStamp::driver), Duration::from_seconds(wire.exposure_s),
          Duration::from_seconds(wire.readout_s)};
}

Result<std::unique_ptr<ChunkFile>> create_camera_file(const CameraRig& rig, const fs::path& folder) {
  std::error_code error;
  const bool luma_alone = rig.wire.pixel_format == "yuyv";
  fs::create_directories(luma_alone ? folder / kColourFolder : folder, error);
  if (error) return Error{fmt::format("{}: cannot be made: {}", folder.string(), error.message())};
  auto times = GrowingFile::create(folder / "times.txt");
  if (!times) return times.error();
  auto frames = GrowingFile::create(folder / "frames.csv");
  if (!frames) return frames.error();
  const std::string header = kFramesHeader;
  if (const Status begun = frames->append({bytes_of(header)}); !begun) return begun.error();
  return Result<std::unique_ptr<ChunkFile>>(
      std::make_unique<CameraFile>(rig, folder, std::move(*times), std::move(*frames)));
}

}  // namespace lxd
