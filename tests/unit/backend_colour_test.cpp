// SPDX-License-Identifier: Apache-2.0
// Colours of a sub-mesh from key images of a scene whose colours are known.
#include <algorithm>
#include <atomic>
#include <utility>

#include <gtest/gtest.h>

#include "backend/colour/key_images.hpp"
#include "tests/support/painted_wall.hpp"

namespace lxd::backend_colour_test {
namespace {

using test::PaintedWall;

class Colours : public ::testing::Test {
 protected:
  std::vector<VertexColour> told_by(std::vector<KeyImage> images, bool in_a_hurry = false) {
    const std::atomic<bool> hurry{in_a_hurry};
    return colourist_.colour(scene_.mesh().view(0), std::move(images), hurry);
  }
  // The light of each coloured vertex of the wall over what it should be, of one channel; sorted.
  std::vector<float> ratios(const std::vector<VertexColour>& colours, int channel) {
    std::vector<float> ratios;
    for (std::size_t i = 0; i < scene_.wall_vertices(); ++i) {
      if (!colours[i].known()) continue;
      const Eigen::Array3f light = light_of(&colours[i].red);
      ratios.push_back(light[channel] / PaintedWall::wall_light(scene_.mesh().vertices[i].position_m)[channel]);
    }
    std::ranges::sort(ratios);
    return ratios;
  }
  static float part(const std::vector<float>& sorted, double share) {
    return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
  }

  PaintedWall scene_;
  Colourist colourist_{PaintedWall::view(), PaintedWall::limits()};
};

TEST_F(Colours, AreThoseOfTheSurface) {
  const auto colours = told_by(PaintedWall::images([](int i, float y) { return PaintedWall::image(i, y); }));
  for (int channel = 0; channel < 3; ++channel) {
    const std::vector<float> told = ratios(colours, channel);
    ASSERT_GT(told.size(), scene_.wall_vertices() / 2);
    EXPECT_NEAR(part(told, 0.5), 1, 0.01);
    EXPECT_GT(part(told, 0.05), 0.96);
    EXPECT_LT(part(told, 0.95), 1.04);
  }
}

TEST_F(Colours, WhatIsHiddenDoesNotGetTheColourOfWhatHidesIt) {
  const auto colours = told_by(PaintedWall::images([](int i, float y) { return PaintedWall::image(i, y); }));
  std::size_t hidden = 0, box = 0;
  for (std::size_t i = 0; i < colours.size(); ++i) {
    const Eigen::Vector3f& p = scene_.mesh().vertices[i].position_m;
    if (i >= scene_.wall_vertices()) {
      box += colours[i].known();
      continue;
    }
    EXPECT_TRUE(!colours[i].known() || light_of(colours[i].red) < 0.2F) << p.transpose();
    if (std::max(std::abs(p.y()), std::abs(p.z())) > 0.3F) continue;  // from everywhere behind the box
    EXPECT_FALSE(colours[i].known()) << p.transpose();
    ++hidden;
  }
  EXPECT_GT(hidden, 30U);
  EXPECT_GT(box, 60U);
}

TEST_F(Colours, OfWhatNoImageShowsAreANeutralGrey) {
  KeyImage away = PaintedWall::image(0, 0);
  away.T_world_camera.R.leftCols<1>() *= -1;
  away.T_world_camera.R.rightCols<1>() *= -1;
  for (const VertexColour& colour : told_by({away})) EXPECT_EQ(colour, VertexColour{});
}

// The exposure nearly doubles between two images, the camera does not say so, and its lens is darker in the corners.
TEST_F(Colours, HaveNoSeamWhereTheExposureChanged) {
  const auto colours =
      told_by(PaintedWall::images([](int i, float y) { return PaintedWall::image(i, y, i < 3 ? 1.0F : 1.8F, 0.25F); }));
  for (int channel = 0; channel < 3; ++channel) {
    const std::vector<float> told = ratios(colours, channel);
    EXPECT_LT(part(told, 0.95) / part(told, 0.05), 1.10F);
  }
}

// The next sub-mesh's images go on from those of the last.
TEST_F(Colours, HaveNoSeamBetweenSubMeshes) {
  const auto first = told_by(PaintedWall::images([](int i, float y) { return PaintedWall::image(i, y); }));
  const auto second = told_by(PaintedWall::images([](int i, float y) { return PaintedWall::image(i, y, 1.8F); }));
  EXPECT_NEAR(part(ratios(second, 1), 0.5) / part(ratios(first, 1), 0.5), 1, 0.05);
}

TEST_F(Colours, OfOverexposedPixelsAreNotBelieved) {
  KeyImage bright = PaintedWall::image(0, 0);
  std::ranges::fill(bright.rgb, kBlindLevel);
  for (const VertexColour& colour : told_by({bright})) EXPECT_FALSE(colour.known());
}

// Given somebody who cannot wait, then nothing is looked at any more, it is counted, and the next sub-mesh has its own.
TEST_F(Colours, InAHurryAreLeftOutAndCounted) {
  const auto images = PaintedWall::images([](int i, float y) { return PaintedWall::image(i, y); });
  for (const VertexColour& colour : told_by(images, true)) EXPECT_FALSE(colour.known());
  EXPECT_EQ(colourist_.counts().images, 0U);
  EXPECT_EQ(colourist_.counts().hurried, images.size());
  EXPECT_NEAR(part(ratios(told_by(images), 1), 0.5), 1, 0.01);
  EXPECT_EQ(colourist_.counts().images, images.size());
}

// A passer-by in one image of seven.
TEST_F(Colours, OfSomethingThatPassedByAreLeftOut) {
  auto images = PaintedWall::images([](int i, float y) { return PaintedWall::image(i, y); });
  std::ranges::fill(images[3].rgb, 250);
  const std::vector<float> told = ratios(told_by(std::move(images)), 0);
  EXPECT_NEAR(part(told, 0.5), 1, 0.05);
}

// New is what has turned by ten degrees: in a room after half a metre, in a street of eight metres after 1.4 m.
TEST(KeyImages, AreThoseThatShowSomethingNew) {
  KeyImages images(1'000'000);
  images.add(PaintedWall::image(0, 0));
  const auto at = [](float y_m) { return PaintedWall::image(1, y_m).T_world_camera; };
  for (const auto& [scene_m, new_m] : {std::pair(0.0, 0.5F), {2.0, 0.5F}, {8.0, 1.41F}, {100.0, 2.0F}}) {
    EXPECT_FALSE(images.wants(at(new_m - 0.02F), scene_m, RigTime())) << scene_m;
    EXPECT_TRUE(images.wants(at(new_m + 0.02F), scene_m, RigTime())) << scene_m;
  }
  EXPECT_TRUE(images.wants(at(0.1F), 8.0, RigTime::from_ns(1))) << "for another sub-mesh it is new";
}

TEST(KeyImages, NeverTakeMoreThanTheirRoom) {
  const std::size_t bytes = PaintedWall::image(0, 0).rgb.size();
  KeyImages images(4 * bytes);
  for (int i = 0; i < 9; ++i) images.add(PaintedWall::image(i, static_cast<float>(i * i)));
  EXPECT_EQ(images.size(), 4U);
  EXPECT_EQ(images.dropped(), 5U);
  const auto early = images.take_until(RigTime::from_ns(5));
  EXPECT_TRUE(std::ranges::is_sorted(early, {}, &KeyImage::stamp));
  EXPECT_EQ(early.size() + images.size(), 4U);
}

}  // namespace
}  // namespace lxd::backend_colour_test
