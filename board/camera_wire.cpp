// SPDX-License-Identifier: Apache-2.0
#include "board/camera_wire.hpp"

#include <array>
#include <limits>

#include <fmt/format.h>

#include "drivers/camera/frame_timing.hpp"
#include "drivers/camera/pixel_format.hpp"

namespace lxd {
namespace {

constexpr ValueRange kExposure{1e-6, 1, "s", "is it in milliseconds?"};
constexpr ValueRange kReadout{0, 1, "s", "is it in milliseconds?"};

void read_controls(YamlSection& section, CameraWire& wire) {
  const auto node = section.find("controls");
  if (!node) return;
  if (!node->IsMap())
    return section.complain("controls", fmt::format("found {}, wanted names of v4l2-ctl with whole numbers, such as "
                                                    "{{trigger_mode: 1}}",
                                                    describe(*node)));
  for (const auto& pair : *node) {
    const auto name = pair.first.as<std::string>();
    std::int32_t value = 0;
    if (pair.second.IsScalar() && YAML::convert<std::int32_t>::decode(pair.second, value))
      wire.controls.emplace_back(name, value);
    else
      section.complain(pair.second, "controls." + name,
                       fmt::format("found {}, wanted a whole number", describe(pair.second)));
  }
}

}  // namespace

void read_wire(YamlSection& section, CameraWire& wire) {
  section.read("device", wire.device);
  if (!wire.device.empty() && !wire.device.starts_with('/'))
    section.complain("device", fmt::format("found '{}', wanted a path from / on, such as /dev/video0 or one below "
                                           "/dev/v4l/by-id",
                                           wire.device));
  section.read("pixel_format", wire.pixel_format, kPixelFormatNames);
  section.read("exposure_s", wire.exposure_s, kExposure);
  section.read("stamp", wire.stamp, kFrameStampNames);
  section.read("readout_s", wire.readout_s, kReadout);
  read_controls(section, wire);
}

std::string text_of(const CameraWire& wire) {
  const CameraWire none;
  std::string text;
  const auto add = [&](std::string_view key, const auto& value) { text += fmt::format("  {}: {}\n", key, value); };
  if (!wire.device.empty()) add("device", wire.device);
  if (!wire.device.empty() || wire.pixel_format != none.pixel_format) add("pixel_format", wire.pixel_format);
  if (wire.exposure_s > 0) add("exposure_s", wire.exposure_s);
  if (wire.stamp != none.stamp) add("stamp", wire.stamp);
  if (wire.readout_s > 0) add("readout_s", wire.readout_s);
  if (wire.controls.empty()) return text;
  text += "  controls:\n";
  for (const auto& [name, value] : wire.controls) text += fmt::format("    {}: {}\n", name, value);
  return text;
}

}  // namespace lxd
