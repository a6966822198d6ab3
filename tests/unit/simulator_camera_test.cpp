// SPDX-License-Identifier: Apache-2.0
// A simulated camera's lens, its keys and its sensor.
#include <array>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"
#include "tools/recording/png_writer.hpp"
#include "tools/simulator/camera/camera_config.hpp"
#include "tools/simulator/camera/camera_model.hpp"
#include "tools/simulator/camera/sensor_response.hpp"
#include "tools/simulator/random.hpp"

namespace lxd::sim::simulator_camera_test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// A wide lens with all four coefficients at work.
Intrinsics wide() {
  Intrinsics lens;
  lens.focal_px = {458.654, 457.296};
  lens.centre_px = {367.215, 248.375};
  lens.coefficients = {-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05};
  return lens;
}

Intrinsics with(Distortion distortion, std::array<double, 4> coefficients) {
  Intrinsics lens = wide();
  lens.distortion = distortion;
  lens.coefficients = coefficients;
  return lens;
}

// calib3d's documentation, "Detailed Description", written out.
Vector2d opencv_formula(const Intrinsics& lens, const Vector3d& P) {
  const auto& [k1, k2, p1, p2] = lens.coefficients;
  const double x = P.x() / P.z(), y = P.y() / P.z();
  const double r = std::sqrt(x * x + y * y);
  const double bent = 1 + k1 * std::pow(r, 2) + k2 * std::pow(r, 4);
  const double x2 = x * bent + 2 * p1 * x * y + p2 * (r * r + 2 * x * x);
  const double y2 = y * bent + p1 * (r * r + 2 * y * y) + 2 * p2 * x * y;
  return {lens.focal_px.x() * x2 + lens.centre_px.x(), lens.focal_px.y() * y2 + lens.centre_px.y()};
}

// Its fisheye module.
Vector2d fisheye_formula(const Intrinsics& lens, const Vector3d& P) {
  const auto& [k1, k2, k3, k4] = lens.coefficients;
  const double a = P.x() / P.z(), b = P.y() / P.z(), r = std::hypot(a, b), theta = std::atan(r);
  const double bent = theta * (1 + k1 * std::pow(theta, 2) + k2 * std::pow(theta, 4) + k3 * std::pow(theta, 6) +
                               k4 * std::pow(theta, 8));
  return {lens.focal_px.x() * bent / r * a + lens.centre_px.x(), lens.focal_px.y() * bent / r * b + lens.centre_px.y()};
}

double worst_round_trip_px(const Intrinsics& lens) {
  const CameraModel model(lens);
  double worst = 0;
  for (int v = -1; v <= 480; v += 13) {
    for (int u = -1; u <= 752; u += 11) {
      const auto ray = model.unproject({u, v});
      const auto back = ray ? model.project(*ray * 7.3) : std::nullopt;
      worst = std::max(worst, back ? (*back - Vector2d(u, v)).norm() : 1e9);
      EXPECT_NEAR(ray.value_or(Vector3d::Zero()).norm(), 1, 1e-12);
    }
  }
  return worst;
}

Problems problems_of(const std::string& text, CameraConfig& config) {
  Problems problems;
  YamlSection section(YAML::Load(text), "camera0", "scenario.yaml", problems);
  read_keys(section, config);
  section.reject_unknown();
  return problems;
}

RadianceImage even_light(const CameraConfig& config, float radiance) {
  RadianceImage light;
  light.resize(static_cast<int>(config.resolution[0]), static_cast<int>(config.resolution[1]), 1);
  light.radiance.assign(light.radiance.size(), radiance);
  return light;
}

CameraConfig without_noise() {
  CameraConfig config;
  config.vignetting = 0;
  config.shot_noise = false;
  config.read_noise_e = 0;
  return config;
}

double mean_of(const PixelImage& image) {
  double sum = 0;
  for (const std::uint8_t value : image.data) sum += value;
  return sum / static_cast<double>(image.data.size());
}

PixelImage developed(const CameraConfig& config, float radiance, const Exposure& exposure, std::uint64_t number = 0) {
  PixelImage image;
  SensorResponse(config).apply(even_light(config, radiance), exposure, Random(1, "camera0", number), image);
  return image;
}

}  // namespace

TEST(SimulatorCameraModel, GivenPointsThenTheirPixelsAreThoseOfTheDocumentedFormulas) {
  const Intrinsics radtan = with(Distortion::kRadtan, {-0.28, 0.07, 0.003, -0.002});
  const Intrinsics fisheye = with(Distortion::kEquidistant, {-0.02, 0.01, -0.004, 0.001});
  Random random(5, "points");
  for (int i = 0; i < 1000; ++i) {
    const Vector3d p(random.uniform(-3, 3), random.uniform(-2, 2), random.uniform(3.5, 20));
    EXPECT_LT((CameraModel(radtan).project(p).value() - opencv_formula(radtan, p)).norm(), 1e-9);
    EXPECT_LT((CameraModel(fisheye).project(p).value() - fisheye_formula(fisheye, p)).norm(), 1e-9);
  }
}

TEST(SimulatorCameraModel, GivenAnyPixelThenItsRayComesBackToIt) {
  EXPECT_LT(worst_round_trip_px(wide()), 1e-9);
  EXPECT_LT(worst_round_trip_px(with(Distortion::kRadtan, {-0.25, 0.06, 0.01, -0.02})), 1e-9);
  EXPECT_LT(worst_round_trip_px(with(Distortion::kRadtan, {0.3, 0.1, 0, 0})), 1e-9);
  EXPECT_LT(worst_round_trip_px(with(Distortion::kEquidistant, {-0.02, 0.01, -0.004, 0.001})), 1e-9);
  EXPECT_LT(worst_round_trip_px(with(Distortion::kNone, {})), 1e-9);
}

TEST(SimulatorCameraModel, GivenThePrincipalPointThenItsRayIsTheAxis) {
  for (const Distortion distortion : {Distortion::kRadtan, Distortion::kEquidistant, Distortion::kNone}) {
    const Intrinsics lens = with(distortion, {});
    EXPECT_LT((CameraModel(lens).unproject(lens.centre_px).value() - Vector3d::UnitZ()).norm(), 1e-15);
    EXPECT_EQ(CameraModel(lens).project({0, 0, 2}).value(), lens.centre_px);
  }
}

TEST(SimulatorCameraModel, GivenPointsThatNoLensSeesThenTheyHaveNoPixel) {
  EXPECT_FALSE(CameraModel(wide()).project({0.1, 0.1, -1}));
  EXPECT_FALSE(CameraModel(wide()).project({0.1, 0.1, 0}));
  // 1 - 3 * 0.3 r^2 is zero at r = 1.05: a point farther out would come back into the image.
  const CameraModel folding(with(Distortion::kRadtan, {-0.3, 0, 0, 0}));
  EXPECT_TRUE(folding.project({1.0, 0, 1}));
  EXPECT_FALSE(folding.project({1.1, 0, 1}));
  EXPECT_FALSE(folding.unproject({367.215 + 458.654 * 0.75, 248.375}));
}

TEST(SimulatorCameraConfig, GivenAScenarioThenItsKeysAreRead) {
  CameraConfig config;
  const Problems problems = problems_of(
      "{resolution: [320, 240], intrinsics: [200, 201, 160, 120], distortion_model: equidistant,\n"
      " distortion_coeffs: [0.01, 0, 0, 0], rate_hz: 20, colour: true, trigger: free, auto_exposure: false,\n"
      " exposure_s: 0.004, gain: 2, gain_max: 4, motion_blur: false, low_light: true, vignetting: 0, shot_noise: "
      "false,\n"
      " read_noise_e: 0, full_well_e: 9000}",
      config);
  EXPECT_TRUE(problems.empty()) << text_of(problems);
  EXPECT_EQ(config.resolution, (std::array<std::uint32_t, 2>{320, 240}));
  EXPECT_EQ(intrinsics_of(config).distortion, Distortion::kEquidistant);
  EXPECT_EQ(config.trigger, CameraTrigger::kFree);
  EXPECT_TRUE(config.colour && config.low_light && !config.motion_blur && !config.shot_noise && !config.auto_exposure);
  EXPECT_EQ(config.exposure_s, 0.004);
  EXPECT_EQ(config.full_well_e, 9000);
}

TEST(SimulatorCameraConfig, GivenWrongKeysThenEachIsToldWithWhatIsWanted) {
  CameraConfig config;
  const auto told = [&](const std::string& text, const std::string& wanted) {
    return text_of(problems_of(text, config = {})).find(wanted) != std::string::npos;
  };
  EXPECT_TRUE(told("{distortion_coeffs: [-1, 0, 0, 0]}", "folds back within the image"));
  EXPECT_TRUE(told("{exposure_max_s: 0.2}", "at most 0.9 of the period of 0.1 s"));
  EXPECT_TRUE(told("{auto_exposure: false, exposure_s: 8}", "milliseconds"));
  EXPECT_TRUE(told("{motion_blur: 3}", "wanted true or false"));
  EXPECT_TRUE(told("{trigger: sometimes}", "wanted free or sync"));
  EXPECT_TRUE(told("{shutter: rolling}", "shutter"));
  EXPECT_TRUE(problems_of("{}", config = {}).empty());
  EXPECT_TRUE(sees_everywhere(CameraConfig{}));
}

TEST(SimulatorCameraSensor, GivenMoreExposureOrGainThenPixelsAreBrighterUntilTheyAreFull) {
  const CameraConfig config = without_noise();
  double last = -1;
  for (const double exposure_s : {0.0005, 0.001, 0.002, 0.004, 0.008, 0.016}) {
    const double mean = mean_of(developed(config, 0.5F, {exposure_s, 1}));
    EXPECT_GT(mean, last);
    last = mean;
  }
  EXPECT_EQ(mean_of(developed(config, 0.5F, {2 * kSaturation_s, 1})), 255);
  EXPECT_EQ(developed(config, 0.5F, {0.004, 2}).data, developed(config, 0.5F, {0.008, 1}).data);
  // Half of the full scale, by the sRGB curve.
  EXPECT_EQ(developed(config, 0.5F, {kSaturation_s, 1}).data.front(), 188);
}

TEST(SimulatorCameraSensor, GivenNoiseThenItIsThatOfTheElectrons) {
  CameraConfig config = without_noise();
  const double part = 0.2, gain = 8,
               slope = (SensorResponse::encoded(part + 0.04) - SensorResponse::encoded(part - 0.04)) / 0.08;
  config.shot_noise = true;
  config.read_noise_e = 12;
  const double electrons = part * config.full_well_e / gain;
  const double expected = std::sqrt(electrons + 12 * 12) * gain / config.full_well_e * slope;
  const PixelImage image = developed(config, 0.5F, {kSaturation_s * part / 0.5 / gain, gain});
  const double mean = mean_of(image);
  double squares = 0;
  for (const std::uint8_t value : image.data) squares += (value - mean) * (value - mean);
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(image.data.size())) / expected, 1, 0.05);
  EXPECT_EQ(image.data, developed(config, 0.5F, {kSaturation_s * part / 0.5 / gain, gain}).data);
  EXPECT_NE(image.data, developed(config, 0.5F, {kSaturation_s * part / 0.5 / gain, gain}, 1).data);
}

TEST(SimulatorCameraSensor, GivenVignettingThenTheCornersAreDarker) {
  CameraConfig config = without_noise();
  config.vignetting = 0.3;
  const PixelImage image = developed(config, 0.5F, {kSaturation_s, 1});
  EXPECT_EQ(image.data.front(), SensorResponse::encoded(0.5 * 0.7));
  EXPECT_EQ(image.data[240U * 640 + 320], SensorResponse::encoded(0.5));
}

TEST(SimulatorCameraSensor, GivenLowLightThenTheSameExposureIsFiftyTimesDarker) {
  CameraConfig config = without_noise();
  config.low_light = true;
  EXPECT_EQ(developed(config, 0.5F, {kSaturation_s, 1}).data.front(),
            SensorResponse::encoded(0.5 * CameraConfig::kLowLight));
}

TEST(SimulatorCameraPng, GivenAFullDiskOrNoFolderThenTheErrorNamesTheFile) {
  const PixelImage image{4, 2, 3, std::vector<std::uint8_t>(24, 7)};
  const test::TemporaryFolder folder;
  ASSERT_TRUE(write_png(folder / "a.png", image));
  EXPECT_EQ(test::read_file(folder / "a.png").substr(0, 8), "\x89PNG\r\n\x1a\n");
  const Status full = write_png("/dev/full", image);
  ASSERT_FALSE(full);
  EXPECT_EQ(full.error().message, "/dev/full: cannot be written: No space left on device");
  const Status missing = write_png(folder / "none/a.png", image);
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().message.find("none/a.png"), std::string::npos);
}

}  // namespace lxd::sim::simulator_camera_test
