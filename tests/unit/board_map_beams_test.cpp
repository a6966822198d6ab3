// SPDX-License-Identifier: Apache-2.0
// Which beams belong to which sub-mesh.
#include <gtest/gtest.h>

#include "board/map_beams.hpp"
#include "mapping/surface_map.hpp"
#include "tests/support/temporary_folder.hpp"

namespace lxd::board_map_beams_test {
namespace {

const RigTime kFirst = RigTime::from_ns(1'000'000'000);

RigTime begin_of(int sub_mesh) { return kFirst + Duration::from_ns(1'000'000'000LL * sub_mesh); }

struct Beams {
  test::TemporaryFolder folder;
  Result<MapBeams> beams = MapBeams::create(folder.path());
  std::vector<RegisteredPoint> points{{{1, 0, 0}, 10, 0.5F}, {{2, 0, 0}, 10, 0}, {{3, 0, 0}, 10, 0}};

  void sweep(int sub_mesh, std::uint32_t primary) {
    SweepOutcome outcome;
    outcome.registered = points;
    outcome.registered_primary = primary;
    outcome.registered_origin_m = {100, 0, 0};
    ASSERT_TRUE(beams->take(outcome, begin_of(sub_mesh)));
  }
  [[nodiscard]] std::uint64_t count(int sub_mesh) const {
    const BeamLog* const log = beams->of(begin_of(sub_mesh));
    return log == nullptr ? 0 : log->count();
  }
};

// Given the three sub-meshes of the filter's window and the one that has left it, then each has its own sweeps' beams.
TEST(MapBeams, AreKeptUntilTheSubMeshHasLeftTheWindow) {
  Beams kept;
  for (int sub_mesh = 0; sub_mesh < kSubMeshCount; ++sub_mesh)
    for (int i = 0; i <= sub_mesh; ++i) kept.sweep(sub_mesh, 3);
  for (int sub_mesh = 0; sub_mesh < kSubMeshCount; ++sub_mesh)
    EXPECT_EQ(kept.count(sub_mesh), 3U * static_cast<unsigned>(sub_mesh + 1));
  kept.sweep(kSubMeshCount, 3);
  EXPECT_EQ(kept.beams->of(begin_of(0)), nullptr);
  EXPECT_EQ(kept.count(kSubMeshCount), 3U);
}

TEST(MapBeams, AreThePrimaryLidarsAlone) {
  Beams kept;
  kept.sweep(0, 2);
  kept.sweep(1, 0);
  EXPECT_EQ(kept.count(0), 2U);
  EXPECT_EQ(kept.beams->of(begin_of(1)), nullptr);
}

TEST(MapBeams, AreInTheWorld) {
  Beams kept;
  kept.sweep(0, 3);
  BeamReader reader(*kept.beams->of(begin_of(0)));
  EXPECT_NEAR(reader.next()[0].to_m.x(), 101, 0.004);
}

}  // namespace
}  // namespace lxd::board_map_beams_test
