// SPDX-License-Identifier: Apache-2.0
// What a rig file says of its time signals: the pulse per second with the sensors whose clocks it is at the whole
// seconds of, and the lines by which the sync microcontroller triggers sensors.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "board/yaml_section.hpp"
#include "drivers/replay/options.hpp"

namespace lxd {

struct Rig;

// A line of a GPIO chip, as libgpiod finds it.
struct GpioWire {
  std::string chip;                   // "gpiochip0", its path, or its label; empty: not given
  std::optional<std::uint32_t> line;  // its offset

  [[nodiscard]] bool given() const { return !chip.empty() && line.has_value(); }
};

// The section pps.
struct PulseRig {
  std::string device;                // "/dev/pps0"; or else
  GpioWire gpio;                     // chip, line
  std::string edge = "assert";       // | clear: that at which the second begins; of a GPIO line the rising one asserts
  std::vector<std::string> sensors;  // lidar0, lidar1, imu: those whose clocks are at whole seconds with the pulse

  [[nodiscard]] bool wired() const { return !device.empty() || gpio.given(); }
  [[nodiscard]] bool of(std::string_view sensor) const;
};

// The section triggers. The line's key is the sensor's name.
struct TriggersRig {
  GpioWire camera0;             // chip, camera0
  std::string edge = "rising";  // | falling: that which triggers
  double to_exposure_s = 0;     // from the edge until the exposure begins
  // From the edge to the frame's stamp, within which an edge may be a frame's.
  double delay_min_s = 0, delay_max_s = 0.06;
};

void read_keys(YamlSection& section, PulseRig& pulse);
void read_keys(YamlSection& section, TriggersRig& triggers);

std::string rig_text(const PulseRig& pulse);
std::string rig_text(const TriggersRig& triggers);

// Whose clocks are at whole seconds with the rig's pulse.
PulsedSensors pulsed_sensors(const Rig& rig);

// What does not agree with the rig's other sections, a sentence each.
std::vector<std::string> sync_problems(const Rig& rig);

}  // namespace lxd
