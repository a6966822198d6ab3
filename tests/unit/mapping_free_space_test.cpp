// SPDX-License-Identifier: Apache-2.0
// Surfaces that beams go through are not in the mesh; surfaces that stand there are.
#include <random>

#include <gtest/gtest.h>

#include "mapping/cell_filter.hpp"
#include "mapping/free_space.hpp"
#include "tests/support/mapping_scene.hpp"

namespace lxd::mapping_free_space_test {
namespace {

using Eigen::Vector3d, Eigen::Vector3f;
using test::MappingScene;

const Vector3d kLidar_m(0, 1, 1);
constexpr float kWall_m = 4.0F, kPasser_m = 2.0F;  // x

class InParts final : public BeamSource {
 public:
  InParts(std::span<const Beam> beams, std::size_t part) : beams_(beams), part_(part) {}
  std::span<const Beam> next() override {
    const auto some = beams_.first(std::min(part_, beams_.size()));
    beams_ = beams_.subspan(some.size());
    return some;
  }

 private:
  std::span<const Beam> beams_;
  std::size_t part_;
};

// A wall, and half way a passer-by who was seen for a moment: 1 x 1 m.
struct Passage {
  Passage() {
    scene.add_patch({kWall_m, 0, 0.25F}, {0, 2, 0}, {0, 0, 1.5F});
    scene.add_patch({kPasser_m, 0.5F, 0.5F}, {0, 1, 0}, {0, 0, 1});
    scene.fuse(kLidar_m.cast<float>());
  }

  // Ends on a grid of so many by so many over the patch of the wall that the passer-by hid, `times` over.
  void beams_to_wall(int edge, int times) {
    for (int i = 0; i < edge * edge * times; ++i) {
      const double y = (i % edge + 0.5) / edge, z = (i / edge % edge + 0.5) / edge;
      beams.push_back({kLidar_m, {kWall_m, 2 * y, 2 * z}});
    }
  }
  void beams_to_passer(int edge, int times) {
    for (int i = 0; i < edge * edge * times; ++i)
      beams.push_back({kLidar_m, {kPasser_m, 0.5 + (i % edge + 0.5) / edge, 0.5 + (i / edge % edge + 0.5) / edge}});
  }

  // Faces near x, and what the beams were asked for in parts.
  std::size_t faces_at(float x_m, std::size_t part = 1000) {
    InParts parts(beams, part);
    const auto mesh = scene.extraction.extract(scene.sub_mesh, parts);
    return static_cast<std::size_t>(std::ranges::count_if(
        mesh.faces, [&](const MeshFace& f) { return std::abs(mesh.vertices[f[0]].position_m.x() - x_m) < 0.1F; }));
  }

  MappingScene scene;
  std::vector<Beam> beams;
};

TEST(FreeSpace, WithoutBeamsAllIsThere) {
  Passage passage;
  EXPECT_GE(passage.faces_at(kPasser_m), 150U);
  EXPECT_GE(passage.faces_at(kWall_m), 500U);
}

// Given a passer-by and then twenty looks at the wall behind him, then the wall alone is left.
TEST(FreeSpace, WhoPassedByIsNotInTheMesh) {
  Passage passage;
  passage.beams_to_passer(20, 1);
  const std::size_t wall = passage.faces_at(kWall_m);
  passage.beams_to_wall(20, 20);
  EXPECT_EQ(passage.faces_at(kPasser_m), 0U);
  EXPECT_EQ(passage.faces_at(kWall_m), wall);
}

// One beam through a quad is an accident; two are not, unless more than four times as many end on it.
TEST(FreeSpace, AFewBeamsAmongManyProveNothing) {
  constexpr int kQuads = 10, kEndsPerPass = 4;
  Passage one, two, contradicted;
  const auto through = [](Passage& passage, int times) {
    for (int i = 0; i < kQuads * kQuads * times; ++i) {
      const Vector3d on(kPasser_m, 0.55 + 0.1 * (i % kQuads), 0.55 + 0.1 * (i / kQuads % kQuads));
      passage.beams.push_back({kLidar_m, kLidar_m + 2 * (on - kLidar_m)});
    }
  };
  through(one, 1);
  through(two, 2);
  through(contradicted, 2);
  contradicted.beams_to_passer(kQuads, 2 * kEndsPerPass);
  const std::size_t all = Passage().faces_at(kPasser_m);
  EXPECT_EQ(one.faces_at(kPasser_m), all);
  EXPECT_EQ(two.faces_at(kPasser_m), 0U);
  EXPECT_EQ(contradicted.faces_at(kPasser_m), all);
}

// Given beams that each go through one surface in the first cells of a block, where walks over blocks and over cells
// differ by rounding, then each passes it once.
TEST(FreeSpace, ABeamPassesASurfaceOnce) {
  constexpr int kBeams = 4000;
  MappingScene scene;
  scene.add_patch({2.02F, 0, 0}, {0, 2, 0}, {0, 0, 2});  // blocks begin every two metres
  scene.fuse({0, 1, 1});
  std::vector<Beam> beams;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(0.1, 1.9);
  for (int i = 0; i < kBeams; ++i)
    beams.push_back({{0.1 * place(random), 2 - place(random), 1}, {4.4, place(random), place(random)}});
  InParts source(beams, beams.size());
  const std::size_t layers = scene.sub_mesh.layer_count();
  std::vector<std::uint32_t> quads(layers), counts(layers * kBeamCounts), scratch(1024);
  std::vector<std::int8_t> sides(layers);
  for (std::size_t i = 0; i < layers; ++i) quads[i] = scene.sub_mesh.layer(static_cast<std::uint32_t>(i)).seen_quads;
  judge_by_beams(scene.sub_mesh, source, static_cast<float>(MappingConfig{}.cell_size_m), {quads, sides, counts},
                 scratch);
  int passes = 0;
  for (std::size_t i = 0; i < counts.size(); ++i)
    if (i % kBeamCounts != kLayerQuads) passes += QuadBeams::of(counts[i]).passes;
  EXPECT_GT(passes, kBeams / 2);
  EXPECT_LE(passes, kBeams);
}

// However few words, cells of either sign: what was put in is said to be there, and with many words little else is.
TEST(CellFilter, HoldsWhatWasPutIn) {
  std::mt19937 random(5);
  std::uniform_int_distribution<int> place(-500, 500);
  for (const std::size_t count : {2U, 7U, 4096U, 1U << 18}) {
    std::vector<std::uint32_t> words(count, ~0U);
    CellFilter filter(words);
    std::vector<CellIndex> cells;
    for (int i = 0; i < 200; ++i) cells.emplace_back(place(random), place(random), place(random));
    for (const CellIndex& cell : cells) filter.insert(cell);
    const auto holds = [&](const CellIndex& cell) {
      return (filter.cells_of(CellFilter::block_of(cell)) & CellFilter::bit_of(cell)) != 0;
    };
    EXPECT_TRUE(std::ranges::all_of(cells, holds)) << count;
    int strangers = 0;
    for (int i = 0; i < 1000; ++i) strangers += holds({place(random), place(random), place(random)});
    if (count >= 4096) {
      EXPECT_LT(strangers, 20) << count;
    }
  }
}

// Given beams that end up to half a quad behind the wall, as noise and a flat angle make them, then it stays.
TEST(FreeSpace, WhatEndsJustBehindASurfaceHasMetIt) {
  Passage passage;
  const std::size_t wall = passage.faces_at(kWall_m);
  for (int i = 0; i < 4000; ++i) passage.beams.push_back({kLidar_m, {kWall_m + 0.05, 0.0005 * i, 0.3 + 0.0003 * i}});
  for (int i = 0; i < 4000; ++i) passage.beams.push_back({{kWall_m - 0.1, -3, 1}, {kWall_m + 0.05, 0.0005 * i, 1}});
  EXPECT_EQ(passage.faces_at(kWall_m), wall);
}

TEST(FreeSpace, InHowManyPartsBeamsComeMakesNoDifference) {
  Passage passage;
  passage.beams_to_wall(13, 1);
  const std::size_t at_once = passage.faces_at(kPasser_m, 1000);
  EXPECT_EQ(passage.faces_at(kPasser_m, 1), at_once);
  EXPECT_EQ(passage.faces_at(kPasser_m, 7), at_once);
}

// Given a wall whose side was told wrong, as under a flat angle, when beams come to it, then it shows to where they
// came from; two of them could be strays.
TEST(FreeSpace, ASurfaceShowsToWhereItsBeamsCameFrom) {
  const Vector3d behind(2 * kWall_m, 1, 1);
  for (const int beams : {2, 4000}) {
    Passage passage;
    for (int i = 0; i < beams; ++i)
      passage.beams.push_back({behind, {kWall_m, (i % 64 + 0.5) / 32, 0.25 + (i / 64 + 0.5) / 43}});
    InParts parts(passage.beams, passage.beams.size());
    const auto mesh = passage.scene.extraction.extract(passage.scene.sub_mesh, parts);
    double towards = 0;
    for (const MeshVertex& v : mesh.vertices)
      if (v.position_m.x() > 3) towards += static_cast<double>(v.normal.x());
    EXPECT_EQ(towards > 0, beams > 2);
  }
}

// Beams that are no beams, and such as leave the lattice, are passed over.
TEST(FreeSpace, WhatIsNoBeamChangesNothing) {
  Passage passage;
  const std::size_t all = passage.faces_at(kPasser_m);
  constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();
  for (int i = 0; i < 10; ++i) {
    passage.beams.push_back({kLidar_m, kLidar_m});
    passage.beams.push_back({kLidar_m, {kNowhere, 0, 0}});
    passage.beams.push_back({{kNowhere, 0, 0}, kLidar_m});
    passage.beams.push_back({kLidar_m, {1e12, 1, 1}});
    passage.beams.push_back({{std::numeric_limits<double>::infinity(), 0, 0}, kLidar_m});
  }
  EXPECT_EQ(passage.faces_at(kPasser_m), all);
}

}  // namespace
}  // namespace lxd::mapping_free_space_test
