// SPDX-License-Identifier: Apache-2.0
// What an export takes does not depend on how long the way was.
#include "tests/support/run_result.hpp"
#include "tests/support/synthetic_mesh.hpp"

namespace lxd::test::exported_mesh_test {
namespace {

#ifndef LXD_SANITIZED  // a sanitizer's shadow memory is not the product's

// A street of sub-meshes of 20 m, each of which lies over half of the one before.
double peak_of_export_mib(const TemporaryFolder& folder, int submeshes) {
  SyntheticMesh stretch;
  stretch.add_patch({0, 0, 0}, {20, 0, 0}, {0, 12, 0}, 0.1F);
  const std::filesystem::path run = folder / std::to_string(submeshes);
  std::filesystem::create_directory(run);
  write_file(run / "odometry.tum", "");  // by which, and the archive, a run's folder is known
  auto writer = ArchiveWriter::create(run / "map.db");
  for (int i = 0; i < submeshes; ++i)
    EXPECT_TRUE(writer->append(stretch.view(i, {Eigen::Matrix3d::Identity(), {10.0 * i, 0, 0.01 * (i % 2)}})).ok());
  EXPECT_TRUE(writer->finish().ok());
  const Ended ended = lxd_slam(fmt::format("export {} --mesh {}", run.string(), (run / "mesh.ply").string()));
  EXPECT_EQ(ended.status, 0) << ended.text;
  return ended.peak_rss_mib;
}

TEST(ExportedMesh, OfALongWayTakesNoMoreMemoryThanOfAShortOne) {
  const TemporaryFolder folder;
  constexpr double kNoise_mib = 3;
  EXPECT_LT(peak_of_export_mib(folder, 40), peak_of_export_mib(folder, 5) + kNoise_mib);
}

#endif

}  // namespace
}  // namespace lxd::test::exported_mesh_test
