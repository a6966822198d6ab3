// SPDX-License-Identifier: Apache-2.0
#include "backend/colour/colourist.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "backend/colour/fused_colour.hpp"
#include "backend/colour/image_pyramid.hpp"
#include "backend/colour/srgb.hpp"

namespace lxd {
namespace {

constexpr std::size_t kEarlierImages = 4;
// Turning faster halves an image's worth: it is smeared, and its place less well known.
constexpr double kCalmTurn_radps = 0.5;
constexpr float kFullWeight = 255;
// What lies behind the farthest vertices is drawn, too: before it they are no rims.
constexpr float kBehindRange = 1.25F;
constexpr float kRounding = 1e-5F;
constexpr float kTileSpacings = 32;  // a tile's edge: small against what an image shows, large against a vertex

float calm_of(const KeyImage& image) {
  const double turns = image.turn_radps / kCalmTurn_radps;
  return static_cast<float>(1 / (1 + turns * turns));
}

// From the middle to the farthest corner, 0 .. 255.
std::uint8_t radius_of(const Eigen::Vector2f& pixel, const PinholeView& view) {
  const Eigen::Vector2f corner(std::max(view.centre_px.x(), static_cast<float>(view.width) - view.centre_px.x()),
                               std::max(view.centre_px.y(), static_cast<float>(view.height) - view.centre_px.y()));
  return static_cast<std::uint8_t>(std::min(1.0F, (pixel - view.centre_px).norm() / corner.norm()) * 255);
}

// Images beyond those that samples can number: evenly thinned.
void thin(std::vector<KeyImage>& images, std::size_t wanted) {
  if (images.size() <= wanted) return;
  for (std::size_t i = 0; i < wanted; ++i) std::swap(images[i], images[i * images.size() / wanted]);
  images.resize(wanted);
}

// 0 .. count - 1: every eighth first, then those in the middle between them, and so on.
std::vector<std::size_t> spread(std::size_t count) {
  std::vector<std::size_t> order;
  for (const std::size_t first : {0, 4, 2, 6, 1, 5, 3, 7})
    for (std::size_t i = first; i < count; i += 8) order.push_back(i);
  return order;
}

}  // namespace

void Colourist::look(const MeshTiles& mesh, const Pose& T_camera_mesh, const KeyImage& image, std::size_t number,
                     Looks& looks) {
  ColourSamples& samples = looks.samples;
  std::vector<VertexSight>& sightings = looks.sightings;
  std::vector<MeshTile> before;
  std::ranges::copy_if(mesh.tiles(), std::back_inserter(before), [&](const MeshTile& tile) {
    return may_show(tile, T_camera_mesh, view_, kBehindRange * limits_.range_max_m);
  });
  for (const MeshTile& tile : before)
    sight(tile.vertices.of(mesh.vertices()), T_camera_mesh, view_, tile.vertices.of(std::span(sightings)));
  DepthImage depth(view_);
  for (const MeshTile& tile : before) depth.draw(sightings, tile.faces.of(mesh.faces()));

  const ImagePyramid pyramid(view_, image.rgb);
  const Eigen::Matrix3f R = T_camera_mesh.R.cast<float>();
  const float calm = calm_of(image);
  const auto take = [&](std::uint32_t i) {
    const float weight_min = static_cast<float>(samples.weight_min(i)) / (kFullWeight * calm) * (1 - kRounding);
    const float weight = sight_weight(mesh.vertices()[i], sightings[i], R, view_, depth, limits_, weight_min);
    if (weight <= 0) return;
    const auto light = pyramid.light(sightings[i].pixel, width_px(sightings[i], view_, limits_));
    if (!light) return;
    const auto whole = static_cast<std::uint8_t>(std::max(1.0F, kFullWeight * weight * calm));
    samples.add(i, {{level_of((*light)[0]), level_of((*light)[1]), level_of((*light)[2])},
                    whole,
                    static_cast<std::uint8_t>(number),
                    radius_of(sightings[i].pixel, view_)});
  };
  for (const MeshTile& tile : before)
    for (std::uint32_t i = tile.vertices.first; i < tile.vertices.first + tile.vertices.count; ++i) take(i);
  for (const MeshTile& tile : before) std::ranges::fill(tile.vertices.of(std::span(sightings)), VertexSight{});
}

std::vector<VertexColour> Colourist::colour(const SubmeshView& submesh, std::vector<KeyImage> images,
                                            const std::atomic<bool>& hurry) {
  thin(images, kImagesPerSubMesh - kEarlierImages);
  const MeshTiles mesh(submesh.vertices, submesh.faces, kTileSpacings * limits_.spacing_m);
  Looks looks{ColourSamples(submesh.vertices.size()), std::vector<VertexSight>(submesh.vertices.size())};
  const auto look_at = [&](const KeyImage& image, std::size_t number) {
    look(mesh, image.T_world_camera.inverse() * submesh.T_map_submesh, image, number, looks);
  };
  std::vector<ImageGain> gains;
  for (const SettledImage& earlier : earlier_) {
    look_at(earlier.image, gains.size());
    gains.push_back(earlier.gain);
  }
  const std::size_t own = gains.size();
  for (const KeyImage& image : images) gains.push_back({.log_exposure = image.log_exposure});
  std::vector<bool> looked_at(images.size(), false);
  for (const std::size_t i : spread(images.size())) {
    if (hurry) break;
    look_at(images[i], own + i);
    looked_at[i] = true;
  }
  settle_gains(looks.samples, gains, falloff_);

  std::vector<VertexColour> colours(submesh.vertices.size());
  for (std::size_t i = 0; i < colours.size(); ++i) {
    VertexColour& colour = colours[mesh.origin(i)];
    colour = fused_colour(looks.samples.of(i), gains, falloff_, own);
    counts_.coloured += colour.known();
  }
  counts_.vertices += colours.size();
  std::vector<SettledImage> settled;
  for (std::size_t i = 0; i < images.size(); ++i)
    if (looked_at[i]) settled.push_back({std::move(images[i]), gains[own + i]});
  counts_.images += settled.size();
  counts_.hurried += images.size() - settled.size();
  if (settled.size() > kEarlierImages) settled.erase(settled.begin(), settled.end() - kEarlierImages);
  if (!settled.empty()) earlier_ = std::move(settled);
  return colours;
}

}  // namespace lxd
