// SPDX-License-Identifier: Apache-2.0
// What a simulated camera renders lies where the lens and the true motion put it.
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "tests/support/camera_world.hpp"
#include "tools/simulator/camera/renderer.hpp"
#include "tools/simulator/camera/sensor_response.hpp"

namespace lxd::sim::simulator_camera_render_test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr float kWall_m = 4, kSquare_m = 0.4F;
constexpr int kSquares = 14;

CameraConfig small_camera() {
  CameraConfig config;
  config.resolution = {400, 300};
  config.intrinsics = {280, 281, 201.3, 148.2};
  config.distortion_coeffs = {-0.28, 0.07, 0.002, -0.001};
  config.vignetting = 0;
  config.shot_noise = false;
  config.read_noise_e = 0;
  config.T_body_sensor = test::forward_camera();
  config.T_body_sensor.p = {0.1, -0.05, 0.2};
  return config;
}

struct Shot {
  RadianceImage light;
  PixelImage image;
};

Shot shoot(const World& world, const CameraConfig& config, const Trajectory& motion, double begin_s,
           double exposure_s) {
  const Scene scene(world);
  const RayTable table(config);
  Shot shot;
  Renderer(scene, config, table).render(motion, begin_s, exposure_s, shot.light);
  SensorResponse(config).apply(shot.light, {0.006, 1}, Random(1, "camera0"), shot.image);
  return shot;
}

// An image of brightness that is smooth enough to be differentiated: the gamma taken off, then a Gaussian of one pixel.
struct Brightness {
  explicit Brightness(const PixelImage& image) : width(image.width), height(image.height) {
    std::array<double, 256> linear{};
    for (int i = 0; i <= 4096; ++i) linear[SensorResponse::encoded(i / 4096.0)] = i / 4096.0;
    for (const std::uint8_t pixel : image.data) values.push_back(linear[pixel]);
    smooth(1);
    smooth(width);
  }
  [[nodiscard]] double at(int u, int v) const { return values[static_cast<std::size_t>(v * width + u)]; }

  int width, height;
  std::vector<double> values;

 private:
  void smooth(int step) {
    constexpr std::array<double, 7> kGaussian{0.00443, 0.05401, 0.24204, 0.39905, 0.24204, 0.05401, 0.00443};
    const std::vector<double> sharp = values;
    for (int i = 3 * step; i + 3 * step < width * height; ++i) {
      double sum = 0;
      for (int k = -3; k <= 3; ++k)
        sum += kGaussian[static_cast<std::size_t>(k + 3)] * sharp[static_cast<std::size_t>(i + k * step)];
      values[static_cast<std::size_t>(i)] = sum;
    }
  }
};

// Foerstner and Guelch 1987: the point to which all gradients nearby are at right angles.
std::optional<Vector2d> corner_near(const Brightness& image, Vector2d corner) {
  constexpr int kHalf = 9, kIterations = 20;
  constexpr double kSpread_px = 3;
  for (int i = 0; i < kIterations; ++i) {
    const Eigen::Vector2i middle = corner.array().round().cast<int>();
    if (middle.minCoeff() <= kHalf || middle.x() + kHalf + 1 >= image.width || middle.y() + kHalf + 1 >= image.height)
      return std::nullopt;
    Eigen::Matrix2d A = Eigen::Matrix2d::Zero();
    Vector2d b = Vector2d::Zero();
    for (int v = middle.y() - kHalf; v <= middle.y() + kHalf; ++v) {
      for (int u = middle.x() - kHalf; u <= middle.x() + kHalf; ++u) {
        const Vector2d gradient(image.at(u + 1, v) - image.at(u - 1, v), image.at(u, v + 1) - image.at(u, v - 1));
        const double weight = std::exp(-(Vector2d(u, v) - corner).squaredNorm() / (2 * kSpread_px * kSpread_px));
        A += weight * gradient * gradient.transpose();
        b += weight * gradient * gradient.dot(Vector2d(u, v));
      }
    }
    corner = A.inverse() * b;
  }
  return corner;
}

struct CornerErrors {
  int seen = 0;
  double worst_px = 0;
};

// Corners of the checkerboard, found from a guess that is half a pixel off, against the projection of the true ones.
CornerErrors corner_errors(const PixelImage& pixels, const CameraConfig& config, const Pose& T_world_body) {
  const CameraModel model(intrinsics_of(config));
  const Pose T_camera_world = (T_world_body * config.T_body_sensor).inverse();
  const Brightness image(pixels);
  CornerErrors errors;
  for (int i = 1; i < kSquares; ++i) {
    for (int k = 1; k < kSquares; ++k) {
      const Vector3d p_world(kWall_m, kSquare_m * static_cast<float>(i - kSquares / 2),
                             kSquare_m * static_cast<float>(k - kSquares / 2));
      const auto pixel = model.project(T_camera_world * p_world);
      const auto found = pixel ? corner_near(image, *pixel + Vector2d(0.4, -0.3)) : std::nullopt;
      if (!found) continue;
      ++errors.seen;
      errors.worst_px = std::max(errors.worst_px, (*found - *pixel).norm());
    }
  }
  return errors;
}

// Second moment of an edge's slope along the middle row: how wide the edge is, pixels squared.
double edge_variance(const RadianceImage& light) {
  const int v = light.height / 2;
  double mass = 0, first = 0, second = 0;
  for (int u = 1; u < light.width; ++u) {
    const double slope = light.radiance[light.index(u, v)] - light.radiance[light.index(u - 1, v)];
    mass += slope;
    first += slope * u;
    second += slope * u * u;
  }
  return second / mass - first / mass * (first / mass);
}

}  // namespace

TEST(SimulatorCameraRender, GivenAMovingCameraThenWorldPointsMeetTheirPixelsAtTheMiddleOfTheExposure) {
  const World world = test::checkerboard(kWall_m, kSquare_m, kSquares);
  const Trajectory motion = test::steady_motion({0.3, 0.5, -0.2}, {0.3, 0.1, 0.3});
  CameraConfig config = small_camera();
  config.motion_blur = false;
  const Shot shot = shoot(world, config, motion, 0.4, 0.02);
  const CornerErrors errors = corner_errors(shot.image, config, motion.at(0.41).T_world_body);
  EXPECT_GT(errors.seen, 60);
  EXPECT_LT(errors.worst_px, 0.1);
  // The pose of the exposure's begin is not the pose of the image: the motion matters.
  EXPECT_GT(corner_errors(shot.image, config, motion.at(0.3).T_world_body).worst_px, 1);
}

TEST(SimulatorCameraRender, GivenMotionBlurThenWorldPointsStillMeetTheirPixels) {
  const World world = test::checkerboard(kWall_m, kSquare_m, kSquares);
  const Trajectory motion = test::steady_motion({0.3, 0.5, -0.2}, {0.3, 0.1, 0.3});
  const CameraConfig config = small_camera();
  const Shot shot = shoot(world, config, motion, 0.4, 0.02);
  const CornerErrors errors = corner_errors(shot.image, config, motion.at(0.41).T_world_body);
  EXPECT_GT(errors.seen, 60);
  EXPECT_LT(errors.worst_px, 0.1);
}

TEST(SimulatorCameraRender, GivenAnEquidistantLensThenWorldPointsMeetTheirPixels) {
  const World world = test::checkerboard(kWall_m, kSquare_m, kSquares);
  const Trajectory still = test::steady_motion(Vector3d::Zero(), Vector3d::Zero());
  CameraConfig config = small_camera();
  config.distortion_model = "equidistant";
  config.distortion_coeffs = {-0.01, 0.02, -0.01, 0.002};
  const CornerErrors errors = corner_errors(shoot(world, config, still, 0, 0.01).image, config, Pose{});
  EXPECT_GT(errors.seen, 60);
  EXPECT_LT(errors.worst_px, 0.1);
}

TEST(SimulatorCameraRender, GivenSidewaysMotionThenAnEdgeIsAsWideAsTheWayOfItsImage) {
  World world = test::two_tone_world();
  test::add_square(world, kWall_m, 0, -20, 40, 0);
  test::add_square(world, kWall_m, -40, -20, 40, 1);
  CameraConfig config = small_camera();
  config.distortion_model = "none";
  const double speed_mps = 4, exposure_s = 0.03;
  const Trajectory motion = test::steady_motion({0, speed_mps, 0}, Vector3d::Zero());
  const double smeared = edge_variance(shoot(world, config, motion, 0, exposure_s).light);
  config.motion_blur = false;
  const double sharp = edge_variance(shoot(world, config, motion, 0, exposure_s).light);
  const double depth_m = kWall_m - config.T_body_sensor.p.x();
  const double way_px = config.intrinsics[0] * speed_mps * exposure_s / depth_m;
  EXPECT_LT(sharp, 0.26);
  EXPECT_NEAR(std::sqrt(12 * (smeared - sharp)) / way_px, 1, 0.03);  // a box of that width has a twelfth of its square
}

TEST(SimulatorCameraRender, GivenAStandingCameraThenBlurChangesNothing) {
  const World world = test::checkerboard(kWall_m, kSquare_m, kSquares);
  const Trajectory still = test::steady_motion(Vector3d::Zero(), Vector3d::Zero());
  CameraConfig config = small_camera();
  const Shot blurred = shoot(world, config, still, 0, 0.03);
  config.motion_blur = false;
  EXPECT_EQ(blurred.image.data, shoot(world, config, still, 0, 0.03).image.data);
}

TEST(SimulatorCameraRender, GivenATurningCameraThenTheSkylineIsSmearedAlongTheTurnOnly) {
  World world = test::two_tone_world();
  test::add_square(world, 20, -200, -400, 400, 0);  // below the horizon
  CameraConfig config = small_camera();
  config.distortion_model = "none";
  config.T_body_sensor.p.setZero();
  const Trajectory yawing = test::steady_motion(Vector3d::Zero(), {0, 0, 2}),
                   pitching = test::steady_motion(Vector3d::Zero(), {0, 2, 0});
  const auto steps = [&](const Trajectory& motion) {
    const RadianceImage light = shoot(world, config, motion, -0.01, 0.02).light;
    int between = 0;  // pixels of the middle column that are neither sky nor ground
    for (int v = 1; v + 1 < light.height; ++v) {
      const float above = light.radiance[light.index(200, v - 1)], below = light.radiance[light.index(200, v + 1)];
      if (std::abs(above - below) > 0.05F) ++between;
    }
    return between;
  };
  EXPECT_LE(steps(yawing), 3);
  EXPECT_GE(steps(pitching), 9);  // 2 rad/s over 0.02 s with a focal length of 281 pixels: 11 pixels
}

TEST(SimulatorCameraRender, GivenGlassThenItIsDarkAndShowsTheSky) {
  World world = test::two_tone_world();
  world.materials.push_back({.name = "pane", .albedo = 0.75F, .contrast = 0, .glass = true});
  test::add_square(world, kWall_m, 0, -20, 40, 1);
  test::add_square(world, kWall_m, -40, -20, 40, 2);
  CameraConfig config = small_camera();
  const RadianceImage light =
      shoot(world, config, test::steady_motion(Vector3d::Zero(), Vector3d::Zero()), 0, 0.01).light;
  const float wall = light.radiance[light.index(100, 40)], pane = light.radiance[light.index(300, 40)];
  EXPECT_LT(pane, wall);
  EXPECT_GT(pane, light.radiance[light.index(300, 260)]) << "the pane's lower half mirrors the ground";
}

TEST(SimulatorCameraRender, GivenColourThenTheMaterialsColoursAreSeen) {
  World world = test::two_tone_world();
  world.materials[1].colour = {1, 0.5F, 0.25F};
  test::add_square(world, kWall_m, -20, -20, 40, 1);
  CameraConfig config = small_camera();
  config.colour = true;
  const Shot shot = shoot(world, config, test::steady_motion(Vector3d::Zero(), Vector3d::Zero()), 0, 0.01);
  ASSERT_EQ(shot.image.data.size(), 3U * 400 * 300);
  const float* const rgb = &shot.light.radiance[3 * shot.light.index(200, 150)];
  EXPECT_NEAR(rgb[1] / rgb[0], 0.5, 1e-5);
  EXPECT_NEAR(rgb[2] / rgb[0], 0.25, 1e-5);
}

}  // namespace lxd::sim::simulator_camera_render_test
