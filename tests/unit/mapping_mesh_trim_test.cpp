// SPDX-License-Identifier: Apache-2.0
// A surface ends where its beams do, not at the next line of the lattice.
#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "mapping/free_space.hpp"
#include "mapping/mesh_trim.hpp"
#include "tests/support/mapping_scene.hpp"

namespace lxd::mapping_mesh_trim_test {
namespace {

using Eigen::Vector3d, Eigen::Vector3f;
using Shares = std::array<float, 4>;  // low v, high u, high v, low u

QuadBeams met_in(std::uint16_t parts, std::uint8_t ends) { return {.passes = 0, .ends = ends, .met = parts}; }

TEST(QuadOverhang, IsWhatBeamsLeftEmptyAtASide) {
  constexpr float kByChance = 0.1F;
  EXPECT_EQ(met_in(0, 0).overhang(), Shares({0, 0, 0, 0}));
  EXPECT_EQ(met_in(0xFFFF, 9).overhang(), Shares({0, 0, 0, 0}));
  EXPECT_EQ(met_in(0x3333, 9).overhang(), Shares({0, 0.5F - kByChance, 0, 0}));
  EXPECT_EQ(met_in(0x8888, 9).overhang(), Shares({0, 0, 0, 0.75F - kByChance}));
  EXPECT_EQ(met_in(0x00F0, 9).overhang(), Shares({0.25F - kByChance, 0, 0.5F - kByChance, 0}));
}

// One beam in a quad leaves most of it empty whatever there is.
TEST(QuadOverhang, OfAFewBeamsSaysLittle) {
  EXPECT_FLOAT_EQ(met_in(0x0001, 1).overhang()[1], 0.25F);
  EXPECT_FLOAT_EQ(met_in(0x0011, 2).overhang()[1], 0.75F - 1.0F / 3);
}

TEST(QuadOverhang, OfANotchIsLessThanHalfAndNothingWhereBeamsAreRare) {
  std::array<std::uint32_t, kLayerQuads> beams{};
  const auto share = [&](std::uint8_t ends) {
    beams[3] = beams[7] = met_in(0xFFFF, ends).bits();
    return overhang_of_notch(beams, 1U << 3 | 1U << 7)[0];
  };
  EXPECT_EQ(share(0), 0);
  EXPECT_EQ(share(1), 0);
  EXPECT_FLOAT_EQ(share(9), 0.4F);
  EXPECT_EQ(overhang_of_notch(beams, 0)[0], 0);
}

// Two quads side by side, 0.1 m wide: of the right one half sticks out to the right, and of both half upwards, by what
// the left one says alone.
class TwoQuads : public testing::Test {
 protected:
  TwoQuads() {
    for (int i = 0; i < 6; ++i)
      topology_.add_vertex({0.1F * static_cast<float>(i % 3), 0.1F * static_cast<float>(i / 3), 0.0F}, 1e-4F, 4);
    for (const auto& [a, b, c] : {std::tuple(0U, 1U, 4U), {0U, 4U, 3U}, {1U, 2U, 5U}, {1U, 5U, 4U}})
      topology_.add_face(a, b, c);
  }
  std::uint64_t trim(std::span<LatticeEntry> storage) {
    MeshTrim trim(topology_, storage);
    trim.add({0, 1, 4, 3}, {0, 0.5F, 0.5F, 0});
    trim.add({1, 2, 5, 4}, {0, 0.5F, 0, 0});
    return trim.apply();
  }
  void expect_at(std::uint32_t vertex, float x_m, float y_m) {
    EXPECT_LT((topology_.vertex(vertex).position_m - Vector3f(x_m, y_m, 0)).norm(), 1e-6F) << vertex;
  }

  test::OwnedArena arena_{std::size_t{1} << 16};
  MeshTopology topology_{6, 4, *arena_};
};

TEST_F(TwoQuads, OpenSidesAreDrawnInByTheMeanOfTheirQuads) {
  std::array<LatticeEntry, 12> storage;
  EXPECT_EQ(trim(storage), 0U);
  expect_at(0, 0, 0);
  expect_at(1, 0.1F, 0);  // its side of the right and the left quad is not open
  expect_at(2, 0.15F, 0);
  expect_at(3, 0, 0.05F);
  expect_at(4, 0.1F, 0.075F);
  expect_at(5, 0.15F, 0.0875F);  // towards where its neighbour now is
}

// Six open sides are twelve pulls.
TEST_F(TwoQuads, PullsWithoutRoomAreCounted) {
  std::array<LatticeEntry, 11> storage;
  EXPECT_EQ(trim(storage), 1U);
}

// A floor that ends in the middle of a square of the lattice, and beams to all of it.
class Floor {
 public:
  explicit Floor(double spacing_m) {
    scene_.add_patch({0, 0, 0.25F}, {kEnd_m, 0, 0}, {0, 2, 0});
    scene_.fuse(kLidar_m.cast<float>());
    for (double x = spacing_m / 2; x < kEnd_m; x += spacing_m)
      for (double y = spacing_m / 2; y < 2; y += spacing_m) beams_.push_back({kLidar_m, {x, y, 0.25}});
  }
  // The mesh's farthest vertex along x.
  float reach_m() {
    struct Once final : BeamSource {
      explicit Once(std::span<const Beam> all) : beams(all) {}
      std::span<const Beam> next() override { return std::exchange(beams, {}); }
      std::span<const Beam> beams;
    } once(beams_);
    float reach_m = 0;
    for (const MeshVertex& v : scene_.extraction.extract(scene_.sub_mesh, once).vertices)
      reach_m = std::max(reach_m, v.position_m.x());
    return reach_m;
  }
  void forget_beams() { beams_.clear(); }

  static constexpr float kEnd_m = 2.24F, kLatticeLine_m = 2.3F;

 private:
  const Vector3d kLidar_m{1, 1, 3};
  test::MappingScene scene_;
  std::vector<Beam> beams_;
};

TEST(MeshTrim, AFloorEndsWhereItsBeamsEnd) {
  Floor floor(0.01);
  EXPECT_NEAR(floor.reach_m(), Floor::kEnd_m, 0.02);
  floor.forget_beams();
  EXPECT_FLOAT_EQ(floor.reach_m(), Floor::kLatticeLine_m);
}

TEST(MeshTrim, AFewBeamsTakeLittleAway) { EXPECT_GT(Floor(0.1).reach_m(), Floor::kEnd_m); }

}  // namespace
}  // namespace lxd::mapping_mesh_trim_test
