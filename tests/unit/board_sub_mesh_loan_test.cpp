// SPDX-License-Identifier: Apache-2.0
// A retired sub-mesh goes from the filter to the one that writes, once, and comes back when it is stored.
#include <atomic>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "board/sub_mesh_loan.hpp"
#include "tests/support/mapping_scene.hpp"

namespace lxd::board_sub_mesh_loan_test {
namespace {

constexpr SubMeshCapacity kSmall{100, 100, 50, 4'000};
constexpr double kPath_m = 10;

class SubMeshLoanThread : public testing::Test {
 protected:
  SubMeshLoanThread() : arena_(std::size_t{8} << 20), map_(config(), {kSmall, kSmall}, *arena_) {}

  static MappingConfig config() {
    MappingConfig config;
    config.submesh_path_m = kPath_m;
    return config;
  }

  // As many sub-meshes as the window holds, and one more each time: that many have retired.
  void drive_on() {
    const Eigen::Vector3d origin_m(kPath_m * number_, 0, 0);
    map_.insert({{}, {}, origin_m, {0, 0, 2}, RigTime::from_ns(number_)});
    ++number_;
  }
  void drive_until_one_retires() {
    while (map_.retired() == nullptr) drive_on();
  }

  test::OwnedArena arena_;
  SurfaceMap map_;
  SubMeshLoan loan_;
  int number_ = 0;
};

TEST_F(SubMeshLoanThread, GivenNothingRetiredThenNothingIsLent) {
  drive_on();
  EXPECT_FALSE(loan_.exchange(map_));
  EXPECT_EQ(loan_.lent(), nullptr);
}

TEST_F(SubMeshLoanThread, GivenOneRetiredThenItIsLentOnceAndTakenBackWhenStored) {
  drive_until_one_retires();
  EXPECT_TRUE(loan_.exchange(map_));
  EXPECT_EQ(loan_.lent(), map_.retired());
  EXPECT_FALSE(loan_.exchange(map_));  // it is lent, not lent anew
  loan_.stored();
  EXPECT_EQ(loan_.lent(), nullptr);
  EXPECT_NE(map_.retired(), nullptr);  // until the filter comes by
  EXPECT_FALSE(loan_.exchange(map_));
  EXPECT_EQ(map_.retired(), nullptr);
}

// Given a writer so slow that another one retires meanwhile, then the one that is lent stays whole, the other is
// counted.
TEST_F(SubMeshLoanThread, GivenAnotherOneRetiresMeanwhileThenTheLentOneStays) {
  drive_until_one_retires();
  ASSERT_TRUE(loan_.exchange(map_));
  const RigTime begin = loan_.lent()->begin();
  drive_on();
  EXPECT_FALSE(loan_.exchange(map_));
  EXPECT_EQ(loan_.lent()->begin(), begin);
  EXPECT_EQ(map_.lost_sub_meshes(), 1U);
}

TEST_F(SubMeshLoanThread, GivenTwoThreadsThenEachSubMeshIsStoredOnceAndInOrder) {
  constexpr int kSubMeshes = 100;
  std::atomic<bool> ended{false};
  std::vector<RigTime> stored;
  std::thread writer([&] {
    while (!ended || loan_.lent() != nullptr) {
      if (const SubMesh* const sub_mesh = loan_.lent()) {
        stored.push_back(sub_mesh->begin());
        loan_.stored();
      }
      std::this_thread::yield();
    }
  });
  for (int lent = 0; lent < kSubMeshes; ++lent) {
    drive_until_one_retires();
    while (!loan_.exchange(map_)) std::this_thread::yield();
    while (loan_.lent() != nullptr) std::this_thread::yield();
    (void)loan_.exchange(map_);
  }
  ended = true;
  writer.join();
  ASSERT_EQ(stored.size(), static_cast<std::size_t>(kSubMeshes));
  for (int i = 0; i < kSubMeshes; ++i) EXPECT_EQ(stored[i], RigTime::from_ns(i));
}

}  // namespace
}  // namespace lxd::board_sub_mesh_loan_test
