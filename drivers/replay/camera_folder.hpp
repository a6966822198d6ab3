// SPDX-License-Identifier: Apache-2.0
// A camera's part of a recording, image by image:
//   <folder>/000000.png … with times.txt (seconds, a line an image)       rig recordings and generic folders
//   <folder>/data/0000000000.png … with timestamps.txt (dates)            KITTI raw: image_00 … image_03
//   <folder>/000000.png … with times.txt beside the folder                KITTI odometry: image_0 … image_3
// or .jpg, .pgm, .ppm. Where there is a folder colour/, images have their colours there, in a .ppm of the same number,
// or none. In rig recordings frames.csv adds how long each image was exposed and when the host had it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "drivers/camera/frame_timing.hpp"
#include "drivers/replay/image_file.hpp"
#include "drivers/replay/rejections.hpp"
#include "drivers/replay/stamp_gate.hpp"
#include "drivers/replay/times_file.hpp"
#include "rt/result.hpp"
#include "rt/time.hpp"

namespace lxd {

inline constexpr const char* kColourFolder = "colour";

struct CameraImage {
  RigTime stamp;                    // of the exposure's begin, as the recording tells it
  Duration exposure;                // zero: not known
  std::optional<RigTime> received;  // at the host: the kernel's stamp, where that is known
  RigTime instant;                  // that it is of: its exposure's middle, told by its trigger where there is one
  std::uint32_t number = 0;         // of the image's file
  std::filesystem::path colours;    // the file that has them; empty: none has, or the image is live
  std::optional<double> gain;       // of the sensor, where that is known
  GreyPixels pixels;
};

class CameraFolder {
 public:
  // KITTI raw's dates are counted from `kitti_zero`: the first sound stamp of the drive's Velodyne; by default the
  // first of its timestamps.txt. Errors name the file: no times, a line that is none, no image at all.
  static Result<CameraFolder> open(const std::filesystem::path& folder, std::optional<RigTime> kitti_zero = {});

  // From now on images are of the edges that triggered them, all those of the recording, in order.
  void use_triggers(const TriggerTiming& timing, std::vector<RigTime> edges);

  // The next image that can be read, in the order of time. False: the recording has ended. Missing and broken files,
  // lines without a time and times that go back are counted and passed over.
  bool next(CameraImage& image);

  [[nodiscard]] std::size_t size() const { return stamps_.size(); }  // times, that is images at most
  [[nodiscard]] const std::string& kind() const { return kind_; }    // "camera-folder", "kitti-raw", "kitti-odometry"
  // missing_image, broken_image, time_missing, time_backwards, time_repeated, image_without_time; and what the triggers
  // did not fit.
  [[nodiscard]] Rejections rejected() const;

 private:
  struct Exposure {
    Duration span;
    std::optional<RigTime> received;
    std::optional<double> gain;
  };

  CameraFolder() = default;
  Status find_images(const std::filesystem::path& folder);
  void read_exposures(const std::filesystem::path& file);
  [[nodiscard]] RigTime instant_of(const CameraImage& image);
  [[nodiscard]] std::filesystem::path colours_of(const std::filesystem::path& image) const;

  std::string kind_;
  std::filesystem::path colour_folder_;                   // empty: the images themselves have their colours
  std::map<std::uint32_t, std::filesystem::path> files_;  // by number
  std::map<std::uint32_t, Exposure> exposures_;
  StampLines stamps_;
  std::size_t next_ = 0;
  StampGate gate_;
  FrameClock clock_;
  Duration patience_;
  std::vector<RigTime> edges_;  // of the triggers
  std::size_t next_edge_ = 0;
  Rejections rejected_;
};

}  // namespace lxd
