// SPDX-License-Identifier: Apache-2.0
// The key frames of a finished run with what its archive shows about them, and where they truly were.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "backend/archive.hpp"
#include "backend/loops/surfels.hpp"
#include "rt/pose.hpp"
#include "rt/result.hpp"

namespace lxd {

struct Place {
  std::int64_t id = 0;  // in order of time
  std::int64_t submesh = 0;
  Pose T_submesh_body;
  Pose T_world_body;  // as the run estimated it
  Pose T_truth_body;
  double path_m = 0;  // driven until here
};

struct TravelledSubmesh {
  std::int64_t id = 0;
  Pose T_world_submesh;
  std::vector<Surfel> surfels;
};

struct Places {
  std::vector<Place> places;
  std::vector<TravelledSubmesh> submeshes;  // by id
};

struct PlaceConfig {
  double spacing_m = 2.0;    // of key frames along the way
  double front_deg = 360.0;  // width of what is kept about the heading, of each key frame's own view
  ThinningConfig thinning;
};

// RUN/map.db and a TUM file of the truth; of times that the truth does not have there are no places.
Result<Places> load_places(const std::filesystem::path& run, const std::filesystem::path& truth,
                           const PlaceConfig& config);

// What of a sub-mesh is within the angle about the place's heading; everything for 360 degrees.
std::vector<Surfel> view_from(const TravelledSubmesh& submesh, const Place& place, double front_deg);

}  // namespace lxd
