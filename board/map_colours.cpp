// SPDX-License-Identifier: Apache-2.0
#include "board/map_colours.hpp"

#include <algorithm>

#include "board/default/capacities.hpp"
#include "board/default/threads.hpp"
#include "board/image_follower.hpp"
#include "mapping/lattice.hpp"
#include "rt/stopwatch.hpp"

namespace lxd {
namespace {

SightLimits limits_of(const Settings& settings) {
  return {static_cast<float>(settings.colour.range_max_m),
          static_cast<float>(settings.mapping.cell_size_m / kQuadsPerEdge)};
}

}  // namespace

MapColours::MapColours(const MountedCamera& camera, const Settings& settings, BackEndPace pace)
    : camera_(camera),
      intake_(camera.T_body_camera.p, capacities::kKeyImageBytes),
      colourist_(camera_.view(), limits_of(settings)),
      beside_(settings.threads > 1),
      hurries_(beside_ && pace == BackEndPace::live) {}

std::unique_ptr<MapColours> MapColours::create(const Configuration& configuration, const Star& star, BackEndPace pace) {
  const auto camera = camera_of(configuration.rig, star);
  if (!camera || !configuration.settings.colour.from_camera) return nullptr;
  return std::make_unique<MapColours>(*camera, configuration.settings, pace);
}

void MapColours::begin(const SubmeshView& submesh) {
  id_ = submesh.id;
  SubmeshView lent;
  lent.T_map_submesh = submesh.T_map_submesh;
  lent.vertices = submesh.vertices;
  lent.faces = submesh.faces;
  const bool own_thread = beside_, new_piece = std::exchange(new_piece_, false);
  auto work = [this, lent, own_thread, new_piece, images = intake_.images().take_until(submesh.last)]() mutable {
    if (own_thread) place_this_thread(threads::kBackEnd);
    const Stopwatch stopwatch;
    if (new_piece) colourist_.begin_again();
    auto colours = colourist_.colour(lent, std::move(images), hurry_);
    work_s_ += stopwatch.elapsed().seconds();
    return colours;
  };
  under_way_ = std::async(beside_ ? std::launch::async : std::launch::deferred, std::move(work));
}

Status MapColours::collect(ArchiveWriter& archive, Waiting waiting) {
  if (!under_way_.valid()) return success();
  hurry_ = hurries_ && waiting == Waiting::next_submesh;
  const std::vector<VertexColour> colours = under_way_.get();
  hurry_ = false;
  if (std::ranges::none_of(colours, &VertexColour::known)) return success();
  return archive.set_colours(id_, colours);
}

void MapColours::begin_again() {
  intake_.begin_again();
  new_piece_ = true;
}

void MapColours::write(Report& report) {
  const ColourCounts& counts = colourist_.counts();
  report.colour = {counts.images, intake_.images().dropped() + counts.hurried, counts.vertices, counts.coloured,
                   work_s_};
}

}  // namespace lxd
