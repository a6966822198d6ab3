// SPDX-License-Identifier: Apache-2.0
// Descriptors at given pixels: the same thing turned or seen from nearer keeps its bits.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "backend/pnp/feature_match.hpp"
#include "backend/pnp/orb.hpp"

namespace lxd::backend_orb_test {
namespace {

constexpr int kWidth = 320, kHeight = 240;

// A smooth texture without symmetry, of the plane's own coordinates.
std::uint8_t texture(double x, double y) {
  const double v = std::sin(0.31 * x + 0.7 * std::sin(0.11 * y)) + std::sin(0.23 * y + 1.3 * std::sin(0.07 * x)) +
                   std::sin(0.17 * (x + y)) * std::cos(0.05 * x);
  return static_cast<std::uint8_t>(std::lround(127.5 + 40 * v));
}

// The plane about a point of it whose surroundings are brighter on one side, turned and magnified, in the middle.
std::vector<std::uint8_t> view(double turn_rad, double magnified) {
  std::vector<std::uint8_t> out;
  const double c = std::cos(turn_rad) / magnified, s = std::sin(turn_rad) / magnified;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      out.push_back(texture(20 + c * (x - 160) + s * (y - 120), 10 - s * (x - 160) + c * (y - 120)));
  return out;
}

OrbDescriptor at_middle(const std::vector<std::uint8_t>& pixels, float distance_m) {
  const std::vector<OrbPoint> points = {{{160, 120}, distance_m}};
  return *describe({pixels.data(), kWidth, kHeight, kWidth}, points).at(0);
}

TEST(OrbDescriptors, SurviveATurnOfTheCamera) {
  const OrbDescriptor upright = at_middle(view(0, 1), 12);
  EXPECT_EQ(hamming(upright, at_middle(view(0, 1), 12)), 0);
  EXPECT_LT(hamming(upright, at_middle(view(0.8, 1), 12)), 50);
  EXPECT_LT(hamming(upright, at_middle(view(2.5, 1), 12)), 50);
}

TEST(OrbDescriptors, SurviveComingNearerWhenTheDistanceIsKnown) {
  const OrbDescriptor far = at_middle(view(0, 1), 12);
  const std::vector<std::uint8_t> near = view(0, 2);
  EXPECT_LT(hamming(far, at_middle(near, 6)), 50);
  EXPECT_GT(hamming(far, at_middle(near, 0)), hamming(far, at_middle(near, 6)));
}

TEST(OrbDescriptors, KeepTheOrderAndLeaveOutTheBorder) {
  const std::vector<std::uint8_t> pixels = view(0, 1);
  const std::vector<OrbPoint> points = {{{2, 2}, 0}, {{160, 120}, 12}, {{318, 100}, 3}, {{100, 60}, 0}};
  const auto found = describe({pixels.data(), kWidth, kHeight, kWidth}, points);
  ASSERT_EQ(found.size(), 4U);
  EXPECT_FALSE(found[0]);
  EXPECT_TRUE(found[1] && found[3]);
  EXPECT_FALSE(found[2]);
  EXPECT_EQ(*found[1], at_middle(pixels, 12));
  EXPECT_TRUE(describe({pixels.data(), 10, 10, kWidth}, points).size() == 4U);
  EXPECT_TRUE(describe({pixels.data(), kWidth, kHeight, kWidth}, {}).empty());
}

}  // namespace
}  // namespace lxd::backend_orb_test
