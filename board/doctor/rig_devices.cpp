// SPDX-License-Identifier: Apache-2.0
#include "board/doctor/rig_devices.hpp"

#include <cerrno>
#include <cstring>

#include <fmt/format.h>
#include <unistd.h>

namespace lxd {
namespace {

namespace fs = std::filesystem;

// What is to be done when it is not there, and the group that its rights go by.
struct DeviceKind {
  const char* wanted;
  const char* mend;
  const char* group;
};
constexpr DeviceKind kSerialKind{"a serial device", "plug it in; ls -l /dev/serial/by-id names those that there are",
                                 "dialout"};
constexpr DeviceKind kCameraKind{"a V4L2 camera", "plug it in; ls -l /dev/v4l/by-id names those that there are",
                                 "video"};
constexpr DeviceKind kPulseKind{
    "a pulse source", "modprobe pps-gpio with a line in the device tree, or ldattach 18 on a serial line", "dialout"};
constexpr DeviceKind kGpioKind{"a GPIO chip", "gpiodetect names those that there are", "gpio"};

Finding not_usable(const std::string& subject, std::string found, std::string mend) {
  return {Verdict::lack, subject, std::move(found), std::move(mend)};
}

Finding look_at(const std::string& subject, const std::string& path, const DeviceKind& kind, const fs::path& root) {
  const fs::path file = root / fs::path(path).relative_path();
  if (::access(file.c_str(), R_OK | W_OK) == 0) return {Verdict::good, subject, path, {}};
  if (errno == EACCES)
    return not_usable(subject, fmt::format("{}: may not be read and written", path),
                      fmt::format("adduser $USER {}, log in anew; board/system has udev rules", kind.group));
  return not_usable(subject, fmt::format("{}: {}; wanted {}", path, std::strerror(errno), kind.wanted), kind.mend);
}

// By its name or path; of a label only libgpiod knows the chip.
Finding look_at(const std::string& subject, const GpioWire& wire, const fs::path& root) {
  const bool named = wire.chip.starts_with("gpiochip"), path = wire.chip.starts_with('/');
  if (!named && !path)
    return {Verdict::advice, subject, fmt::format("a chip labelled {}: not looked for", wire.chip),
            "gpiodetect names chips by label; a name such as gpiochip0 can be looked for"};
  Finding finding = look_at(subject, path ? wire.chip : "/dev/" + wire.chip, kGpioKind, root);
  finding.found += fmt::format(", line {}", wire.line.value_or(0));
  return finding;
}

Finding look_at_bus(const std::string& interface, const fs::path& root) {
  std::error_code ignored;
  if (fs::exists(root / "sys/class/net" / interface, ignored)) return {Verdict::good, "wheel", interface, {}};
  return not_usable("wheel", fmt::format("no network interface {}", interface),
                    fmt::format("ip link set {} up type can bitrate 500000, once its adapter is there", interface));
}

}  // namespace

std::vector<Finding> diagnose_devices(const Rig& rig, const fs::path& root) {
  std::vector<Finding> findings;
  if (rig.imu && rig.imu->wire.device.starts_with('/'))
    findings.push_back(look_at("imu", rig.imu->wire.device, kSerialKind, root));
  if (rig.gnss && !rig.gnss->wire.device.empty())
    findings.push_back(look_at("gnss", rig.gnss->wire.device, kSerialKind, root));
  if (rig.wheel && !rig.wheel->wire.interface.empty()) findings.push_back(look_at_bus(rig.wheel->wire.interface, root));
  if (rig.camera0 && !rig.camera0->wire.device.empty())
    findings.push_back(look_at("camera0", rig.camera0->wire.device, kCameraKind, root));
  if (rig.pps && !rig.pps->device.empty()) findings.push_back(look_at("pps", rig.pps->device, kPulseKind, root));
  if (rig.pps && rig.pps->gpio.given()) findings.push_back(look_at("pps", rig.pps->gpio, root));
  if (rig.triggers && rig.triggers->camera0.given())
    findings.push_back(look_at("triggers", rig.triggers->camera0, root));
  return findings;
}

}  // namespace lxd
