// SPDX-License-Identifier: Apache-2.0
// See video_controls.hpp.
#include "drivers/camera/video_controls.hpp"

#include <cctype>
#include <cstring>

#include <linux/videodev2.h>

namespace lxd {
namespace {

// The control behind that of the id, in the driver's order; false: there is none. Each id is larger than the one
// before.
bool next_control(SystemCalls& api, int fd, v4l2_queryctrl& control) {
  const std::uint32_t before = control.id;
  control.id |= V4L2_CTRL_FLAG_NEXT_CTRL;
  return api.control(fd, VIDIOC_QUERYCTRL, &control) == 0 && control.id > before;
}

std::string name_of(const v4l2_queryctrl& control) {
  const auto* const name = reinterpret_cast<const char*>(control.name);
  return plain_control_name(std::string(name, strnlen(name, sizeof control.name)));
}

}  // namespace

std::string plain_control_name(std::string_view name) {
  std::string plain;
  for (const char c : name) {
    const bool kept = std::isalnum(static_cast<unsigned char>(c)) != 0;
    if (kept) plain += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (!kept && !plain.empty() && plain.back() != '_') plain += '_';
  }
  while (plain.ends_with('_')) plain.pop_back();
  return plain;
}

std::optional<std::uint32_t> find_video_control(SystemCalls& api, int fd, const std::string& name) {
  for (v4l2_queryctrl control{}; next_control(api, fd, control);) {
    if (name_of(control) == name) return control.id;
  }
  return std::nullopt;
}

std::string video_control_names(SystemCalls& api, int fd) {
  std::string names;
  for (v4l2_queryctrl control{}; next_control(api, fd, control);) {
    if (control.type == V4L2_CTRL_TYPE_CTRL_CLASS) continue;
    names += (names.empty() ? "" : ", ") + name_of(control);
  }
  return names.empty() ? "none" : names;
}

}  // namespace lxd
