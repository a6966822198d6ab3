// SPDX-License-Identifier: Apache-2.0
// What a live rig's file says of its camera besides: the V4L2 device, how it is to expose, and what its stamps mean.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "board/yaml_section.hpp"

namespace lxd {

struct Rig;

// Below camera0. A replay looks at `stamp` alone: a recording of the rig has the times of its triggers.
struct CameraWire {
  std::string device;                 // "/dev/video0", best below /dev/v4l/by-id; empty: not given
  std::string pixel_format = "yuyv";  // kPixelFormatNames
  double exposure_s = 0;              // 0: the camera's own choice, which is not known
  std::string stamp = "driver";       // kFrameStampNames
  double readout_s = 0;               // from the exposure's end to a stamp at the frame's end
  std::vector<std::pair<std::string, std::int32_t>> controls;  // by the names of v4l2-ctl

  [[nodiscard]] bool by_triggers() const { return stamp == "trigger"; }
};

void read_wire(YamlSection& section, CameraWire& wire);
// The lines of a rig file, two blanks in front of each; what is not given is left out.
std::string text_of(const CameraWire& wire);

}  // namespace lxd
