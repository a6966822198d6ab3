// SPDX-License-Identifier: Apache-2.0
// See camera_folder.hpp. KITTI's layouts: Geiger et al., "Vision meets Robotics: The KITTI Dataset", IJRR 2013, and the
// development kits of the raw data and of the odometry benchmark.
#include "drivers/replay/camera_folder.hpp"

#include <charconv>
#include <cmath>
#include <fstream>
#include <string_view>

#include <fmt/format.h>

#include "drivers/replay/time_leaps.hpp"

namespace lxd {
namespace {

namespace fs = std::filesystem;

struct Layout {
  std::string kind;
  fs::path images, times;
};

Layout layout_of(const fs::path& folder) {
  if (fs::exists(folder / "timestamps.txt")) return {"kitti-raw", folder / "data", folder / "timestamps.txt"};
  if (!fs::exists(folder / "times.txt") && fs::exists(folder.parent_path() / "times.txt"))
    return {"kitti-odometry", folder, folder.parent_path() / "times.txt"};
  return {"camera-folder", folder, folder / "times.txt"};
}

bool is_image(const fs::path& extension) {
  return extension == ".png" || extension == ".jpg" || extension == ".pgm" || extension == ".ppm";
}

std::optional<std::uint32_t> number_of(std::string_view text) {
  std::uint32_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

// Dates on the rig's clock: counted from the drive's first sound sweep.
void count_from(RigTime zero, StampLines& stamps) {
  for (auto& stamp : stamps) {
    if (stamp) stamp = RigTime() + (*stamp - zero);
  }
}

RigTime zero_of_drive(const fs::path& camera, const StampLines& stamps) {
  const fs::path velodyne = camera.parent_path() / "velodyne_points" / "timestamps.txt";
  if (fs::exists(velodyne)) {
    const auto sweeps = read_dates_file(velodyne);
    if (sweeps) return first_sound_stamp(*sweeps);
  }
  return first_sound_stamp(stamps);
}

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> fields;
  while (true) {
    const std::size_t comma = line.find(',');
    fields.push_back(line.substr(0, comma));
    if (comma == std::string_view::npos) return fields;
    line.remove_prefix(comma + 1);
  }
}

std::optional<double> gain_of(std::string_view text) {
  double gain = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), gain);
  const bool sound = error == std::errc() && end == text.data() + text.size() && gain > 0 && std::isfinite(gain);
  return sound ? std::optional(gain) : std::nullopt;
}

}  // namespace

Result<CameraFolder> CameraFolder::open(const fs::path& folder, std::optional<RigTime> kitti_zero) {
  const fs::path plain = folder.has_filename() ? folder : folder.parent_path();  // "camera0/" has an empty last part
  const Layout layout = layout_of(plain);
  CameraFolder camera;
  camera.kind_ = layout.kind;
  auto stamps = layout.kind == "kitti-raw" ? read_dates_file(layout.times) : read_seconds_file(layout.times);
  if (!stamps) return stamps.error();
  camera.stamps_ = std::move(*stamps);
  if (layout.kind == "kitti-raw") {
    const RigTime zero = kitti_zero ? *kitti_zero : zero_of_drive(plain, camera.stamps_);
    count_from(zero, camera.stamps_);
  }
  if (Status status = camera.find_images(layout.images); !status) return status.error();
  camera.read_exposures(plain / "frames.csv");
  if (fs::exists(plain / kColourFolder)) camera.colour_folder_ = plain / kColourFolder;
  return camera;
}

Status CameraFolder::find_images(const fs::path& folder) {
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const auto number = number_of(entry->path().stem().string());
    if (!number || !is_image(entry->path().extension())) continue;
    files_[*number] = entry->path();
    if (*number >= stamps_.size()) count_rejected(rejected_, "image_without_time");
  }
  if (error) return Error{fmt::format("{}: cannot be read: {}", folder.string(), error.message())};
  if (files_.empty()) return Error{fmt::format("{}: found no image, wanted 000000.png and so on", folder.string())};
  return success();
}

fs::path CameraFolder::colours_of(const fs::path& image) const {
  if (colour_folder_.empty()) return image;
  const fs::path colours = colour_folder_ / image.stem().concat(".ppm");
  return fs::exists(colours) ? colours : fs::path();
}

// "image,sequence,exposure_begin_s,exposure_s,gain,received_s,corrupt" and a line an image. It only adds to what is
// known without it, so that what cannot be understood is left out.
void CameraFolder::read_exposures(const fs::path& file) {
  constexpr std::size_t kImage = 0, kExposure = 3, kGain = 4, kReceived = 5, kFields = 6;
  std::ifstream lines(file);
  for (std::string line; std::getline(lines, line);) {
    const auto fields = split(line);
    if (fields.size() < kFields) continue;
    const auto number = number_of(fields[kImage].substr(0, fields[kImage].find('.')));
    const auto exposure = parse_seconds(fields[kExposure]);
    if (number && exposure)
      exposures_[*number] = {*exposure - RigTime(), parse_seconds(fields[kReceived]), gain_of(fields[kGain])};
  }
}

void CameraFolder::use_triggers(const TriggerTiming& timing, std::vector<RigTime> edges) {
  clock_ = FrameClock(timing);
  patience_ = timing.patience;
  edges_ = std::move(edges);
  next_edge_ = 0;
}

// By then all of its edges have come that ever will.
RigTime CameraFolder::instant_of(const CameraImage& image) {
  const RigTime stamp = image.received.value_or(image.stamp + image.exposure);
  for (; next_edge_ < edges_.size() && edges_[next_edge_] <= stamp; ++next_edge_)
    clock_.add_trigger(edges_[next_edge_]);
  return clock_.instant(image.stamp, image.exposure, stamp, stamp + patience_).value_or(image.stamp);
}

Rejections CameraFolder::rejected() const {
  Rejections rejected = rejected_;
  count_triggers(clock_, rejected);
  return rejected;
}

bool CameraFolder::next(CameraImage& image) {
  while (next_ < stamps_.size()) {
    const auto number = static_cast<std::uint32_t>(next_++);
    const auto& stamp = stamps_[number];
    const auto file = files_.find(number);
    if (file == files_.end()) {
      count_rejected(rejected_, "missing_image");
    } else if (gate_.admit(stamp, rejected_)) {
      image.stamp = *stamp;
      image.number = number;
      const auto exposure = exposures_.find(number);
      image.exposure = exposure == exposures_.end() ? Duration() : exposure->second.span;
      image.received = exposure == exposures_.end() ? std::nullopt : exposure->second.received;
      image.gain = exposure == exposures_.end() ? std::nullopt : exposure->second.gain;
      image.colours = colours_of(file->second);
      image.instant = instant_of(image);
      if (read_image(file->second, image.pixels)) return true;
      count_rejected(rejected_, "broken_image");
    }
  }
  return false;
}

}  // namespace lxd
