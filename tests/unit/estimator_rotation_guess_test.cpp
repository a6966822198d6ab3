// SPDX-License-Identifier: Apache-2.0
// The rotation guess in a room that casts exact rays: rotations about every axis come back, and where there is nothing
// to tell them by the guess says so.
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "estimator/rotation_guess.hpp"
#include "rt/allocation_guard.hpp"
#include "rt/pose.hpp"
#include "rt/so3.hpp"
#include "tests/support/mapping_scene.hpp"

namespace lxd::estimator_rotation_guess_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kDegree = std::numbers::pi / 180;
constexpr RotationGuess::Doubt kDoubt{0.05, 0.05};  // of a prediction over one sweep

struct Lidar {
  int beams = 32, columns = 900;
  double low_rad = -25 * kDegree, high_rad = 15 * kDegree;
  double noise_m = 0.01;
};

// An L-shaped hall: a box of 14 m x 9 m x 3.5 m with a block in one corner, so that no turn maps it to itself.
double range_in_hall(const Vector3d& origin, const Vector3d& direction) {
  const Vector3d low(-5, -4, -1.2), high(9, 5, 2.3);
  double range = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i)
    if (std::abs(direction[i]) > 1e-9)
      range = std::min(range, ((direction[i] > 0 ? high[i] : low[i]) - origin[i]) / direction[i]);
  const std::array<double, 2> block{3.0, 1.5};  // the corner x > 3, y > 1.5 is solid
  for (int i = 0; i < 2; ++i) {
    if (direction[i] < 1e-9) continue;
    const double t = (block[static_cast<std::size_t>(i)] - origin[i]) / direction[i];
    const Vector3d hit = origin + t * direction;
    if (t > 0 && hit[1 - i] > block[static_cast<std::size_t>(1 - i)]) range = std::min(range, t);
  }
  return range;
}

double range_in_sphere(const Vector3d& origin, const Vector3d& direction) {
  const double b = origin.dot(direction);
  return -b + std::sqrt(b * b - origin.squaredNorm() + 36.0);
}

template <typename Scene>
std::vector<Eigen::Vector3f> sweep(const Lidar& lidar, const Pose& T_world_lidar, unsigned seed, Scene scene) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, lidar.noise_m);
  std::vector<Eigen::Vector3f> points;
  for (int c = 0; c < lidar.columns; ++c)
    for (int b = 0; b < lidar.beams; ++b) {
      const double azimuth = std::numbers::pi - 2 * std::numbers::pi * c / lidar.columns;
      const double elevation = lidar.low_rad + (lidar.high_rad - lidar.low_rad) * b / (lidar.beams - 1);
      const Vector3d d(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                       std::sin(elevation));
      const double range_m = scene(T_world_lidar.p, T_world_lidar.R * d) + noise(random);
      points.emplace_back(d.cast<float>() * static_cast<float>(range_m));
    }
  return points;
}

class RotationGuessTest : public testing::Test {
 protected:
  RotationGuessTest() : arena_(std::size_t{2} << 20), guess_(*arena_) {}

  void remember(const std::vector<Eigen::Vector3f>& points) {
    guess_.previous().clear();
    for (const Eigen::Vector3f& p : points) guess_.previous().add(p);
    guess_.previous().finish();
  }

  static std::vector<GuessSample> samples(const std::vector<Eigen::Vector3f>& points, float elapsed = 1) {
    std::vector<GuessSample> out;
    const std::size_t stride = points.size() / RotationGuess::kSamplesMax + 1;
    for (std::size_t i = 0; i < points.size(); i += stride) out.push_back({points[i], elapsed});
    return out;
  }

  // What the guess says of a LiDAR that turned (and moved) between two sweeps when nothing had been predicted.
  template <typename Scene>
  RotationGuessResult guess(const Vector3d& turn_rad, const Vector3d& moved_m, Scene scene, const Lidar& lidar = {},
                            const RotationGuess::Doubt& doubt = kDoubt) {
    const Pose first{Exp(Vector3d(0.02, -0.03, 0.4)), Vector3d(0.3, -0.2, 0.1)};
    remember(sweep(lidar, first, 1, scene));
    return guess_.seek(samples(sweep(lidar, first * Pose{Exp(turn_rad), moved_m}, 2, scene)), doubt);
  }

  test::OwnedArena arena_;
  RotationGuess guess_;
};

// Given a hall and turns about each axis, and about all of them; then each comes back to less than a third of a pixel.
TEST_F(RotationGuessTest, RecoversTurnsAboutEveryAxis) {
  const std::vector<Vector3d> turns_deg{{0, 0, 0}, {0, 0, 5},  {0, 0, -20}, {4, 0, 0},   {-4, 0, 0},
                                        {0, 4, 0}, {0, -4, 0}, {3, -2, 8},  {-2, 3, -15}};
  for (const Vector3d& turn_deg : turns_deg) {
    const RotationGuessResult out = guess(turn_deg * kDegree, Vector3d::Zero(), range_in_hall);
    EXPECT_TRUE(out.valid) << turn_deg.transpose();
    EXPECT_LT(Log(Exp(out.rotation_rad).transpose() * Exp(turn_deg * kDegree)).norm(), 0.45 * kDegree)
        << turn_deg.transpose() << " found " << out.rotation_rad.transpose() / kDegree;
  }
}

// Given a turn farther than a sweep's, as after a silence; then it is found, near enough for the update, if it was
// thought possible, and only then.
TEST_F(RotationGuessTest, SeeksAsFarAsTheYawIsDoubted) {
  for (const double yaw_deg : {-75.0, 100.0, 140.0, -170.0}) {
    const Vector3d turn_rad = Vector3d(0, 0, yaw_deg) * kDegree;
    const RotationGuessResult out = guess(turn_rad, Vector3d::Zero(), range_in_hall, {}, {0.05, 1.2});
    EXPECT_TRUE(out.valid) << yaw_deg;
    EXPECT_LT(Log(Exp(out.rotation_rad).transpose() * Exp(turn_rad)).norm(), 1 * kDegree) << yaw_deg;
    const RotationGuessResult sure = guess(turn_rad, Vector3d::Zero(), range_in_hall);
    EXPECT_FALSE(sure.valid && (sure.rotation_rad - turn_rad).norm() < 1 * kDegree) << yaw_deg;
  }
}

// The same code for a sparse and for a dense LiDAR.
TEST_F(RotationGuessTest, WorksFromSixteenTo128Beams) {
  const Vector3d turn_rad = Vector3d(2, -2, 9) * kDegree;
  for (const int beams : {16, 32, 64, 128}) {
    Lidar lidar;
    lidar.beams = beams;
    lidar.low_rad = -16 * kDegree;
    const RotationGuessResult out = guess(turn_rad, Vector3d::Zero(), range_in_hall, lidar);
    EXPECT_TRUE(out.valid) << beams;
    EXPECT_LT((out.rotation_rad - turn_rad).norm(), 0.4 * kDegree) << beams;
  }
}

// Given a translation that the prediction missed; then it is found beside the rotation and does not bend it.
TEST_F(RotationGuessTest, ToleratesATranslationThatWasNotPredicted) {
  const Vector3d turn_rad = Vector3d(1, -1, 6) * kDegree, moved_m(0.10, -0.08, 0.03);
  const RotationGuessResult out = guess(turn_rad, moved_m, range_in_hall);
  EXPECT_TRUE(out.valid);
  EXPECT_LT((out.rotation_rad - turn_rad).norm(), 0.3 * kDegree);
  EXPECT_LT((out.translation_m - moved_m).norm(), 0.03);
}

// A turn that goes on during the sweep has moved its first points less than its last.
TEST_F(RotationGuessTest, CountsTheShareOfTheTurnThatHadHappenedAtEachPoint) {
  const Pose first{Matrix3d::Identity(), Vector3d::Zero()};
  const Vector3d turn_rad = Vector3d(2, 1, 10) * kDegree;
  remember(sweep(Lidar{}, first, 1, range_in_hall));
  std::vector<GuessSample> all;
  for (int part = 0; part < 16; ++part) {
    const float elapsed = (static_cast<float>(part) + 0.5F) / 16;
    const auto points =
        sweep(Lidar{}, {Exp(turn_rad * static_cast<double>(elapsed)), Vector3d::Zero()}, 2, range_in_hall);
    const std::size_t size = points.size() / 16, begin = size * static_cast<std::size_t>(part);
    for (std::size_t i = begin; i < begin + size; i += 41) all.push_back({points[i], elapsed});
  }
  const RotationGuessResult out = guess_.seek(all, kDoubt);
  EXPECT_TRUE(out.valid);
  EXPECT_LT((out.rotation_rad - turn_rad).norm(), 0.4 * kDegree);
}

// The errors over many sweeps are what the covariance says to within a factor: an image is no ruler, its pixels are
// 1.5 degrees wide.
TEST_F(RotationGuessTest, ClaimsAnAccuracyOfTheOrderOfItsErrors) {
  double worst = 0;
  for (int k = 0; k < 10; ++k) {
    const Vector3d turn_rad = Vector3d(0.3 * k, 2 - 0.4 * k, 1.7 * k - 8) * kDegree;
    const RotationGuessResult out = guess(turn_rad, Vector3d::Zero(), range_in_hall);
    ASSERT_TRUE(out.valid);
    const Vector3d error = out.rotation_rad - turn_rad;
    worst = std::max(worst, error.dot(out.covariance.inverse() * error));
  }
  EXPECT_LT(worst, 100);  // ten sigmas
}

TEST_F(RotationGuessTest, IsNotValidWhereNothingTellsTheTurn) {
  const RotationGuessResult out = guess(Vector3d(0, 0, 5) * kDegree, Vector3d::Zero(), range_in_sphere);
  EXPECT_FALSE(out.valid);
}

// Given two places that have nothing in common; then too few ranges agree.
TEST_F(RotationGuessTest, IsNotValidBetweenSweepsOfDifferentPlaces) {
  const Pose here{Matrix3d::Identity(), Vector3d::Zero()};
  std::vector<Eigen::Vector3f> other;
  std::mt19937 random(7);
  std::uniform_real_distribution<float> range(1, 60);
  for (const Eigen::Vector3f& p : sweep(Lidar{}, here, 1, range_in_hall))
    other.push_back(p.normalized() * range(random));
  remember(sweep(Lidar{}, here, 1, range_in_hall));
  EXPECT_FALSE(guess_.seek(samples(other), kDoubt).valid);
}

TEST_F(RotationGuessTest, IsNotValidWithoutAnImageOrWithoutPoints) {
  const auto points = sweep(Lidar{}, {}, 1, range_in_hall);
  EXPECT_FALSE(guess_.seek(samples(points), kDoubt).valid);  // nothing remembered
  remember({});
  EXPECT_FALSE(guess_.seek(samples(points), kDoubt).valid);
  remember({points.front()});
  EXPECT_FALSE(guess_.seek(samples(points), kDoubt).valid);
  remember(points);
  EXPECT_FALSE(guess_.seek({}, kDoubt).valid);
  EXPECT_FALSE(guess_.seek(samples({points.front()}), kDoubt).valid);
}

TEST_F(RotationGuessTest, GivesTheSameAnswerTwice) {
  const Vector3d turn_rad = Vector3d(1, 2, 3) * kDegree;
  const RotationGuessResult a = guess(turn_rad, Vector3d::Zero(), range_in_hall);
  const RotationGuessResult b = guess(turn_rad, Vector3d::Zero(), range_in_hall);
  EXPECT_EQ(a.rotation_rad, b.rotation_rad);
  EXPECT_EQ(a.covariance, b.covariance);
}

TEST_F(RotationGuessTest, RealTimePathDoesNotAllocate) {
  const auto points = sweep(Lidar{}, {}, 1, range_in_hall);
  const auto present = samples(points);
  const AllocationGuard guard;
  remember(points);
  const RotationGuessResult out = guess_.seek(present, kDoubt);
  EXPECT_EQ(guard.count(), 0U);
  EXPECT_TRUE(out.valid);
}

// The image is bilinear between the centres of its bins, so that a difference across one of their borders is none of
// the derivative: one return in twenty may lie there.
TEST_F(RotationGuessTest, RowsAreTheDerivativesOfTheError) {
  remember(sweep({}, Pose{}, 1, range_in_hall));
  constexpr float kStep = 3e-4F, kElapsed = 0.7F;
  constexpr int kColumnsCoprime = 907;  // no column on a border of the image's
  int rows = 0, differing = 0;
  for (const GuessSample& sample : samples(sweep(
           {.columns = kColumnsCoprime}, Pose{Exp(Vector3d(0.02, -0.03, 0.1)), {0.2, 0.1, 0}}, 2, range_in_hall))) {
    float error = 0;
    RangeErrorRow row, numeric, none;
    if (!range_error(guess_.previous(), sample.p_m, kElapsed, error, row)) continue;
    for (int i = 0; i < 6; ++i) {
      const Vector3d step = kStep * kElapsed * Vector3d::Unit(i % 3);
      const auto moved = [&](double sign) -> Eigen::Vector3f {
        const Vector3d x = sample.p_m.cast<double>();
        return (i < 3 ? Vector3d(Exp(sign * step) * x) : Vector3d(x + sign * step)).cast<float>();
      };
      float ahead = 0, behind = 0;
      (void)range_error(guess_.previous(), moved(1), kElapsed, ahead, none);
      (void)range_error(guess_.previous(), moved(-1), kElapsed, behind, none);
      numeric[i] = (ahead - behind) / (2 * kStep);
    }
    ++rows;
    differing += (numeric - row).norm() > 0.02F * row.norm() + 1e-3F;
  }
  EXPECT_GT(rows, 500);
  EXPECT_LT(differing, rows / 20) << rows;
}

// A plane is linear in inverse range: between two beams of the floor the image is as good as at them.
TEST_F(RotationGuessTest, ImageInterpolatesAPlaneBetweenItsBeams) {
  std::vector<Eigen::Vector3f> floor;
  for (const float elevation_deg : {-16.0F, -12.5F, -9.5F})
    for (float azimuth_deg = -180; azimuth_deg < 180; azimuth_deg += 0.5F) {
      const float e = elevation_deg * static_cast<float>(kDegree), a = azimuth_deg * static_cast<float>(kDegree);
      const Eigen::Vector3f d(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e));
      floor.emplace_back(d * (1.5F / -d.z()));
    }
  remember(floor);
  const float elevation = static_cast<float>(-11 * kDegree);
  for (const float azimuth_deg : {-179.9F, -90.3F, 0.0F, 17.2F, 179.6F}) {
    RangeImage::Look look{};
    ASSERT_TRUE(guess_.previous().look(azimuth_deg * static_cast<float>(kDegree), elevation, look)) << azimuth_deg;
    EXPECT_NEAR(look.inverse_range * 1.5F / -std::sin(elevation), 1.0F, 0.01F) << azimuth_deg;
    EXPECT_NEAR(look.d_azimuth, 0.0F, 0.01F);
    EXPECT_NEAR(look.d_elevation, -std::cos(elevation) / 1.5F, 0.03F);
  }
  RangeImage::Look look{};
  EXPECT_FALSE(guess_.previous().look(0, 0.2F, look));
}

}  // namespace
}  // namespace lxd::estimator_rotation_guess_test
