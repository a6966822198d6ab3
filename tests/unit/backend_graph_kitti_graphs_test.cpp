// SPDX-License-Identifier: Apache-2.0
// Pose graphs of KITTI 00 and 05 as published: stereo odometry (libviso2) and loops that were seen, not simulated
// (Y. Latif, "Dataset for Robust SLAM backend Evaluation"; made of KITTI's images, whose licence keeps the files out of
// this project). What is solved on the way ends where a batch solution does.
#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include <gtest/gtest.h>

#include "tests/support/data_folders.hpp"
#include "tests/support/graph_and_batch.hpp"
#include "tests/support/planar_graph.hpp"

namespace lxd::backend_graph_kitti_graphs_test {
namespace {

constexpr double kFramesPerSecond = 10, kSubMesh_m = 40;
// What a plane does not say of heights and tilts: they are zero, and known about as well as the rest.
constexpr double kFlat_m = 0.05, kFlat_rad = 2e-3;

// The measurement with the noise that its file states: a frame of odometry and a loop err alike there, in KITTI 00 by
// 0.04 m, 0.05 m and 1.8 mrad; several frames in one step by as much more. A translation errs in the axes of `to`
// there, in those of `from` here.
RelativeMotion in_space(const test::PlanarEdge& edge) {
  RelativeMotion motion;
  motion.T = {Eigen::AngleAxisd(edge.motion.z(), Eigen::Vector3d::UnitZ()).toRotationMatrix(),
              {edge.motion.x(), edge.motion.y(), 0}};
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() = motion.T.R.topLeftCorner<2, 2>();
  const Eigen::Matrix3d planar = turn * edge.information.inverse() * turn.transpose();
  constexpr int kYaw = 2, kX = 3;  // of [rotation, position]
  motion.covariance.diagonal() << Eigen::Vector3d::Constant(kFlat_rad * kFlat_rad),
      Eigen::Vector3d::Constant(kFlat_m * kFlat_m);
  motion.covariance.block<2, 2>(kX, kX) = planar.topLeftCorner<2, 2>();
  motion.covariance.block<2, 1>(kX, kYaw) = planar.topRightCorner<2, 1>();
  motion.covariance.block<1, 2>(kYaw, kX) = planar.bottomLeftCorner<1, 2>();
  motion.covariance(kYaw, kYaw) = planar(2, 2);
  return motion;
}

std::vector<KeyFrame> key_frames_of(const test::PlanarGraph& published) {
  std::vector<KeyFrame> key_frames(published.ids.size());
  double way_m = 0;
  for (std::size_t i = 0; i < key_frames.size(); ++i) {
    KeyFrame& frame = key_frames[i];
    frame.id = static_cast<std::int64_t>(i);
    frame.stamp = RigTime::from_seconds(static_cast<double>(published.ids[i]) / kFramesPerSecond);
    if (i > 0) {
      const RelativeMotion step = in_space(published.odometry[i - 1]);
      frame.T_world_body = key_frames[i - 1].T_world_body * step.T;
      frame.motion_covariance = step.covariance;
      frame.travelled_m = step.T.p.norm();
      frame.turned_rad = std::abs(published.odometry[i - 1].motion.z());
    }
    way_m += frame.travelled_m;
    frame.sub_mesh = static_cast<std::int64_t>(way_m / kSubMesh_m);
  }
  return key_frames;
}

std::vector<LoopMeasurement> loops_of(const test::PlanarGraph& published) {
  const auto key_frame = [&](std::int64_t id) {
    return std::ranges::lower_bound(published.ids, id) - published.ids.begin();
  };
  std::vector<LoopMeasurement> loops;
  for (const test::PlanarEdge& edge : published.loops) {
    const RelativeMotion motion = in_space(edge);
    loops.push_back({key_frame(edge.from), key_frame(edge.to), motion.T, motion.covariance, LoopSense::sight});
  }
  return loops;
}

// How far apart the loops' ends are from where they were measured: root mean square of positions.
double loops_off_by_m(const PoseGraph& graph, std::span<const LoopMeasurement> loops) {
  double sum_m2 = 0;
  for (const LoopMeasurement& loop : loops) {
    const Pose T =
        graph.T_map_body(static_cast<int>(loop.from)).inverse() * graph.T_map_body(static_cast<int>(loop.to));
    sum_m2 += (T.p - loop.T_from_to.p).squaredNorm();
  }
  return std::sqrt(sum_m2 / static_cast<double>(loops.size()));
}

std::optional<std::filesystem::path> published_graph(const std::string& name) {
  const auto folder = test::shared_data("graphs");
  if (!folder) return std::nullopt;
  std::vector<std::filesystem::path> found;
  for (const auto& entry : std::filesystem::directory_iterator(*folder))
    if (entry.path().filename().string().starts_with(name) && entry.path().extension() == ".g2o")
      found.push_back(entry.path());
  if (found.empty()) return std::nullopt;
  return *std::ranges::min_element(found);
}

class PublishedGraph : public ::testing::TestWithParam<const char*> {};

TEST_P(PublishedGraph, SolvedOnTheWayItCostsWhatABatchCosts) {
  const auto file = published_graph(GetParam());
  if (!file) GTEST_SKIP() << "no LXD_SHARED_DATA with graphs/" << GetParam() << "*.g2o";
  const auto published = test::load_planar_graph(*file);
  ASSERT_TRUE(published.ok()) << published.error().message;
  ASSERT_GE(published->loops.size(), 3u);

  const test::GraphAndBatch both(key_frames_of(*published), loops_of(*published));
  test::expect_costs_of_batch(both);

  const auto loops = both.graph.loops();
  ASSERT_FALSE(loops.empty());
  const double before_m = loops_off_by_m(both.odometry, loops), after_m = loops_off_by_m(both.graph, loops);
  RecordProperty("loops_off_by_m_before", std::to_string(before_m));
  RecordProperty("loops_off_by_m", std::to_string(after_m));
  EXPECT_LT(after_m, 0.1 * before_m);
}

INSTANTIATE_TEST_SUITE_P(Kitti, PublishedGraph, ::testing::Values("kitti_00", "kitti_05"));

}  // namespace
}  // namespace lxd::backend_graph_kitti_graphs_test
