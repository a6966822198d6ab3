// SPDX-License-Identifier: Apache-2.0
// The lattice's keys, the hash of cells, and the search for planes among waiting points.
#include <bit>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "mapping/cell_hash.hpp"
#include "mapping/plane_search.hpp"
#include "tests/support/property.hpp"

namespace lxd::mapping_cells_test {
namespace {

TEST(CellKey, PackingIsUndoneOverTheWholeRange) {
  constexpr int kLimit = 1 << 20;
  for (const int x : {-kLimit, -kLimit + 1, -1, 0, 1, kLimit - 1})
    for (const int z : {-kLimit, -1, 0, kLimit - 1}) EXPECT_EQ(unpack(pack({x, -x / 2, z})), CellIndex(x, -x / 2, z));
  test::check_property([] {
    const auto any = [] { return static_cast<int>(test::uniform(-kKeyOffset, kKeyOffset - 1)); };
    const CellIndex index(any(), any(), any());
    RC_ASSERT(unpack(pack(index)) == index);
  });
}

TEST(CellKey, CellsBelowZeroAreFloored) {
  EXPECT_EQ(cell_of({-0.01, -0.5, 0.49}, 2.0), CellIndex(-1, -1, 0));
  EXPECT_EQ(cell_of({-0.51, 0.5, -1.0}, 2.0), CellIndex(-2, 1, -2));
}

// Given places at the lattice's end and any distance beyond; then they are in its last cell.
TEST(CellKey, BeyondTheLatticeIsItsLastCell) {
  constexpr double kEnd = kCellMax;
  EXPECT_FALSE(is_last_cell(cell_of({kEnd - 0.5, 1.5 - kEnd, 0}, 1)));
  for (const double far : {kEnd, 1e9, 1e12, 1e300, std::numeric_limits<double>::infinity()}) {
    const CellIndex last = cell_of({far, -far, 0.5}, 1);
    EXPECT_EQ(last, CellIndex(kCellMax, -kCellMax, 0)) << far;
    EXPECT_TRUE(is_last_cell(last));
  }
  EXPECT_TRUE(is_last_cell(cell_of({0, std::numeric_limits<double>::quiet_NaN(), 0}, 1)));
}

TEST(CellHash, FindsEveryCellAtItsCapacityAndNoOther) {
  constexpr std::uint32_t kCells = 1000;
  std::vector<CellHash::Slot> slots(2048);
  CellHash hash(slots);
  const auto key = [](std::uint32_t i) { return pack({static_cast<int>(i) - 500, -7, static_cast<int>(i % 3)}); };
  for (std::uint32_t i = 0; i < kCells; ++i) hash.insert(key(i), i);
  for (std::uint32_t i = 0; i < kCells; ++i) ASSERT_EQ(hash.find(key(i)), i);
  for (std::uint32_t i = kCells; i < 2 * kCells; ++i) ASSERT_EQ(hash.find(key(i)), kNone);
}

TEST(CellHash, IsEmptyAfterEachOfManyClears) {
  std::vector<CellHash::Slot> slots(8);
  CellHash hash(slots);
  for (std::uint32_t i = 0; i < 100'000; ++i) {
    const CellKey key = pack({static_cast<int>(i % 5), 0, 0});
    ASSERT_EQ(hash.find(key), kNone);
    hash.insert(key, i);
    ASSERT_EQ(hash.find(key), i);
    hash.clear();
  }
}

class PlaneSearch : public testing::Test {
 protected:
  Eigen::Vector3f on_plane(const Eigen::Vector3f& origin, const Eigen::Vector3f& u, const Eigen::Vector3f& v) {
    return origin + unit_(random_) * u + unit_(random_) * v +
           Eigen::Vector3f(noise_(random_), noise_(random_), noise_(random_));
  }
  [[nodiscard]] PlaneCandidate search() const { return search_plane(points_, kNoise * kNoise, config_, 1); }

  static constexpr float kNoise = 0.005F;  // m, of a point in each axis

  MappingConfig config_;
  std::vector<Eigen::Vector3f> points_;
  std::mt19937 random_{2};
  std::uniform_real_distribution<float> unit_{0, 1};
  std::normal_distribution<float> noise_{0, kNoise};
};

TEST_F(PlaneSearch, FindsThePlaneOfAllPoints) {
  for (int i = 0; i < 20; ++i) points_.push_back(on_plane({0, 0, 0.2F}, {0.5F, 0, 0}, {0, 0.5F, 0}));
  const PlaneCandidate plane = search();
  ASSERT_TRUE(plane.found);
  EXPECT_GT(std::abs(plane.normal.z()), 0.99F);
  EXPECT_NEAR(plane.centre_m.z(), 0.2F, 0.01F);
  EXPECT_EQ(plane.members, (1U << 20) - 1);
}

TEST_F(PlaneSearch, RejectsALine) {
  for (int i = 0; i < 20; ++i) points_.push_back(on_plane({0, 0, 0.2F}, {0.5F, 0, 0}, {0, 0, 0}));
  EXPECT_FALSE(search().found);
}

// A rectangle of edge ratio r has lambda_3 / lambda_2 = r^2: a regular grid shows the threshold exactly.
TEST_F(PlaneSearch, PlanarityThresholdIsMeant) {
  const auto grid = [this](double ratio) {
    points_.clear();
    const auto width = static_cast<float>(0.4 / std::sqrt(ratio));
    for (int i = 0; i < 4; ++i)
      for (int k = 0; k < 4; ++k)
        points_.emplace_back(0.4F * static_cast<float>(i) / 3, width * static_cast<float>(k) / 3, 0.0F);
    return search().found;
  };
  EXPECT_TRUE(grid(config_.planarity_max_ratio * 0.98));
  EXPECT_FALSE(grid(config_.planarity_max_ratio * 1.02));
  config_.planarity_max_ratio = 16.0;
  EXPECT_TRUE(grid(15.9));
  EXPECT_FALSE(grid(16.1));
}

TEST_F(PlaneSearch, TwoWallsOfACornerAreTwoPlanes) {
  for (int i = 0; i < 16; ++i) {
    points_.push_back(on_plane({0, 0, 0}, {0.5F, 0, 0}, {0, 0, 0.5F}));
    points_.push_back(on_plane({0, 0, 0}, {0, 0.5F, 0}, {0, 0, 0.5F}));
  }
  const PlaneCandidate plane = search();
  ASSERT_TRUE(plane.found);
  EXPECT_GT(plane.normal.cwiseAbs().maxCoeff(), 0.95F);
  EXPECT_LT(std::abs(plane.normal.z()), 0.2F);
  EXPECT_LT(std::popcount(plane.members), 26);
}

// With a thickness of 4 % of the cloud's edge; the thicker a layer may be, the more planes chance makes.
TEST_F(PlaneSearch, FoliageHasHardlyAnyPlane) {
  config_.layer_thickness_max_m = 0.009;
  int found = 0;
  for (int cloud = 0; cloud < 200; ++cloud) {
    points_.clear();
    for (int i = 0; i < kWaitingMax; ++i)
      points_.emplace_back(unit_(random_) / 2, unit_(random_) / 2, unit_(random_) / 2);
    found += search_plane(points_, kNoise * kNoise, config_, static_cast<std::uint64_t>(cloud)).found;
  }
  EXPECT_LE(found, 4) << "of 200";
}

TEST_F(PlaneSearch, TooFewPointsMakeNoPlane) {
  for (int i = 0; i + 1 < config_.layer_points_min; ++i)
    points_.push_back(on_plane({0, 0, 0}, {0.5F, 0, 0}, {0, 0.5F, 0}));
  EXPECT_FALSE(search().found);
}

TEST(WaitingPoint, QuantisationLosesLessThanTheirNoise) {
  const Eigen::Vector3f p(0.1234F, 0.0F, 0.5F);
  const WaitingPoint q = quantise(p, 0.0213F, 2.0F);
  EXPECT_LT((position_of(q, 0.5F) - p).cwiseAbs().maxCoeff(), 1e-5F);
  EXPECT_NEAR(std::sqrt(variance_of(q)), 0.0213F, 1e-4F);
}

}  // namespace
}  // namespace lxd::mapping_cells_test
