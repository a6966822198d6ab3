// SPDX-License-Identifier: Apache-2.0
// Pose graphs that others have published: g2o's text files of motions in a plane. A line is
//   VERTEX_SE2 id x y yaw                            m and rad; where an optimiser may begin
//   EDGE_SE2 from to x y yaw Ixx Ixy Ixw Iyy Iyw Iww  T_from_to and its information (w: yaw), errors in the axes of
//   `to`
// (R. Kuemmerle's wiki of g2o, "File Format SLAM 2D").
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <Eigen/Cholesky>
#include <fmt/format.h>

#include "rt/result.hpp"

namespace lxd::test {

struct PlanarEdge {
  std::int64_t from = 0, to = 0;
  Eigen::Vector3d motion = Eigen::Vector3d::Zero();           // x, y (m), yaw (rad): T_from_to
  Eigen::Matrix3d information = Eigen::Matrix3d::Identity();  // of these, in the axes of `to`
};

struct PlanarGraph {
  std::vector<std::int64_t> ids;     // of the poses, rising; any number may lie between two
  std::vector<PlanarEdge> odometry;  // from each pose to the next one
  std::vector<PlanarEdge> loops;     // all others, as the file has them
};

namespace planar_graph_detail {

// "": the line was taken.
inline std::string take_line(const std::string& line, std::set<std::int64_t>& ids, std::vector<PlanarEdge>& edges) {
  std::istringstream words(line);
  std::string tag, more;
  if (!(words >> tag) || tag.front() == '#') return "";
  const bool vertex = tag == "VERTEX_SE2";
  if (!vertex && tag != "EDGE_SE2") return fmt::format("found '{}', wanted VERTEX_SE2 or EDGE_SE2", tag);
  std::int64_t id = 0, to = 0;
  std::array<double, 9> numbers{};
  const std::size_t wanted = vertex ? 3 : numbers.size();
  words >> id;
  if (!vertex) words >> to;
  std::size_t found = 0;
  while (found < wanted && words >> numbers[found]) ++found;
  if (found < wanted || words >> more)
    return fmt::format("found '{}', wanted {} and {} numbers", line, vertex ? "an id" : "two ids", wanted);
  ids.insert(id);
  if (vertex) return "";
  ids.insert(to);
  PlanarEdge edge{id, to, {numbers[0], numbers[1], numbers[2]}, {}};
  edge.information << numbers[3], numbers[4], numbers[5],  //
      numbers[4], numbers[6], numbers[7],                  //
      numbers[5], numbers[7], numbers[8];
  if (id == to) return fmt::format("found an edge from {} to itself, wanted two poses", id);
  if (edge.information.llt().info() != Eigen::Success)
    return fmt::format("found '{}', wanted a positive definite information", line);
  edges.push_back(edge);
  return "";
}

// The first edge from each pose to the next one is odometry.
inline std::string sort_out(const std::vector<PlanarEdge>& edges, PlanarGraph& graph) {
  graph.odometry.resize(graph.ids.empty() ? 0 : graph.ids.size() - 1);
  std::vector<bool> known(graph.odometry.size(), false);
  for (const PlanarEdge& edge : edges) {
    const auto from = std::lower_bound(graph.ids.begin(), graph.ids.end(), edge.from);
    const auto step = static_cast<std::size_t>(from - graph.ids.begin());
    if (step < known.size() && graph.ids[step + 1] == edge.to && !known[step]) {
      known[step] = true;
      graph.odometry[step] = edge;
    } else {
      graph.loops.push_back(edge);
    }
  }
  for (std::size_t i = 0; i < known.size(); ++i)
    if (!known[i]) return fmt::format("found no edge from {} to {}, wanted odometry", graph.ids[i], graph.ids[i + 1]);
  return "";
}

}  // namespace planar_graph_detail

// Empty lines and lines that begin with '#' are passed over. Where vertices lie is not used: odometry says it.
// Error: file:line, found and wanted; two poses in a row without an edge.
inline Result<PlanarGraph> load_planar_graph(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream) return Error{fmt::format("{}: cannot be read", file.string())};
  std::set<std::int64_t> ids;
  std::vector<PlanarEdge> edges;
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number)
    if (const std::string wrong = planar_graph_detail::take_line(line, ids, edges); !wrong.empty())
      return Error{fmt::format("{}:{}: {}", file.string(), number, wrong)};
  PlanarGraph graph{{ids.begin(), ids.end()}, {}, {}};
  if (const std::string wrong = planar_graph_detail::sort_out(edges, graph); !wrong.empty())
    return Error{fmt::format("{}: {}", file.string(), wrong)};
  return graph;
}

}  // namespace lxd::test
