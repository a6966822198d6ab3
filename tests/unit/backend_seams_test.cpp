// SPDX-License-Identifier: Apache-2.0
// Where sub-meshes show one surface the exported map has one layer, where all together say; where they do not it is as
// it was.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include <gtest/gtest.h>

#include "backend/mesh_export.hpp"
#include "backend/seams/rim_distance.hpp"
#include "tests/support/file_bytes.hpp"
#include "tests/support/seam_story.hpp"

namespace lxd::backend_seams_test {
namespace {

using test::ExportedMap;
using test::SeamStory;
using test::SyntheticMesh;

// Given two looks at one floor, 3 cm apart, the second with three times the variance, when they are exported, then one
// floor is left, a quarter of the way up, and better known than either, but not by more than the 3 cm allow.
TEST(Seams, TwoLayersOfAFloorBecomeOneByInverseVariance) {
  SeamStory story;
  story.add_floor(0, 0, 4, 4, 0, 1e-4F);
  story.add_floor(0, 0, 4, 4, 0.03F, 3e-4F);
  const ExportedMap map = story.fused();
  EXPECT_NEAR(static_cast<double>(map.mesh.faces.size()) / static_cast<double>(story.faces()), 0.5, 0.05);
  constexpr float kIndependent_m2 = 0.75e-4F, kChi2 = 0.03F * 0.03F / 4e-4F;
  for (const MeshVertex& v : map.mesh.vertices) {
    EXPECT_NEAR(v.position_m.z(), 0.0075F, 1e-4F);
    EXPECT_NEAR(v.variance_m2, kIndependent_m2 * kChi2, 1e-6F);
    EXPECT_GT(v.normal.z(), 0.9999F);
  }
}

TEST(Seams, LayersThatAgreeAreKnownBetter) {
  SeamStory story;
  story.add_floor(0, 0, 4, 4, 0, 1e-4F);
  story.add_floor(0, 0, 4, 4, 0.002F, 1e-4F);
  story.add_floor(0, 0, 4, 4, 0.001F, 1e-4F);
  const ExportedMap map = story.fused();
  for (const MeshVertex& v : map.mesh.vertices) EXPECT_NEAR(v.variance_m2, 1e-4F / 3, 1e-7F);
  EXPECT_NEAR(static_cast<double>(map.mesh.faces.size()) / static_cast<double>(story.faces()), 1.0 / 3, 0.05);
}

// A wall of 8 cm, one side seen on the way there and the other on the way back.
TEST(Seams, TheTwoSidesOfAThinWallStayTwo) {
  for (const float thickness_m : {0.02F, 0.08F, 0.2F}) {
    SeamStory story;
    SyntheticMesh front, back;
    front.add_patch({0, 0, 0}, {4, 0, 0}, {0, 0, 2.5}, SeamStory::kSpacing_m);
    back.add_patch({0, thickness_m, 0}, {0, 0, 2.5}, {4, 0, 0}, SeamStory::kSpacing_m);
    story.add(front);
    story.add(back);
    const ExportedMap map = story.fused();
    EXPECT_EQ(map.mesh.faces.size(), story.faces());
    for (const MeshVertex& v : map.mesh.vertices) EXPECT_FLOAT_EQ(v.position_m.y(), v.normal.y() < 0 ? 0 : thickness_m);
  }
}

TEST(Seams, AStepOfAKerbStays) {
  SeamStory story;
  story.add_floor(0, 0, 4, 4, 0);
  story.add_floor(0, 0, 4, 4, 0.12F);
  const ExportedMap map = story.fused();
  EXPECT_EQ(map.mesh.faces.size(), story.faces());
}

// Well known layers that lie apart by more than variances and poses explain are two surfaces.
TEST(Seams, WhatCannotBeOneSurfaceByItsVarianceIsNotFused) {
  SeamStory story;
  story.add_floor(0, 0, 4, 4, 0, 1e-6F);
  story.add_floor(0, 0, 4, 4, 0.08F, 1e-6F);
  EXPECT_EQ(story.fused().mesh.faces.size(), story.faces());
  SeamStory less_known;
  less_known.add_floor(0, 0, 4, 4, 0, 1e-3F);
  less_known.add_floor(0, 0, 4, 4, 0.08F, 1e-3F);
  EXPECT_LT(less_known.fused().mesh.faces.size(), 0.6 * static_cast<double>(less_known.faces()));
}

// Two stretches of a floor that lie over each other for two metres, the second 3 cm higher and turned by 20 degrees.
class Stretches : public ::testing::Test {
 protected:
  static constexpr float kStep_m = 0.03F;

  static SeamStory story(bool turned_first = false) {
    SyntheticMesh level, turned;
    level.add_patch({0, 0, 0}, {5, 0, 0}, {0, 4, 0}, SeamStory::kSpacing_m);
    turned.add_patch({-2, -5, 0}, {8, 0, 0}, {0, 8, 0}, SeamStory::kSpacing_m);
    const Pose T_map_turned{Eigen::AngleAxisd(0.35, Eigen::Vector3d::UnitZ()).toRotationMatrix(), {4, 2, kStep_m}};
    SeamStory story;
    if (turned_first) story.add(turned, T_map_turned);
    story.add(level);
    if (!turned_first) story.add(turned, T_map_turned);
    return story;
  }

  // Of places well within what both together show.
  static std::vector<Eigen::Vector2f> places() {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> x(0.3F, 6), y(0.3F, 3.7F);
    std::vector<Eigen::Vector2f> places;
    for (int i = 0; i < 1500; ++i) places.emplace_back(x(random), y(random));
    return places;
  }
};

TEST_F(Stretches, AreCoveredOnceEverywhere) {
  const ExportedMap map = story().fused();
  int none = 0, several = 0;
  for (const Eigen::Vector2f& p : places()) {
    const int faces = map.sound(p.x(), p.y()).faces;
    none += faces == 0 ? 1 : 0;
    several += faces > 1 ? 1 : 0;
  }
  EXPECT_LT(none, 6) << "of 1500";
  EXPECT_LT(several, 30) << "of 1500";
}

TEST_F(Stretches, HaveNoStepAtTheRim) {
  const ExportedMap map = story().fused();
  float low = kStep_m, high = 0, steepest = 0;
  for (const Eigen::Vector2f& p : places()) {
    constexpr float kBeside_m = 0.02F;
    const auto here = map.sound(p.x(), p.y()), beside = map.sound(p.x() + kBeside_m, p.y());
    if (here.faces == 0 || beside.faces == 0) continue;
    low = std::min(low, here.z_m);
    high = std::max(high, here.z_m);
    steepest = std::max(steepest, std::abs(here.z_m - beside.z_m) / kBeside_m);
  }
  EXPECT_NEAR(low, 0, 1e-4) << "far from the other as it was";
  EXPECT_NEAR(high, kStep_m, 1e-4);
  EXPECT_LT(steepest, 0.12) << "3 cm over half a metre, where the rims themselves were a step";
}

// Of the earlier stretch's rim, where it was cut along the seam.
TEST_F(Stretches, MeetVertexByVertex) {
  const ExportedMap map = story().fused();
  std::vector<MeshFace> earlier;
  std::vector<bool> is_later(map.mesh.vertices.size(), true);
  for (std::size_t i = 0; i < map.mesh.faces.size(); ++i)
    if (map.submesh_of_face[i] == 0) earlier.push_back(map.mesh.faces[i]);
  for (const MeshFace& face : earlier)
    for (const std::uint32_t v : face) is_later[v] = false;
  std::vector<std::uint8_t> rings;
  measure_rim_distance(map.mesh.vertices.size(), earlier, rings);
  int rim = 0, met = 0;
  for (std::size_t i = 0; i < map.mesh.vertices.size(); ++i) {
    const Eigen::Vector3f& p = map.mesh.vertices[i].position_m;
    const bool is_inside = p.x() > 0.3F && p.x() < 4.7F && p.y() > 0.3F && p.y() < 3.7F;
    if (is_later[i] || rings[i] > 0 || !is_inside) continue;
    ++rim;
    for (std::size_t j = 0; j < map.mesh.vertices.size(); ++j)
      if (is_later[j] && (map.mesh.vertices[j].position_m - p).norm() < 1e-5F) {
        ++met;
        break;
      }
  }
  EXPECT_GT(rim, 30);
  EXPECT_GT(met, 0.8 * rim);
}

TEST_F(Stretches, AreTheSameSurfaceWhicheverCameFirst) {
  const ExportedMap one = story(false).fused(), other = story(true).fused();
  int compared = 0;
  for (const Eigen::Vector2f& p : places()) {
    const auto a = one.sound(p.x(), p.y()), b = other.sound(p.x(), p.y());
    if (a.faces == 0 || b.faces == 0) continue;
    EXPECT_NEAR(a.z_m, b.z_m, 0.002);
    ++compared;
  }
  EXPECT_GT(compared, 1480);
}

TEST_F(Stretches, LoseNothingWhereOnlyOneIs) {
  SyntheticMesh level;
  level.add_patch({0, 0, 0}, {5, 0, 0}, {0, 4, 0}, SeamStory::kSpacing_m);
  const ExportedMap map = story().fused();
  std::size_t found = 0, wanted = 0;
  for (const MeshVertex& v : level.vertices) {
    if (v.position_m.x() > 0.9F) continue;  // where the other begins
    ++wanted;
    found +=
        std::ranges::any_of(map.mesh.vertices, [&](const MeshVertex& w) { return std::memcmp(&v, &w, sizeof v) == 0; })
            ? 1U
            : 0U;
  }
  EXPECT_EQ(found, wanted);
}

TEST_F(Stretches, GiveTheSameBytesEveryTime) {
  SeamStory two = story();
  const Archive archive = two.archive();
  const std::filesystem::path out = two.folder() / "out";
  std::filesystem::create_directory(out);
  for (const char* name : {"a.ply", "b.ply"}) ASSERT_TRUE(write_mesh_ply(out / name, archive).ok());
  for (const char* name : {"a.glb", "b.glb"}) ASSERT_TRUE(write_mesh_glb(out / name, archive).ok());
  EXPECT_EQ(test::read_file(out / "a.ply"), test::read_file(out / "b.ply"));
  EXPECT_EQ(test::read_file(out / "a.glb"), test::read_file(out / "b.glb"));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(out), {}), 4) << "and nothing is left behind";
}

// A seam across the borders of the tiles that the work is done by is the same as within one.
TEST(Seams, TilesDoNotShow) {
  const auto fused_at = [](float x, float y) {
    SeamStory story;
    story.add_floor(x, y, 4, 2, 0);
    story.add_floor(x + 2, y, 4, 2, 0.03F);
    return story.fused();
  };
  const ExportedMap within = fused_at(1, 1), across = fused_at(5, 7);
  ASSERT_EQ(within.mesh.faces.size(), across.mesh.faces.size());
  ASSERT_EQ(within.mesh.vertices.size(), across.mesh.vertices.size());
  const Eigen::Vector3f shift_m(4, 6, 0);
  for (std::size_t i = 0; i < within.mesh.vertices.size(); ++i)
    EXPECT_LT((within.mesh.vertices[i].position_m + shift_m - across.mesh.vertices[i].position_m).norm(), 1e-5F) << i;
}

TEST(Seams, AnUncolouredLayerTakesTheColourOfTheOther) {
  const VertexColour red{200, 10, 10, 3}, blue{10, 10, 200, 2};
  SeamStory story;
  story.add_floor(0, 0, 4, 4, 0, 1e-4F);
  story.add_floor(0, 0, 4, 4, 0.01F, 1e-4F, red);
  for (const VertexColour& colour : story.fused().colours) EXPECT_EQ(colour, red);
  SeamStory both;
  both.add_floor(0, 0, 4, 4, 0, 1e-4F, blue);
  both.add_floor(2, 0, 4, 4, 0.01F, 1e-4F, red);
  const ExportedMap map = both.fused();
  for (std::size_t i = 0; i < map.colours.size(); ++i) {
    const Eigen::Vector3f& p = map.mesh.vertices[i].position_m;
    if (p.y() < 1 || p.y() > 3) continue;  // far from other rims the seam is in the middle of what both show
    if (p.x() < 2.7F) {
      EXPECT_EQ(map.colours[i], blue) << p.transpose();
    }
    if (p.x() > 3.3F) {
      EXPECT_EQ(map.colours[i], red) << p.transpose();
    }
  }
}

// What has no finite place, or none on the lattice, is passed on as it is.
TEST(Seams, PlacesThatAreNoneAreLeftAlone) {
  SeamStory story;
  SyntheticMesh broken;
  broken.add_patch({0, 0, 0}, {4, 0, 0}, {0, 4, 0}, SeamStory::kSpacing_m);
  broken.vertices[40].position_m.x() = std::nanf("");
  broken.vertices[41].position_m.y() = 1e30F;
  broken.vertices[42].normal.setConstant(std::nanf(""));
  broken.vertices[43].variance_m2 = std::nanf("");
  story.add(broken);
  story.add_floor(0, 0, 4, 4, 0.01F);
  const ExportedMap map = story.fused();
  EXPECT_EQ(std::ranges::count_if(map.mesh.vertices, [](const MeshVertex& v) { return !v.position_m.allFinite(); }), 1);
  EXPECT_LT(map.mesh.faces.size(), story.faces());
}

TEST(Seams, AMapOfOneSubmeshIsAsItWas) {
  SeamStory story;
  SyntheticMesh room;
  room.add_room({0, 0, 0}, {6, 4, 3});
  story.add(room);
  const ExportedMap map = story.fused();
  ASSERT_EQ(map.mesh.vertices.size(), room.vertices.size());
  EXPECT_EQ(std::memcmp(map.mesh.vertices.data(), room.vertices.data(), room.vertices.size() * sizeof(MeshVertex)), 0);
  EXPECT_EQ(map.mesh.faces, room.faces);
}

TEST(RimDistance, CountsEdgesFromTheRim) {
  SyntheticMesh mesh;
  mesh.add_patch({0, 0, 0}, {3, 0, 0}, {0, 3, 0}, 0.1F);
  const auto at = [](int i, int j) { return static_cast<std::size_t>(j * 31 + i); };
  mesh.vertices.push_back(mesh.vertices[0]);  // of no face
  std::vector<std::uint8_t> rings;
  measure_rim_distance(mesh.vertices.size(), mesh.faces, rings);
  EXPECT_EQ(rings[at(0, 15)], 0);
  EXPECT_EQ(rings[at(1, 15)], 1);
  EXPECT_EQ(rings[at(3, 15)], 3);
  EXPECT_EQ(rings[at(15, 15)], kRingsMax);
  EXPECT_EQ(rings.back(), 0);
  mesh.faces.erase(mesh.faces.begin() + 2 * (15 * 30 + 15));  // a hole in the middle
  measure_rim_distance(mesh.vertices.size(), mesh.faces, rings);
  EXPECT_EQ(rings[at(15, 15)], 0);
  EXPECT_EQ(rings[at(18, 18)], 2);
}

}  // namespace
}  // namespace lxd::backend_seams_test
