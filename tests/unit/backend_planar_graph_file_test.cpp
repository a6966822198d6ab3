// SPDX-License-Identifier: Apache-2.0
// The reader of published pose graphs that the graph's tests rest on.
#include <gtest/gtest.h>

#include "tests/support/planar_graph.hpp"
#include "tests/support/temporary_folder.hpp"

namespace lxd::backend_planar_graph_file_test {
namespace {

Result<test::PlanarGraph> read(const std::string& text) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "a.g2o", text);
  return test::load_planar_graph(folder / "a.g2o");
}

constexpr const char* kInformation = " 400 -3 7 100 5 2500\n";

TEST(PlanarGraphFile, TellsOdometryFromLoopsWhateverTheIdsAndTheOrder) {
  const std::string I = kInformation;
  const auto graph =
      read("# three poses, every fifth of a longer drive\nVERTEX_SE2 0 0 0 0\n\nVERTEX_SE2 5 1.5 0 0.25\n" +
           std::string("EDGE_SE2 10 0  -2.5 0.125 1e-3 ") + I + "EDGE_SE2 5 10 1.25 -0.5 -0.75" + I +
           "EDGE_SE2 0 5 1.5 0 0.25" + I);
  ASSERT_TRUE(graph.ok()) << graph.error().message;
  EXPECT_EQ(graph->ids, (std::vector<std::int64_t>{0, 5, 10}));
  ASSERT_EQ(graph->odometry.size(), 2u);
  EXPECT_EQ(graph->odometry[0].motion, Eigen::Vector3d(1.5, 0, 0.25));
  EXPECT_EQ(graph->odometry[1].motion, Eigen::Vector3d(1.25, -0.5, -0.75));
  ASSERT_EQ(graph->loops.size(), 1u);
  EXPECT_EQ(graph->loops[0].from, 10);
  EXPECT_EQ(graph->loops[0].to, 0);
  EXPECT_EQ(graph->loops[0].motion, Eigen::Vector3d(-2.5, 0.125, 1e-3));
  Eigen::Matrix3d information;
  information << 400, -3, 7, -3, 100, 5, 7, 5, 2500;
  EXPECT_EQ(graph->loops[0].information, information);
}

TEST(PlanarGraphFile, NeedsNoVertices) {
  const auto graph = read("EDGE_SE2 0 1 0.5 0 0" + std::string(kInformation));
  ASSERT_TRUE(graph.ok()) << graph.error().message;
  EXPECT_EQ(graph->ids.size(), 2u);
}

TEST(PlanarGraphFile, NamesLineAndCauseOfWhatItCannotRead) {
  const std::string good = "EDGE_SE2 0 1 0.5 0 0" + std::string(kInformation);
  const auto fails = [&](const std::string& second_line, const std::string& wanted) {
    const auto graph = read(good + second_line + "\n");
    ASSERT_FALSE(graph.ok()) << second_line;
    EXPECT_NE(graph.error().message.find("a.g2o:2: found '" + second_line.substr(0, 8)), std::string::npos)
        << graph.error().message;
    EXPECT_NE(graph.error().message.find(wanted), std::string::npos) << graph.error().message;
  };
  fails("VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1", "wanted VERTEX_SE2 or EDGE_SE2");
  fails("VERTEX_SE2 0 0 0", "wanted an id and 3 numbers");
  fails("VERTEX_SE2 0 0 0 0 0", "wanted an id and 3 numbers");
  fails("EDGE_SE2 1 2 0.5 0 0 400 0 0 100 0", "wanted two ids and 9 numbers");
  fails("EDGE_SE2 1 2 0.5 O 0 400 0 0 100 0 2500", "wanted two ids and 9 numbers");
  fails("EDGE_SE2 1 2 0.5 0 nan 400 0 0 100 0 2500", "wanted two ids and 9 numbers");
  fails("EDGE_SE2 1 2 0.5 0 0 400 0 0 0 0 2500", "wanted a positive definite information");
}

TEST(PlanarGraphFile, WantsOdometryBetweenAllNeighbours) {
  const auto gap = read("EDGE_SE2 0 1 0.5 0 0" + std::string(kInformation) + "VERTEX_SE2 2 1 0 0\n");
  ASSERT_FALSE(gap.ok());
  EXPECT_NE(gap.error().message.find("found no edge from 1 to 2"), std::string::npos) << gap.error().message;
  EXPECT_FALSE(read("EDGE_SE2 3 3 0.5 0 0" + std::string(kInformation)).ok());
  EXPECT_FALSE(test::load_planar_graph("/nowhere/a.g2o").ok());
}

}  // namespace
}  // namespace lxd::backend_planar_graph_file_test
