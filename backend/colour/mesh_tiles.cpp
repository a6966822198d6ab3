// SPDX-License-Identifier: Apache-2.0
#include "backend/colour/mesh_tiles.hpp"

#include <algorithm>
#include <unordered_map>

#include "mapping/lattice.hpp"

namespace lxd {
namespace {

// Tiles are numbered as they first appear.
std::vector<std::uint32_t> tiles_by_place(std::span<const MeshVertex> vertices, float edge_m, std::size_t& count) {
  std::unordered_map<CellKey, std::uint32_t> known;
  std::vector<std::uint32_t> tile(vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const CellKey key = pack(cell_of(vertices[i].position_m.cast<double>(), 1.0 / edge_m));
    tile[i] = known.try_emplace(key, static_cast<std::uint32_t>(known.size())).first->second;
  }
  count = known.size();
  return tile;
}

// Where each of the list goes when it is sorted by tile; parts: one a tile.
template <typename Part>
std::vector<std::uint32_t> places(std::span<const std::uint32_t> tile_of, std::span<MeshTile> tiles, Part part) {
  for (const std::uint32_t tile : tile_of) ++part(tiles[tile]).count;
  std::uint32_t first = 0;
  for (MeshTile& tile : tiles) {
    part(tile).first = first;
    first += part(tile).count;
  }
  std::vector<std::uint32_t> next(tiles.size()), place(tile_of.size());
  for (std::size_t t = 0; t < tiles.size(); ++t) next[t] = part(tiles[t]).first;
  for (std::size_t i = 0; i < tile_of.size(); ++i) place[i] = next[tile_of[i]]++;
  return place;
}

}  // namespace

MeshTiles::MeshTiles(std::span<const MeshVertex> vertices, std::span<const MeshFace> faces, float edge_m) {
  sort_vertices(vertices, edge_m);
  sort_faces(faces);
  enclose();
}

void MeshTiles::sort_vertices(std::span<const MeshVertex> vertices, float edge_m) {
  std::size_t count = 0;
  const std::vector<std::uint32_t> tile = tiles_by_place(vertices, edge_m, count);
  tiles_.resize(count);
  const auto place = places(tile, tiles_, [](MeshTile& t) -> TilePart& { return t.vertices; });
  vertices_.resize(vertices.size());
  origins_.resize(vertices.size());
  tile_of_.resize(vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    vertices_[place[i]] = vertices[i];
    origins_[place[i]] = static_cast<std::uint32_t>(i);
    tile_of_[place[i]] = tile[i];
  }
}

// A face is where its first corner is.
void MeshTiles::sort_faces(std::span<const MeshFace> faces) {
  std::vector<std::uint32_t> place_of_vertex(origins_.size()), tile(faces.size());
  for (std::size_t i = 0; i < origins_.size(); ++i) place_of_vertex[origins_[i]] = static_cast<std::uint32_t>(i);
  for (std::size_t f = 0; f < faces.size(); ++f) tile[f] = tile_of_[place_of_vertex[faces[f][0]]];
  const auto place = places(tile, tiles_, [](MeshTile& t) -> TilePart& { return t.faces; });
  faces_.resize(faces.size());
  for (std::size_t f = 0; f < faces.size(); ++f)
    faces_[place[f]] = {place_of_vertex[faces[f][0]], place_of_vertex[faces[f][1]], place_of_vertex[faces[f][2]]};
}

void MeshTiles::enclose() {
  for (MeshTile& tile : tiles_) {
    Eigen::Vector3f low = vertices_[tile.vertices.first].position_m, high = low;
    for (const MeshVertex& vertex : std::span(vertices_).subspan(tile.vertices.first, tile.vertices.count)) {
      low = low.cwiseMin(vertex.position_m);
      high = high.cwiseMax(vertex.position_m);
    }
    tile.middle_m = (low + high) / 2;
    tile.radius_m = (high - low).norm() / 2;
  }
  for (const MeshFace& face : faces_)
    for (const std::uint32_t corner : face)
      for (const std::uint32_t other : face) {
        MeshTile& tile = tiles_[tile_of_[corner]];
        tile.radius_m = std::max(tile.radius_m, (vertices_[other].position_m - tile.middle_m).norm());
      }
}

bool may_show(const MeshTile& tile, const Pose& T_camera_mesh, const PinholeView& view, float range_max_m) {
  const Eigen::Vector3f p = (T_camera_mesh * tile.middle_m.cast<double>()).cast<float>();
  if (p.z() < -tile.radius_m || p.z() > range_max_m + tile.radius_m) return false;
  // Beyond a plane through the camera and a side of the image, from its middle, by more than the radius?
  const auto beyond = [&](float focal, float side) {
    return focal - side * p.z() > tile.radius_m * Eigen::Vector2f(view.focal_px, side).norm();
  };
  const Eigen::Vector2f at = view.focal_px * p.head<2>();
  const Eigen::Vector2f low = -view.centre_px, high = Eigen::Vector2f(static_cast<float>(view.width - 1),
                                                                      static_cast<float>(view.height - 1)) -
                                                      view.centre_px;
  return !(beyond(at.x(), high.x()) || beyond(at.y(), high.y()) || beyond(-at.x(), -low.x()) ||
           beyond(-at.y(), -low.y()));
}

}  // namespace lxd
