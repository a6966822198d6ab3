// SPDX-License-Identifier: Apache-2.0
#include "tools/import/image_writer.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "backend/trajectory_writer.hpp"
#include "drivers/replay/image_file.hpp"
#include "drivers/ros1/picture.hpp"
#include "tools/recording/png_writer.hpp"
#include "tools/recording/whole_file.hpp"

namespace lxd {
namespace {

namespace fs = std::filesystem;

// Red first, without gaps between rows.
void copy_pixels(const Ros1Picture& picture, PixelImage& out) {
  out.width = static_cast<int>(picture.width);
  out.height = static_cast<int>(picture.height);
  out.channels = static_cast<int>(picture.channels);
  out.data.clear();
  for (std::uint32_t y = 0; y < picture.height; ++y) {
    const Ros1Reader::Bytes row = picture.row(y);
    out.data.insert(out.data.end(), row.begin(), row.end());
  }
  if (picture.channels == 1 || !picture.blue_first) return;
  for (std::size_t i = 0; i < out.data.size(); i += picture.channels) std::swap(out.data[i], out.data[i + 2]);
}

class ImageWriter final : public MessageWriter {
 public:
  ImageWriter(MessageKind kind, fs::path folder) : kind_(kind), folder_(std::move(folder)) {}

  Status close() override {
    return write_whole_file(folder_ / "times.txt", std::as_bytes(std::span(times_.data(), times_.size())));
  }

 private:
  Result<Ros1Fault> write(Ros1Reader::Bytes message, RigTime received) override {
    return kind_ == MessageKind::picture ? write_raw(message, received) : write_compressed(message, received);
  }

  Result<Ros1Fault> write_raw(Ros1Reader::Bytes message, RigTime received) {
    Ros1Picture picture;
    const Ros1Fault fault = read_ros1_picture(message, picture);
    if (fault == Ros1Fault::unknown_encoding)
      ++counts_.remarks[fmt::format("found images of the encoding \"{}\", wanted mono8, 8UC1, bgr8 or rgb8",
                                    picture.encoding.substr(0, kLongestExcerpt))];
    if (fault != Ros1Fault::none) return fault;
    copy_pixels(picture, pixels_);
    return keep(write_png(next_file(".png"), pixels_), picture.header, received);
  }

  // As it came: decoding and encoding again would lose pixels and time. Read once, since what cannot be is no image.
  Result<Ros1Fault> write_compressed(Ros1Reader::Bytes message, RigTime received) {
    Ros1CompressedPicture picture;
    const Ros1Fault fault = read_ros1_compressed_picture(message, picture);
    if (fault != Ros1Fault::none) return fault;
    const fs::path file = next_file(picture.compression == Ros1Compression::png ? ".png" : ".jpg");
    const Status written = write_whole_file(file, std::as_bytes(picture.data));
    if (written && !read_image(file, decoded_)) {
      std::error_code ignored;
      fs::remove(file, ignored);
      return Ros1Fault::bad_layout;
    }
    return keep(written, picture.header, received);
  }

  Result<Ros1Fault> keep(const Status& written, const Ros1Header& header, RigTime received) {
    if (!written) return written.error();
    times_ += seconds_text(time_of(header, received)) + "\n";
    return Ros1Fault::none;
  }

  [[nodiscard]] fs::path next_file(const char* extension) const {
    return folder_ / fmt::format("{:06}{}", counts_.written, extension);
  }

  static constexpr std::size_t kLongestExcerpt = 40;

  MessageKind kind_;
  fs::path folder_;
  PixelImage pixels_;
  GreyPixels decoded_;
  std::string times_;
};

}  // namespace

Result<std::unique_ptr<MessageWriter>> make_image_writer(const TopicChoice& choice,
                                                         const std::filesystem::path& folder) {
  const fs::path images = folder / choice.sensor;
  std::error_code cause;
  fs::create_directories(images, cause);
  if (cause) return Error{fmt::format("{}: cannot be made: {}", images.string(), cause.message())};
  return std::unique_ptr<MessageWriter>(std::make_unique<ImageWriter>(choice.kind, images));
}

}  // namespace lxd
