// SPDX-License-Identifier: Apache-2.0
// The map of a simulated rig with a camera has the colours of its world; without the camera it is what it was.
#include "backend/archive.hpp"
#include "tests/support/cloud_columns.hpp"
#include "tests/support/colour_truth.hpp"
#include "tools/simulator/world/world_makers.hpp"

namespace lxd::test::coloured_map_test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRig = R"yaml(
world: building
motion: {carrier: handheld, rest_s: 0.5, vigour: 0.3}
duration_s: 6
lidar0: {model: ouster, product: OS0, beams: 32, columns: 512}
imu: {protocol: vectornav, update_rate: 100}
camera0:
  resolution: [240, 180]
  intrinsics: [150, 150, 119.5, 89.5]
  distortion_coeffs: [-0.05, 0.02, 0.0005, -0.0003]
  colour: true
  rate_hz: 10
  T_body_sensor: [[0, 0, 1, 0.05], [-1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 0, 1]]
)yaml";
constexpr std::uint64_t kSeed = 1;

class ColouredMap : public testing::Test {
 protected:
  fs::path simulated(const std::string& options = "") {
    write_file(folder_ / "scenario.yaml", kRig);
    const Ended ended = lxd_slam(fmt::format("simulate {} --seed {} {} --out {}", (folder_ / "scenario.yaml").string(),
                                             kSeed, options, (folder_ / "recording").string()));
    EXPECT_EQ(ended.status, 0) << ended.text;
    return folder_ / "recording";
  }
  ColourErrors errors(const fs::path& recording, const RunResult& run) { return colour_errors(scene_, recording, run); }

  TemporaryFolder folder_;
  sim::World world_ = *sim::make_world("building", kSeed);
  sim::Scene scene_{world_};
};

// Levels of 255. In every file that has surfaces or points, and the same whatever the threads.
TEST_F(ColouredMap, HasTheColoursOfItsWorld) {
  const fs::path recording = simulated();
  const RunResult run = replayed(recording, folder_, "");
  const ColourErrors found = errors(recording, run);
  EXPECT_GT(found.compared, 4'000U);
  EXPECT_LT(found.median, 4);
  EXPECT_LT(found.p90, 12);
  const auto colour = run.report()["colour"];
  EXPECT_EQ(colour["vertices"], found.vertices);
  EXPECT_EQ(colour["vertices_coloured"], found.coloured);
  EXPECT_GT(colour["key_images"], 3);

  EXPECT_NE(run.bytes("cloud.ply").find("property uchar red"), std::string::npos);
  const Ended ended = lxd_slam(fmt::format("export {} --mesh {} --cloud {}", (folder_ / "run").string(),
                                           (folder_ / "mesh.glb").string(), (folder_ / "cloud.las").string()));
  EXPECT_EQ(ended.status, 0) << ended.text;
  EXPECT_NE(read_file(folder_ / "mesh.glb").find("COLOR_0"), std::string::npos);
  CloudColumns cloud = ply_columns(run / "cloud.ply"), las = las_columns(folder_ / "cloud.las");
  ASSERT_GT(cloud["views"].size(), 10'000U);
  std::size_t seen = 0, on_surfaces = 0;
  for (std::size_t i = 0; i < cloud["views"].size(); ++i) {
    ASSERT_EQ(las["user_data"].at(i), cloud["views"][i]);
    ASSERT_EQ(las["blue"].at(i), 257 * cloud["blue"][i]);
    ASSERT_EQ(las["NormalZ"].at(i), cloud["nz"][i]);
    const bool on_surface = !std::isnan(cloud["variance"][i]);
    on_surfaces += on_surface ? 1 : 0;
    seen += cloud["views"][i] > 0 ? 1 : 0;
    ASSERT_TRUE(on_surface || cloud["views"][i] == 0) << "a colour is a surface's";
  }
  EXPECT_GT(seen, cloud["views"].size() / 20);
  EXPECT_GT(on_surfaces, seen);

  const RunResult one = replayed(recording, folder_, "--set threads=1", "one");
  for (const char* const name : {"map.db", "mesh.ply", "cloud.ply", "trajectory.tum"})
    EXPECT_TRUE(one.bytes(name) == run.bytes(name)) << name;
}

// The exposure is half again as long from one image to the next, for good: the surfaces keep their colours.
TEST_F(ColouredMap, HasNoSeamWhereTheExposureJumps) {
  const fs::path recording = simulated("--fault camera_exposure_jump@3+3=1.6");
  const ColourErrors found = errors(recording, replayed(recording, folder_, ""));
  EXPECT_LT(found.median, 5);
  EXPECT_LT(found.p90, 14);
}

// Given a run at the recording's pace, whose last sub-meshes come all at once when no sweep does any more, then they
// have their colours, too.
TEST_F(ColouredMap, IsWholeAtTheEndOfARunAtTheRecordingsPace) {
  const RunResult run = replayed(simulated(), folder_, "--realtime --set mapping.submesh_path_m=2");
  const auto archive = Archive::open(run / "map.db");
  ASSERT_TRUE(archive.ok());
  ASSERT_GT(archive->totals().submeshes, 1U);
  EXPECT_EQ(run.report()["colour"]["key_images_dropped"], 0);
}

// The path is the same with colours and without; and nothing of a map without a camera says that there are colours.
TEST_F(ColouredMap, IsPlainWithoutACamera) {
  const fs::path recording = simulated();
  const RunResult coloured = replayed(recording, folder_, "", "coloured");
  for (const char* const options : {"--set colour.from_camera=false", "--sensors LI"}) {
    const RunResult run = replayed(recording, folder_, options, "plain");
    EXPECT_EQ(run.bytes("map.db")[63], 2) << "the version that had no colours";
    EXPECT_EQ(run.bytes("mesh.ply").find("uchar red"), std::string::npos);
    EXPECT_EQ(run.bytes("cloud.ply").find("uchar red"), std::string::npos);
    EXPECT_FALSE(run.report().contains("colour"));
  }
  const RunResult plain = replayed(recording, folder_, "--set colour.from_camera=false", "plain");
  EXPECT_TRUE(plain.bytes("odometry.tum") == coloured.bytes("odometry.tum"));
}

}  // namespace
}  // namespace lxd::test::coloured_map_test
