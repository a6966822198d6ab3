// SPDX-License-Identifier: Apache-2.0
// What a scenario says of a camera.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "board/yaml_section.hpp"
#include "rt/pose.hpp"
#include "tools/simulator/camera/camera_model.hpp"
#include "tools/simulator/clock.hpp"

namespace lxd::sim {

enum class CameraTrigger { kFree, kSync };

struct CameraConfig {
  std::string name = "camera0";                                      // its folder, and its stream of chance
  std::array<std::uint32_t, 2> resolution{640, 480};                 // width, height; pixels
  std::array<double, 4> intrinsics{420, 420, 319.5, 239.5};          // fx, fy, cx, cy; pixels
  std::string distortion_model = "radtan";                           // radtan | equidistant | none
  std::array<double, 4> distortion_coeffs{-0.28, 0.07, 2e-4, 2e-5};  // k1, k2, p1, p2 (radtan); k1 .. k4 (equidistant)
  bool colour = false;                                               // 8-bit RGB; otherwise 8-bit grey

  double rate_hz = 10;
  // Free: by its own clock, at any phase. Sync: triggered at whole periods of the rig's second.
  CameraTrigger trigger = CameraTrigger::kSync;
  bool auto_exposure = true;
  double exposure_s = 0.008;     // without the automatic control
  double exposure_max_s = 0.03;  // the automatic control's longest; then it adds gain
  double gain = 1;               // fixed, or the control's least
  double gain_max = 16;
  bool motion_blur = true;

  bool low_light = false;      // the world's light is dimmed to kLowLight
  double vignetting = 0.2;     // part of the light that is missing in the farthest corner
  bool shot_noise = true;      // of the photo-electrons
  double read_noise_e = 4;     // standard deviation, electrons
  double full_well_e = 10500;  // electrons at which a pixel is full

  Pose T_body_sensor;
  ClockConfig clock;

  static constexpr double kLowLight = 0.02;
  static constexpr double kLongestExposure = 0.9;  // of the period; then the pixels are read out
};

// T_body_sensor, clock and model are read by whoever reads the scenario.
void read_keys(YamlSection& section, CameraConfig& config);

Intrinsics intrinsics_of(const CameraConfig& config);

// Whether every pixel has a ray: a strong distortion may fold back within the image.
[[nodiscard]] bool sees_everywhere(const CameraConfig& config);

}  // namespace lxd::sim
