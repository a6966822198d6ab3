// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/camera/camera_config.hpp"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

namespace lxd::sim {
namespace {

constexpr std::array<std::string_view, 3> kDistortionModels{"radtan", "equidistant", "none"};
constexpr std::array<std::string_view, 2> kTriggers{"free", "sync"};

constexpr ValueRange kPixels{16, 8192, "pixels", ""};
constexpr ValueRange kFocal{1, 100'000, "pixels", ""};
constexpr ValueRange kDistortion{-100, 100, "", ""};
constexpr ValueRange kRate{0.1, 200, "Hz", "is it a period?"};
constexpr ValueRange kExposure{1e-6, 1, "s", "is it in milliseconds?"};
constexpr ValueRange kGain{1, 256, "times", "is it in decibels?"};
constexpr ValueRange kPart{0, 1, "", "is it in per cent?"};
constexpr ValueRange kReadNoise{0, 1000, "electrons", ""};
constexpr ValueRange kFullWell{100, 1e6, "electrons", ""};

template <std::size_t N>
void read_array(YamlSection& section, std::string_view key, std::array<double, N>& values, const ValueRange& range) {
  if (const auto found = section.read_numbers(key, N, range)) std::ranges::copy(*found, values.begin());
}

void read_lens(YamlSection& section, CameraConfig& config) {
  std::array<double, 2> resolution{static_cast<double>(config.resolution[0]),
                                   static_cast<double>(config.resolution[1])};
  read_array(section, "resolution", resolution, kPixels);
  config.resolution = {static_cast<std::uint32_t>(resolution[0]), static_cast<std::uint32_t>(resolution[1])};
  read_array(section, "intrinsics", config.intrinsics, kFocal);
  section.read("distortion_model", config.distortion_model, kDistortionModels);
  read_array(section, "distortion_coeffs", config.distortion_coeffs, kDistortion);
  section.read("vignetting", config.vignetting, kPart);
  if (!sees_everywhere(config)) {
    section.complain("distortion_coeffs",
                     "the distortion folds back within the image, wanted coefficients that give every pixel a ray");
  }
}

void read_exposure(YamlSection& section, CameraConfig& config) {
  section.read("auto_exposure", config.auto_exposure);
  section.read("exposure_s", config.exposure_s, kExposure);
  section.read("exposure_max_s", config.exposure_max_s, kExposure);
  section.read("gain", config.gain, kGain);
  config.gain_max = std::max(config.gain_max, config.gain);
  section.read("gain_max", config.gain_max, kGain);
  const std::string_view key = config.auto_exposure ? "exposure_max_s" : "exposure_s";
  const double longest_s = config.auto_exposure ? config.exposure_max_s : config.exposure_s;
  if (longest_s * config.rate_hz > CameraConfig::kLongestExposure)
    section.complain(key, fmt::format("found an exposure of {} s, wanted one of at most {} of the period of {} s",
                                      longest_s, CameraConfig::kLongestExposure, 1 / config.rate_hz));
}

}  // namespace

void read_keys(YamlSection& section, CameraConfig& config) {
  read_lens(section, config);
  section.read("colour", config.colour);
  section.read("rate_hz", config.rate_hz, kRate);
  std::string trigger = config.trigger == CameraTrigger::kFree ? "free" : "sync";
  section.read("trigger", trigger, kTriggers);
  config.trigger = trigger == "free" ? CameraTrigger::kFree : CameraTrigger::kSync;
  read_exposure(section, config);
  section.read("motion_blur", config.motion_blur);
  section.read("low_light", config.low_light);
  section.read("shot_noise", config.shot_noise);
  section.read("read_noise_e", config.read_noise_e, kReadNoise);
  section.read("full_well_e", config.full_well_e, kFullWell);
}

Intrinsics intrinsics_of(const CameraConfig& config) {
  Intrinsics intrinsics;
  intrinsics.focal_px = {config.intrinsics[0], config.intrinsics[1]};
  intrinsics.centre_px = {config.intrinsics[2], config.intrinsics[3]};
  intrinsics.coefficients = config.distortion_coeffs;
  intrinsics.distortion = config.distortion_model == "radtan"        ? Distortion::kRadtan
                          : config.distortion_model == "equidistant" ? Distortion::kEquidistant
                                                                     : Distortion::kNone;
  return intrinsics;
}

// Distortion grows with the distance from the centre: what reaches the border, and a pixel beyond for the rays
// between pixels, reaches all within.
bool sees_everywhere(const CameraConfig& config) {
  const CameraModel model(intrinsics_of(config));
  const double right = config.resolution[0], bottom = config.resolution[1];
  const auto seen = [&](double u, double v) { return model.unproject({u, v}).has_value(); };
  for (double u = -1; u <= right; ++u) {
    if (!seen(u, -1) || !seen(u, bottom)) return false;
  }
  for (double v = -1; v <= bottom; ++v) {
    if (!seen(-1, v) || !seen(right, v)) return false;
  }
  return true;
}

}  // namespace lxd::sim
