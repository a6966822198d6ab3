// SPDX-License-Identifier: Apache-2.0
#include "board/sensor_set.hpp"

#include <fmt/format.h>

namespace lxd {
namespace {

bool* member(SensorSet& sensors, char letter) {
  switch (letter) {
    case 'L':
      return &sensors.extra_lidar;
    case 'C':
      return &sensors.camera;
    case 'I':
      return &sensors.imu;
    case 'W':
      return &sensors.wheel;
    case 'G':
      return &sensors.gnss;
    default:
      return nullptr;
  }
}

Error bad_set(std::string_view text) {
  return Error{fmt::format("--sensors: found '{}', wanted L or LL, then any of C, I, W and G once each", text)};
}

}  // namespace

Result<SensorSet> parse_sensor_set(std::string_view text) {
  if (!text.starts_with('L')) return bad_set(text);
  SensorSet sensors;
  for (std::size_t i = 1; i < text.size(); ++i) {
    bool* const sensor = member(sensors, text[i]);
    const bool misplaced = text[i] == 'L' && i != 1;
    if (sensor == nullptr || *sensor || misplaced) return bad_set(text);
    *sensor = true;
  }
  return sensors;
}

std::string text_of(const SensorSet& sensors) {
  std::string text = sensors.extra_lidar ? "LL" : "L";
  if (sensors.camera) text += 'C';
  if (sensors.imu) text += 'I';
  if (sensors.wheel) text += 'W';
  if (sensors.gnss) text += 'G';
  return text;
}

}  // namespace lxd
