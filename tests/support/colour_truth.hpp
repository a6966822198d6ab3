// SPDX-License-Identifier: Apache-2.0
// The colours of a run's mesh against the light of the simulated world that its recording is of.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <vector>

#include "backend/colour/srgb.hpp"
#include "backend/ply_header.hpp"
#include "tests/support/run_result.hpp"
#include "tools/evaluate/align.hpp"
#include "tools/simulator/camera/shading.hpp"
#include "tools/simulator/world/scene.hpp"

namespace lxd::test {

struct ColouredVertex {
  Eigen::Vector3d p, normal;
  VertexColour colour;
};

// Of a mesh.ply; empty when it has no colours.
inline std::vector<ColouredVertex> coloured_vertices(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const auto header = read_ply_header(file, path);
  if (!header) return {};
  const PlyElement& vertex = header->elements.front();
  std::vector<const PlyProperty*> fields;
  for (const char* const name : {"x", "y", "z", "nx", "ny", "nz", "red", "green", "blue", "views"}) {
    fields.push_back(vertex.find(name));
    if (fields.back() == nullptr) return {};
  }
  std::vector<ColouredVertex> vertices(vertex.count);
  std::vector<char> record(vertex.record_bytes());
  for (ColouredVertex& v : vertices) {
    file.read(record.data(), static_cast<std::streamsize>(record.size()));
    const auto number = [&](std::size_t i) {
      return read_ply_number(record.data() + fields[i]->offset, fields[i]->type);
    };
    const auto level = [&](std::size_t i) { return static_cast<std::uint8_t>(number(i)); };
    v = {
        {number(0), number(1), number(2)}, {number(3), number(4), number(5)}, {level(6), level(7), level(8), level(9)}};
  }
  return vertices;
}

// T_world_map by the path, as the evaluation has it.
inline Pose place_in_world(const std::filesystem::path& truth, const RunResult& run) {
  const auto estimate = load_tum(run / "trajectory.tum"), true_path = load_tum(truth);
  const Association matched = associate(*estimate, *true_path, Duration::from_seconds(0.1));
  return align_path(matched.pairs, kMeshLever_m);
}

struct ColourErrors {
  std::size_t vertices = 0, coloured = 0, compared = 0;
  // In levels of 255, the worst of three channels, of the compared vertices; truth is as bright as the camera made it.
  double median = 0, p90 = 0;
};

// The true light at a vertex, averaged over what it stands for; false: it lies at an edge or on no surface.
inline bool true_light(const sim::Scene& scene, const Eigen::Vector3d& p, const Eigen::Vector3d& normal,
                       Eigen::Array3f& light) {
  constexpr float kBefore_m = 0.2F, kFootprint_m = 0.1F, kOff_m = 0.05F, kAlongside = 0.9F;
  sim::Ray ray{(p + double{kBefore_m} * normal).cast<float>(),
               -normal.cast<float>(),
               0,
               2 * kBefore_m,
               false,
               kFootprint_m / kBefore_m};
  const sim::Hit hit = scene.cast(ray);
  if (!hit.found() || hit.normal.dot(normal.cast<float>()) < kAlongside ||
      scene.world().materials[hit.material].glass || std::abs(hit.range_m - kBefore_m) > kOff_m)
    return false;
  light = sim::radiance(scene.world(), hit, ray.direction);
  return true;
}

inline ColourErrors colour_errors(const sim::Scene& scene, const std::filesystem::path& recording,
                                  const RunResult& run) {
  const Pose T_world_map = place_in_world(recording / "truth.tum", run);
  struct Compared {
    Eigen::Array3f told, truth;
  };
  std::vector<Compared> compared;
  ColourErrors errors;
  for (const ColouredVertex& v : coloured_vertices(run / "mesh.ply")) {
    ++errors.vertices;
    if (!v.colour.known()) continue;
    ++errors.coloured;
    Eigen::Array3f truth;
    if (true_light(scene, T_world_map * v.p, T_world_map.R * v.normal, truth))
      compared.push_back({light_of(&v.colour.red), truth});
  }
  errors.compared = compared.size();
  if (compared.empty()) return errors;
  const auto part = [](std::vector<double> values, double share) {
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::ranges::nth_element(values, at);
    return *at;
  };
  std::vector<double> ratios, levels;
  for (const Compared& c : compared) ratios.push_back(sim::luminance(c.told) / sim::luminance(c.truth));
  const auto brightness = static_cast<float>(part(ratios, 0.5));
  for (const Compared& c : compared) {
    double worst = 0;
    for (int i = 0; i < 3; ++i)
      worst = std::max(worst, std::abs<double>(level_of(c.told[i]) - level_of(brightness * c.truth[i])));
    levels.push_back(worst);
  }
  errors.median = part(levels, 0.5);
  errors.p90 = part(levels, 0.9);
  return errors;
}

}  // namespace lxd::test
