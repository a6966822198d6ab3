// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/motion/motion_config.hpp"

#include <array>
#include <numbers>

namespace lxd::sim {
namespace {

constexpr std::array<std::string_view, 6> kCarrierNames{"handheld", "uav", "legged", "wheeled", "car", "path"};
constexpr std::array<std::string_view, 4> kFormatNames{"auto", "tum", "ntu_viral", "oxts"};
constexpr std::array<std::string_view, 2> kStarts{"rest", "moving"};

constexpr ValueRange kRest{0, 600, "s", "is it in milliseconds?"};
constexpr ValueRange kSpeed{0.05, 40, "m/s", "is it in km/h?"};
constexpr ValueRange kHeight{0.05, 100, "m", "is it in millimetres?"};
constexpr ValueRange kVigour{0, 3, "", ""};
constexpr ValueRange kFileStart{0, 1e6, "s", "is it the file's own stamp? It counts from the first pose"};
constexpr ValueRange kCutoff{0.05, 10, "Hz", ""};
constexpr ValueRange kOrigin{-1e5, 1e5, "m", ""};

void read_recorded(YamlSection& section, MotionConfig& config) {
  std::string file = config.file.string();
  section.read("file", file);
  config.file = file;
  section.read("format", config.format, kFormatNames);
  section.read("file_start_s", config.file_start_s, kFileStart);
  section.read("level", config.level);
  section.read("cutoff_hz", config.cutoff_hz, kCutoff);
  const auto origin = section.read_numbers("origin", 4, kOrigin);
  if (origin) config.origin = {(*origin)[0], (*origin)[1], (*origin)[2], (*origin)[3] * std::numbers::pi / 180};
}

void read_generated(YamlSection& section, MotionConfig& config) {
  section.read("route", config.route);
  section.read("speed_mps", config.speed_mps, kSpeed);
  section.read("height_m", config.height_m, kHeight);
  section.read("vigour", config.vigour, kVigour);
}

}  // namespace

std::span<const std::string_view> carrier_names() { return kCarrierNames; }
std::span<const std::string_view> path_formats() { return kFormatNames; }

void read_keys(YamlSection& section, MotionConfig& config) {
  section.read("carrier", config.carrier, kCarrierNames);
  std::string start(kStarts[config.start_moving ? 1 : 0]);
  section.read("start", start, kStarts);
  config.start_moving = start == "moving";
  section.read("rest_s", config.rest_s, kRest);
  if (config.carrier == "path") {
    read_recorded(section, config);
    if (config.file.empty()) section.complain("file", "found nothing, wanted the path's file");
  } else {
    read_generated(section, config);
  }
}

}  // namespace lxd::sim
