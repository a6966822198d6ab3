// SPDX-License-Identifier: Apache-2.0
// A mesh by cubes: nothing is lost, and what an image shows is in cubes that it may show.
#include <algorithm>
#include <random>
#include <set>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "backend/colour/mesh_tiles.hpp"

namespace lxd::backend_mesh_tiles_test {
namespace {

constexpr float kEdge_m = 3, kRange_m = 20;

// Small faces anywhere within forty metres, some across the cubes' sides.
struct Scattered {
  std::vector<MeshVertex> vertices;
  std::vector<MeshFace> faces;

  explicit Scattered(std::uint32_t count) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> place(-40, 40), side(-0.2F, 0.2F);
    for (std::uint32_t f = 0; f < count; ++f) {
      const Eigen::Vector3f at(place(random), place(random), place(random));
      for (int corner = 0; corner < 3; ++corner)
        vertices.push_back({at + Eigen::Vector3f(side(random), side(random), side(random)), {0, 0, 1}, 0.001F});
      faces.push_back({3 * f, 3 * f + 1, 3 * f + 2});
    }
  }
};

PinholeView view() { return {.width = 64, .height = 48, .focal_px = 40, .centre_px = {30, 25}}; }

std::vector<Pose> poses(int count) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> place(-20, 20);
  std::vector<Pose> poses;
  for (int i = 0; i < count; ++i) {
    const Eigen::Quaterniond turn(normal(random), normal(random), normal(random), normal(random));
    poses.push_back({turn.normalized().toRotationMatrix(), {place(random), place(random), place(random)}});
  }
  return poses;
}

bool is_shown(const Eigen::Vector3f& p_mesh, const Pose& T_camera_mesh) {
  const Eigen::Vector3f p = (T_camera_mesh * p_mesh.cast<double>()).cast<float>();
  if (p.z() <= 0 || p.z() > kRange_m) return false;
  const Eigen::Vector2f pixel = view().pixel(p);
  return pixel.minCoeff() >= 0 && pixel.x() <= 63 && pixel.y() <= 47;
}

const MeshTile& tile_of(const MeshTiles& mesh, std::uint32_t vertex) {
  return *std::ranges::find_if(
      mesh.tiles(), [&](const MeshTile& tile) { return vertex - tile.vertices.first < tile.vertices.count; });
}

}  // namespace

TEST(MeshTiles, HoldEveryVertexAndEveryFaceOnce) {
  const Scattered given(2000);
  const MeshTiles mesh(given.vertices, given.faces, kEdge_m);
  std::set<std::uint32_t> origins;
  std::uint32_t vertices = 0, faces = 0;
  for (const MeshTile& tile : mesh.tiles()) {
    EXPECT_EQ(tile.vertices.first, vertices);
    EXPECT_EQ(tile.faces.first, faces);
    vertices += tile.vertices.count;
    faces += tile.faces.count;
  }
  ASSERT_EQ(vertices, given.vertices.size());
  ASSERT_EQ(faces, given.faces.size());
  for (std::uint32_t i = 0; i < vertices; ++i) {
    origins.insert(mesh.origin(i));
    EXPECT_EQ(mesh.vertices()[i].position_m, given.vertices[mesh.origin(i)].position_m);
  }
  EXPECT_EQ(origins.size(), vertices);
  std::set<MeshFace> back;
  for (const MeshFace& face : mesh.faces())
    back.insert({mesh.origin(face[0]), mesh.origin(face[1]), mesh.origin(face[2])});
  EXPECT_EQ(back, std::set<MeshFace>(given.faces.begin(), given.faces.end()));
}

// Given cameras anywhere, when a corner or the middle of a face is in an image, then the face's tile and those of its
// corners may be, and most of the others are not.
TEST(MeshTiles, ThatAnImageShowsAreNotPassedOver) {
  const Scattered given(3000);
  const MeshTiles mesh(given.vertices, given.faces, kEdge_m);
  std::size_t shown = 0, looked_at = 0;
  for (const Pose& T_camera_mesh : poses(50)) {
    const auto may = [&](const MeshTile& tile) { return may_show(tile, T_camera_mesh, view(), kRange_m); };
    looked_at += static_cast<std::size_t>(std::ranges::count_if(mesh.tiles(), may));
    for (std::uint32_t f = 0; f < mesh.faces().size(); ++f) {
      const MeshFace& face = mesh.faces()[f];
      const auto at = [&](int corner) { return mesh.vertices()[face[static_cast<std::size_t>(corner)]].position_m; };
      const Eigen::Vector3f middle = (at(0) + at(1) + at(2)) / 3;
      if (!is_shown(at(0), T_camera_mesh) && !is_shown(at(1), T_camera_mesh) && !is_shown(at(2), T_camera_mesh) &&
          !is_shown(middle, T_camera_mesh))
        continue;
      ++shown;
      const auto tile =
          std::ranges::find_if(mesh.tiles(), [&](const MeshTile& t) { return f - t.faces.first < t.faces.count; });
      ASSERT_TRUE(may(*tile)) << "face " << f;
      for (const std::uint32_t corner : face) ASSERT_TRUE(may(tile_of(mesh, corner))) << "face " << f;
    }
  }
  EXPECT_GT(shown, 1000U);
  EXPECT_LT(looked_at, 50 * mesh.tiles().size() / 8);
}

TEST(MeshTiles, OfAnEmptyMeshAreNone) { EXPECT_TRUE(MeshTiles({}, {}, kEdge_m).tiles().empty()); }

}  // namespace lxd::backend_mesh_tiles_test
