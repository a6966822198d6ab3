// SPDX-License-Identifier: Apache-2.0
// How far the path and the mesh may be from the truth: recordings whose truth is exact, and a car's drive.
#include "tests/support/run_result.hpp"

namespace lxd::test::odometry_accuracy_test {
namespace {

std::string against_truth(const RunResult& run, const std::filesystem::path& truth) {
  return fmt::format("--estimate {} --truth {}", (run / "odometry.tum").string(), truth.string());
}

// Given sweeps as if the LiDAR stood still during each, when replayed, then the path is within millimetres of the
// truth.
TEST(OdometryAccuracy, OfSweepsWithoutMotionInThemIsMillimetres) {
  const TemporaryFolder folder;
  const RunResult run = replayed(boxroom() / "frozen", folder, "");
  const auto errors = evaluated(against_truth(run, boxroom() / "frozen/truth.tum"));
  EXPECT_EQ(errors["matched"], 60);
  EXPECT_GT(errors["truth_path_m"], 5.0);  // or it would be no test
  EXPECT_LE(errors["ate_m"]["rmse"], 0.003);
}

// Given every point fired at its own time from a body that turns and accelerates, then deskewing leaves a centimetre.
TEST(OdometryAccuracy, OfAMovingLidarIsACentimetreAndItsMeshLiesOnTheTrueWalls) {
  const TemporaryFolder folder;
  const RunResult run = replayed(boxroom() / "moving", folder, "");
  const auto errors =
      evaluated(against_truth(run, boxroom() / "moving/truth.tum") +
                fmt::format(" --mesh {} --world {}", (run / "mesh.ply").string(), (boxroom() / "world.ply").string()));
  EXPECT_EQ(errors["matched"], 60);
  EXPECT_LE(errors["ate_m"]["rmse"], 0.010);

  const auto& mesh = errors["mesh"];
  EXPECT_GT(mesh["area_m2"], 1000.0);  // a third of the hall
  EXPECT_LE(mesh["accuracy_m"]["mean"], 0.010);
  EXPECT_LE(mesh["accuracy_m"]["p95"], 0.030);
  EXPECT_LE(mesh["completeness_m"]["median"], 0.030);
}

}  // namespace
}  // namespace lxd::test::odometry_accuracy_test
