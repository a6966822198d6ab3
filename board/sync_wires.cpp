// SPDX-License-Identifier: Apache-2.0
#include "board/sync_wires.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "board/rig.hpp"

namespace lxd {
namespace {

constexpr std::array<std::string_view, 2> kPulseEdges{"assert", "clear"};
constexpr std::array<std::string_view, 2> kTriggerEdges{"rising", "falling"};
constexpr std::array<std::string_view, 3> kPulseSensors{"lidar0", "lidar1", "imu"};
constexpr ValueRange kLine{0, 1023, "", "is it the kernel's global number? wanted the line's within its chip"};
constexpr ValueRange kDelay{0, 1, "s", "is it in milliseconds?"};

void read_gpio(YamlSection& section, std::string_view line_key, GpioWire& gpio) {
  section.read("chip", gpio.chip);
  std::uint32_t line = 0;
  section.read(line_key, line, kLine);
  if (section.has(line_key)) gpio.line = line;
  if (!gpio.chip.empty() && !gpio.line)
    section.complain("chip", fmt::format("found it without {}, wanted the number of its line, too", line_key));
  if (gpio.chip.empty() && gpio.line)
    section.complain(line_key, "found it without chip, wanted the chip that it is a line of, such as gpiochip0");
}

void read_sensors(YamlSection& section, std::vector<std::string>& sensors) {
  const auto node = section.find("sensors");
  if (!node) return;
  const auto wanted = fmt::format("wanted a list of {}", fmt::join(kPulseSensors, ", "));
  if (!node->IsSequence()) return section.complain("sensors", fmt::format("found {}, {}", describe(*node), wanted));
  for (const auto& each : *node) {
    const std::string name = each.IsScalar() ? each.Scalar() : std::string();
    if (std::ranges::find(kPulseSensors, name) == kPulseSensors.end())
      section.complain(each, "sensors", fmt::format("found {}, {}", describe(each), wanted));
    else
      sensors.push_back(name);
  }
}

std::string text_of(const GpioWire& gpio, std::string_view line_key) {
  if (!gpio.given()) return {};
  return fmt::format("  chip: {}\n  {}: {}\n", gpio.chip, line_key, *gpio.line);
}

bool same_line(const GpioWire& a, const GpioWire& b) {
  return a.given() && b.given() && a.chip == b.chip && *a.line == *b.line;
}

}  // namespace

bool PulseRig::of(std::string_view sensor) const { return std::ranges::find(sensors, sensor) != sensors.end(); }

void read_keys(YamlSection& section, PulseRig& pulse) {
  section.read("device", pulse.device);
  if (!pulse.device.empty() && !pulse.device.starts_with('/'))
    section.complain(
        "device",
        fmt::format("found '{}', wanted a path from / on, such as /dev/pps0; or chip and line instead", pulse.device));
  read_gpio(section, "line", pulse.gpio);
  if (!pulse.device.empty() && section.has("chip"))
    section.complain("chip", "found it beside device, wanted one of the two: one pulse comes in by one way");
  section.read("edge", pulse.edge, kPulseEdges);
  read_sensors(section, pulse.sensors);
}

void read_keys(YamlSection& section, TriggersRig& triggers) {
  read_gpio(section, "camera0", triggers.camera0);
  section.read("edge", triggers.edge, kTriggerEdges);
  section.read("to_exposure_s", triggers.to_exposure_s, kDelay);
  section.read("delay_min_s", triggers.delay_min_s, kDelay);
  section.read("delay_max_s", triggers.delay_max_s, kDelay);
  if (triggers.delay_min_s >= triggers.delay_max_s)
    section.complain("delay_max_s", fmt::format("found {}, wanted more than delay_min_s, {}", triggers.delay_max_s,
                                                triggers.delay_min_s));
}

std::string rig_text(const PulseRig& pulse) {
  std::string text = "pps:\n";
  if (!pulse.device.empty()) text += fmt::format("  device: {}\n", pulse.device);
  text += text_of(pulse.gpio, "line");
  return text + fmt::format("  edge: {}\n  sensors: [{}]\n", pulse.edge, fmt::join(pulse.sensors, ", "));
}

std::string rig_text(const TriggersRig& triggers) {
  return fmt::format("triggers:\n{}  edge: {}\n  to_exposure_s: {}\n  delay_min_s: {}\n  delay_max_s: {}\n",
                     text_of(triggers.camera0, "camera0"), triggers.edge, triggers.to_exposure_s, triggers.delay_min_s,
                     triggers.delay_max_s);
}

PulsedSensors pulsed_sensors(const Rig& rig) {
  if (!rig.pps) return {};
  return {rig.pps->of("lidar0"), rig.pps->of("lidar1"), rig.pps->of("imu")};
}

std::vector<std::string> sync_problems(const Rig& rig) {
  std::vector<std::string> problems;
  if (rig.camera0 && rig.camera0->wire.by_triggers() && !rig.triggers)
    problems.emplace_back("camera0.stamp: found trigger in a rig without a section triggers; wanted its line there");
  if (rig.pps && rig.triggers && same_line(rig.pps->gpio, rig.triggers->camera0))
    problems.push_back(fmt::format("triggers.camera0: found line {} of {}, which pps has too; wanted another",
                                   *rig.pps->gpio.line, rig.pps->gpio.chip));
  if (!rig.pps) return problems;
  if (rig.pps->of("lidar1") && !rig.lidar1)
    problems.emplace_back("pps.sensors: found lidar1, wanted sensors of this rig");
  if (rig.pps->of("imu") && !rig.imu) problems.emplace_back("pps.sensors: found imu, wanted sensors of this rig");
  if (rig.pps->of("imu") && rig.imu && rig.imu->of_lidar())
    problems.emplace_back("pps.sensors: found imu, wanted lidar0: this IMU goes by the LiDAR's clock");
  return problems;
}

}  // namespace lxd
