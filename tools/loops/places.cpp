// SPDX-License-Identifier: Apache-2.0
#include "tools/loops/places.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "tools/evaluate/associate.hpp"
#include "tools/evaluate/tum_file.hpp"

namespace lxd {
namespace {

struct Span {
  std::int64_t id;
  RigTime first, last;
  Pose T_world_submesh;
};

Result<Association> true_path(const Archive& archive, const std::filesystem::path& truth_file) {
  auto poses = archive.poses();
  if (!poses) return poses.error();
  const auto truth = load_tum(truth_file);
  if (!truth) return truth.error();
  Trajectory estimate;
  estimate.poses = std::move(*poses);
  return associate(estimate, *truth, Duration::from_seconds(0.2));
}

// Key frames along the way, each in the sub-mesh that was being built then.
std::vector<Place> key_frames(const Association& path, const std::vector<Span>& spans, double spacing_m) {
  std::vector<Place> out;
  double path_m = 0, next_m = 0;
  for (std::size_t i = 0; i < path.pairs.size(); ++i) {
    const PosePair& pair = path.pairs[i];
    if (i > 0) path_m += (pair.estimate.p - path.pairs[i - 1].estimate.p).norm();
    const auto in = std::find_if(spans.begin(), spans.end(),
                                 [&](const Span& s) { return s.first <= pair.stamp && pair.stamp <= s.last; });
    if (path_m < next_m || in == spans.end()) continue;
    next_m = path_m + spacing_m;
    Place place;
    place.id = static_cast<std::int64_t>(out.size());
    place.submesh = in->id;
    place.T_world_body = pair.estimate;
    place.T_submesh_body = in->T_world_submesh.inverse() * pair.estimate;
    place.T_truth_body = pair.truth;
    place.path_m = path_m;
    out.push_back(place);
  }
  return out;
}

}  // namespace

Result<Places> load_places(const std::filesystem::path& run, const std::filesystem::path& truth,
                           const PlaceConfig& config) {
  const auto archive = Archive::open(run / "map.db");
  if (!archive) return archive.error();
  const auto path = true_path(*archive, truth);
  if (!path) return path.error();
  Places out;
  std::vector<Span> spans;
  const Status read = archive->for_each_submesh([&](const SubmeshView& view) {
    spans.push_back({view.id, view.first, view.last, view.T_map_submesh});
    out.submeshes.push_back({view.id, view.T_map_submesh, thin_surfels(view.vertices, config.thinning)});
    return success();
  });
  if (!read) return read.error();
  out.places = key_frames(*path, spans, config.spacing_m);
  return out;
}

std::vector<Surfel> view_from(const TravelledSubmesh& submesh, const Place& place, double front_deg) {
  if (front_deg >= 360) return submesh.surfels;
  const double half_rad = front_deg / 360 * std::numbers::pi;
  const Pose T_body_submesh = place.T_submesh_body.inverse();
  std::vector<Surfel> out;
  std::copy_if(submesh.surfels.begin(), submesh.surfels.end(), std::back_inserter(out), [&](const Surfel& s) {
    const Eigen::Vector3d p = T_body_submesh * s.position_m.cast<double>();
    return std::abs(std::atan2(p.y(), p.x())) <= half_rad;
  });
  return out;
}

}  // namespace lxd
