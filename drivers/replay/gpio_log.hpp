// SPDX-License-Identifier: Apache-2.0
// `gpio.csv` of a recording: edges of the lines that pulse or trigger sensors, as the kernel's line events have them,
// stamped on the rig's clock (unix ns).
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "rt/result.hpp"
#include "rt/time.hpp"

namespace lxd {

inline constexpr const char* kGpioLogFile = "gpio.csv";
inline constexpr const char* kGpioLogHeader = "timestamp_ns,offset,line,edge,seqno,line_seqno";

inline constexpr const char* kCameraLine = "camera0";  // the line of its triggers

// The edges of one line and one direction, in the file's order. Errors name file and line: a missing file, a wrong
// header, a line that is no edge.
Result<std::vector<RigTime>> read_gpio_edges(const std::filesystem::path& path, std::string_view line, bool rising);

}  // namespace lxd
