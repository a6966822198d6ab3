// SPDX-License-Identifier: Apache-2.0
// A camera's controls by name. V4L2 has no common one for triggers: each driver calls it its own way, and v4l2-ctl
// lists what there is.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "drivers/device/system_calls.hpp"

namespace lxd {

// As v4l2-ctl writes a control's name: "Trigger Mode" is trigger_mode.
std::string plain_control_name(std::string_view name);

// The id of the control of that plain name; none: the camera has none.
std::optional<std::uint32_t> find_video_control(SystemCalls& api, int fd, const std::string& name);
// All of them, plain, parted by commas.
std::string video_control_names(SystemCalls& api, int fd);

}  // namespace lxd
