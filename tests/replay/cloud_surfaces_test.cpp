// SPDX-License-Identifier: Apache-2.0
// The cloud of a run has the normals and variances of its surfaces, against the simulated world that they are of; in
// every format, and where GNSS moves it.
#include "rt/so3.hpp"
#include "tests/support/cloud_columns.hpp"
#include "tests/support/colour_truth.hpp"
#include "tools/simulator/world/world_makers.hpp"

namespace lxd::test::cloud_surfaces_test {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kSeed = 1;
constexpr const char* kHandheld = R"yaml(
world: building
motion: {carrier: handheld, rest_s: 0.5, vigour: 0.3}
duration_s: 5
lidar0: {model: ouster, product: OS0, beams: 32, columns: 512}
imu: {protocol: vectornav, update_rate: 100}
)yaml";

// RTK whose axes are not the world's.
constexpr const char* kCar = R"yaml(
world: street
motion: {carrier: car, start: moving}
duration_s: 8
lidar0: {model: ouster, product: OS1, beams: 32, columns: 1024, T_body_sensor: [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0.8], [0, 0, 0, 1]]}
imu: {protocol: vectornav, update_rate: 200}
gnss: {rate_hz: 10, antenna_in_reference_m: [-0.3, 0, 1.0], enu_yaw_rad: 0.6, blocked_no_rtk: 0.9, blocked_no_fix: 0.95}
)yaml";

using Axes = std::array<const char*, 3>;
constexpr Axes kPlace{"x", "y", "z"}, kPlyNormal{"nx", "ny", "nz"};

Eigen::Vector3d vector_of(CloudColumns& columns, const Axes& axes, std::size_t i) {
  return {columns[axes[0]][i], columns[axes[1]][i], columns[axes[2]][i]};
}

// Of the path at each point's time.
class PathAt {
 public:
  explicit PathAt(std::vector<StampedPose> path) : path_(std::move(path)) {}
  const Pose& operator()(double time_s) const { return path_[nearest_pose(path_, time_s)].T; }

 private:
  std::vector<StampedPose> path_;
};

class CloudSurfaces : public testing::Test {
 protected:
  fs::path simulated(const char* scenario) {
    write_file(folder_ / "scenario.yaml", scenario);
    const Ended ended = lxd_slam(fmt::format("simulate {} --seed {} --out {}", (folder_ / "scenario.yaml").string(),
                                             kSeed, (folder_ / "recording").string()));
    EXPECT_EQ(ended.status, 0) << ended.text;
    return folder_ / "recording";
  }
  fs::path exported(const std::string& name) {
    const Ended ended =
        lxd_slam(fmt::format("export {} --cloud {}", (folder_ / "run").string(), (folder_ / name).string()));
    EXPECT_EQ(ended.status, 0) << ended.text;
    return folder_ / name;
  }

  TemporaryFolder folder_;
};

double share(std::size_t part, std::size_t whole) { return static_cast<double>(part) / static_cast<double>(whole); }

// Each point's normal against that of what a ray from the sensor to the point meets in the true world: within degrees,
// and towards the sensor.
TEST_F(CloudSurfaces, AreThoseOfTheWorldOnTheSideThatWasSeen) {
  const fs::path recording = simulated(kHandheld);
  const RunResult run = replayed(recording, folder_, "");
  const sim::World world = *sim::make_world("building", kSeed);
  const sim::Scene scene(world);
  const Pose T_world_map = place_in_world(recording / "truth.tum", run);
  const PathAt pose_at(run.path("trajectory.tum"));

  CloudColumns cloud = ply_columns(run / "cloud.ply");
  const std::size_t points = cloud["x"].size();
  std::size_t known = 0, met = 0, within = 0, opposite = 0;
  for (std::size_t i = 0; i < points; ++i) {
    const Eigen::Vector3d normal = vector_of(cloud, kPlyNormal, i);
    if (normal.isZero()) {
      EXPECT_TRUE(std::isnan(cloud["variance"][i]));
      continue;
    }
    ++known;
    EXPECT_NEAR(normal.norm(), 1, 1e-4);
    EXPECT_GT(cloud["variance"][i], 0);
    constexpr double kVarianceMax_m2 = 0.01;  // a decimetre's
    EXPECT_LT(cloud["variance"][i], kVarianceMax_m2);
    const Eigen::Vector3d eye = T_world_map * pose_at(cloud["time"][i]).p;
    const Eigen::Vector3d place = T_world_map * vector_of(cloud, kPlace, i);
    const sim::Hit hit = scene.cast({eye.cast<float>(), (place - eye).normalized().cast<float>(), 0});
    constexpr double kNear_m = 0.1;
    if (!hit.found() || std::abs(hit.range_m - (place - eye).norm()) > kNear_m) continue;
    ++met;
    const double cosine = (T_world_map.R * normal).dot(hit.normal.cast<double>());
    constexpr double kCosine = 0.985;  // 10 degrees
    within += cosine > kCosine ? 1 : 0;
    opposite += cosine < -0.5 ? 1 : 0;
  }
  EXPECT_GT(points, 20'000U);
  EXPECT_GT(share(known, points), 0.9);
  EXPECT_GT(share(met, known), 0.9);
  EXPECT_GT(share(within, met), 0.8) << "the rest is furniture and edges";
  EXPECT_LT(share(opposite, met), 0.005);
}

TEST_F(CloudSurfaces, AreTheSameInEveryFormat) {
  const RunResult run = replayed(boxroom() / "moving", folder_, "--sensors L --set replay.sweeps=30");
  CloudColumns cloud = ply_columns(run / "cloud.ply");
  CloudColumns ply = ply_columns(exported("out.ply"));
  CloudColumns pcd = pcd_columns(exported("out.pcd"));
  CloudColumns las = las_columns(exported("out.las"));
  const std::size_t points = cloud["x"].size();
  ASSERT_GT(points, 10'000U);
  ASSERT_EQ(pcd["variance"].size(), points);
  ASSERT_EQ(las["variance"].size(), points);
  EXPECT_EQ(read_file(folder_ / "out.ply"), run.bytes("cloud.ply"));
  std::size_t known = 0;
  for (std::size_t i = 0; i < points; ++i) {
    const Eigen::Vector3d normal = vector_of(cloud, kPlyNormal, i);
    ASSERT_EQ(vector_of(pcd, {"normal_x", "normal_y", "normal_z"}, i), normal);
    ASSERT_EQ(vector_of(las, {"NormalX", "NormalY", "NormalZ"}, i), normal);
    if (normal.isZero()) continue;
    ++known;
    ASSERT_EQ(pcd["variance"][i], cloud["variance"][i]);
    ASSERT_EQ(las["variance"][i], cloud["variance"][i]);
  }
  EXPECT_GT(share(known, points), 0.9);
}

// Each point's normal is turned as its pose is.
TEST_F(CloudSurfaces, TurnWithThePath) {
  const fs::path recording = simulated(kCar);
  const RunResult without = replayed(recording, folder_, "--sensors LI", "without");
  const RunResult with = replayed(recording, folder_, "--sensors LIG", "with");
  const PathAt before(with.path("odometry.tum")), after(with.path("trajectory.tum"));
  CloudColumns still = ply_columns(without / "cloud.ply"), moved = ply_columns(with / "cloud.ply");
  const std::size_t points = still["x"].size();
  ASSERT_EQ(moved["x"].size(), points);
  double turned_rad = 0;
  for (std::size_t i = 0; i < points; ++i) {
    const Pose T = after(still["time"][i]) * before(still["time"][i]).inverse();
    ASSERT_LT((vector_of(moved, kPlyNormal, i) - T.R * vector_of(still, kPlyNormal, i)).norm(), 1e-4) << i;
    const double variance = still["variance"][i];
    ASSERT_TRUE(std::isnan(variance) ? std::isnan(moved["variance"][i]) : moved["variance"][i] == variance) << i;
    turned_rad = std::max(turned_rad, Log(T.R).norm());
  }
  EXPECT_GT(turned_rad, 0.003) << "far more than the bound above";
}

}  // namespace
}  // namespace lxd::test::cloud_surfaces_test
