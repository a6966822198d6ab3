// SPDX-License-Identifier: Apache-2.0
// Mesh extraction: what a user would call cracks, doubled sheets, flipped faces and lost corners, on surfaces known
// exactly.
#include <algorithm>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "mapping/mesh_extraction.hpp"
#include "rt/allocation_guard.hpp"
#include "tests/support/mapping_scene.hpp"

namespace lxd::mapping_mesh_extraction_test {
namespace {

using test::area_vector;
using test::components_of;
using test::edges_of;
using test::MappingScene;
using test::MeshEdges;
using Vec = Eigen::Vector3f;
using Mesh = MeshExtraction::Mesh;

// Enough looks and points for a second surface in a cell whose first one is known well, and rests between its turns.
constexpr int kLooks = 16;
constexpr float kDense_m = 0.02F;

void expect_sound(const Mesh& mesh) {
  const MeshEdges edges = edges_of(mesh);
  EXPECT_EQ(edges.crowded, 0U);
  EXPECT_EQ(edges.disagreeing, 0U);
  for (const MeshFace& f : mesh.faces) ASSERT_GT(area_vector(mesh, f).norm(), 1e-8F);
  for (const MeshVertex& v : mesh.vertices) ASSERT_NEAR(v.normal.norm(), 1.0F, 1e-4F);
}

double area_of(const Mesh& mesh) {
  double area = 0;
  for (const MeshFace& f : mesh.faces) area += area_vector(mesh, f).norm();
  return area;
}

// Open edges whose middle is farther than `margin` within the patch's four borders.
std::size_t cracks(const Mesh& mesh, const Vec& corner, const Vec& u, const Vec& v, float margin_m) {
  std::size_t count = 0;
  for (const auto& [a, b] : edges_of(mesh).open) {
    const Vec middle = 0.5F * (mesh.vertices[a].position_m + mesh.vertices[b].position_m) - corner;
    const float along_u = middle.dot(u.normalized()), along_v = middle.dot(v.normalized());
    count += along_u > margin_m && along_u < u.norm() - margin_m && along_v > margin_m && along_v < v.norm() - margin_m;
  }
  return count;
}

struct Tilt {
  float degrees, azimuth_degrees;
};

class TiltedPlane : public testing::TestWithParam<Tilt> {};

// Given a plane of 4 m x 4 m through many cells, tilted; when it is extracted; then it is one sheet, open only at its
// rim.
TEST_P(TiltedPlane, IsOneSheetWithoutCracks) {
  MappingScene scene;
  const float tilt = GetParam().degrees * std::numbers::pi_v<float> / 180.0F;
  const float azimuth = GetParam().azimuth_degrees * std::numbers::pi_v<float> / 180.0F;
  const Eigen::Matrix3f R = (Eigen::AngleAxisf(azimuth, Vec::UnitZ()) * Eigen::AngleAxisf(tilt, Vec::UnitY())).matrix();
  const Vec u = R * Vec(4, 0, 0), v = R * Vec(0, 4, 0), corner = Vec(0.13F, 0.07F, 0.21F) - 0.5F * (u + v);
  scene.add_patch(corner, u, v);
  scene.fuse(R * Vec(0, 0, 5), kLooks);
  const Mesh mesh = scene.mesh();

  expect_sound(mesh);
  EXPECT_EQ(cracks(mesh, corner, u, v, 0.3F), 0U);
  EXPECT_EQ(components_of(mesh), 1U);
  EXPECT_NEAR(area_of(mesh), 16.0, 2.0);  // quads at the rim stick out
  for (const MeshVertex& vertex : mesh.vertices) {
    const Vec middle = vertex.position_m - corner - 0.5F * (u + v);
    if (middle.cwiseAbs().maxCoeff() > 1.2F) continue;  // away from the rim, where nothing is extrapolated
    ASSERT_LT(std::abs(middle.dot(R.col(2))), 0.006F);
    ASSERT_GT(vertex.normal.dot(R.col(2)), 0.97F);  // towards the sensor
  }
}

INSTANTIATE_TEST_SUITE_P(Slopes, TiltedPlane,
                         testing::Values(Tilt{0, 0}, Tilt{10, 20}, Tilt{30, 0}, Tilt{30, 35}, Tilt{44, 0}, Tilt{44, 30},
                                         Tilt{90, 0}, Tilt{90, 90}),
                         [](const auto& test) {
                           return "by" + std::to_string(static_cast<int>(test.param.degrees)) + "towards" +
                                  std::to_string(static_cast<int>(test.param.azimuth_degrees));
                         });

// Given a flat floor whose border lies on the lattice, then the open edges are exactly its perimeter's.
TEST(MeshExtraction, FloorIsOpenAtItsPerimeterOnly) {
  MappingScene scene;
  scene.add_patch({0, 0, 0.25F}, {3, 0, 0}, {0, 2, 0});
  scene.fuse({1, 1, 3});
  const Mesh mesh = scene.mesh();
  expect_sound(mesh);
  const float spacing = 0.1F;
  EXPECT_EQ(edges_of(mesh).open.size(), static_cast<std::size_t>(std::lround(2 * (3 + 2) / spacing)));
  EXPECT_EQ(mesh.faces.size(), static_cast<std::size_t>(std::lround(3 * 2 / (spacing * spacing)) * 2));
  EXPECT_EQ(mesh.vertices.size(), 31U * 21U);
}

// The same floor seen from below has its faces the other way round.
TEST(MeshExtraction, NormalsAndFacesPointToTheSensor) {
  for (const float height : {3.0F, -3.0F}) {
    MappingScene scene;
    scene.add_patch({0, 0, 0.25F}, {2, 0, 0}, {0, 2, 0});
    scene.fuse({1, 1, height});
    const Mesh mesh = scene.mesh();
    ASSERT_FALSE(mesh.faces.empty());
    for (const MeshVertex& v : mesh.vertices) ASSERT_GT(v.normal.z() * height, 0);
    for (const MeshFace& f : mesh.faces) ASSERT_GT(area_vector(mesh, f).z() * height, 0);
  }
}

// Given a grazing view: 1.5 m high and up to 19 m away, then no patch is turned over.
TEST(MeshExtraction, GrazingFloorIsNotTurnedOver) {
  MappingScene scene;
  scene.sigma_m = 0.02F;
  scene.add_patch({15, 0, 0.25F}, {4, 0, 0}, {0, 4, 0}, 0.06F);
  scene.fuse({0, 2, 1.75F}, 8);
  const Mesh mesh = scene.mesh();
  std::size_t down = 0;
  for (const MeshFace& f : mesh.faces) down += area_vector(mesh, f).z() < 0;
  EXPECT_EQ(down, 0U);
}

TEST(MeshExtraction, ParallelSurfacesStayTwoSheets) {
  MappingScene scene;
  for (const float height : {0.1F, 0.3F}) {
    scene.add_patch({0, 0, height}, {2, 0, 0}, {0, 2, 0}, kDense_m);
    scene.fuse({1, 1, 3}, kLooks);
  }
  const Mesh mesh = scene.mesh();
  expect_sound(mesh);
  EXPECT_EQ(components_of(mesh), 2U);
  for (const MeshVertex& v : mesh.vertices)
    EXPECT_LT(std::min(std::abs(v.position_m.z() - 0.1F), std::abs(v.position_m.z() - 0.3F)), 0.01F);
}

// Rays from an eye that pass through the mesh although a surface is there: what a user sees as a crack.
std::size_t rays_through(const Mesh& mesh, const Vec& eye, const std::vector<Vec>& targets) {
  std::size_t missed = 0;
  for (const Vec& target : targets) {
    const Vec way = target - eye;
    const bool hit = std::any_of(mesh.faces.begin(), mesh.faces.end(), [&](const MeshFace& f) {
      const Vec a = mesh.vertices[f[0]].position_m - eye, b = mesh.vertices[f[1]].position_m - eye,
                c = mesh.vertices[f[2]].position_m - eye;
      const float ab = a.cross(b).dot(way), bc = b.cross(c).dot(way), ca = c.cross(a).dot(way);
      return (ab <= 0 && bc <= 0 && ca <= 0 && a.dot(way) > 0) || (ab >= 0 && bc >= 0 && ca >= 0 && a.dot(way) > 0);
    });
    missed += !hit;
  }
  return missed;
}

// Given a room's corner, neither wall on the lattice; then it is one sheet, and no look into the corner finds a crack.
TEST(MeshExtraction, BoxCornerCloses) {
  MappingScene scene;
  const Vec o(0.13F, 0.17F, 0.21F), x(2, 0, 0), y(0, 2, 0), z(0, 0, 2), eye = o + Vec(1.4F, 1.5F, 1.6F);
  for (const auto& [u, v] : {std::pair(x, y), std::pair(y, z), std::pair(z, x)}) {
    scene.add_patch(o, u, v, kDense_m);
    scene.fuse(eye, kLooks);
  }
  const Mesh mesh = scene.mesh();
  expect_sound(mesh);
  EXPECT_EQ(components_of(mesh), 1U);
  EXPECT_NEAR(area_of(mesh), 12.0, 1.0);
  std::vector<Vec> targets;
  std::uniform_real_distribution<float> along(0, 1.7F), beside(0, 0.15F);  // near the three edges, where patches meet
  for (int i = 0; i < 900; ++i) {
    Vec p = Vec::Zero();
    p[i % 3] = along(scene.random);
    p[(i + 1) % 3] = beside(scene.random);
    targets.push_back(o + p);
  }
  EXPECT_EQ(rays_through(mesh, eye, targets), 0U);
}

// Given a cylinder's inner wall of 2 m radius, all slopes, two axes in turn; then no look at it from within finds a
// crack.
TEST(MeshExtraction, CylinderIsClosedWhereAxesChange) {
  MappingScene scene;
  constexpr int kAround = 420, kUp = 60;
  constexpr float kTurn = 2 * std::numbers::pi_v<float>;
  const auto wall = [](float angle, float z) { return Vec(2 * std::cos(angle), 2 * std::sin(angle), z); };
  for (int i = 0; i < kAround; ++i)
    for (int k = 0; k < kUp; ++k)
      scene.add(wall(kTurn * static_cast<float>(i) / kAround, 2.0F * static_cast<float>(k) / kUp));
  scene.fuse({0, 0, 1});
  const Mesh mesh = scene.mesh();
  expect_sound(mesh);
  EXPECT_EQ(components_of(mesh), 1U);
  EXPECT_NEAR(area_of(mesh), 4 * kTurn, 0.08 * 4 * kTurn);
  for (const MeshVertex& v : mesh.vertices) ASSERT_NEAR(v.position_m.head<2>().norm(), 2.0F, 0.06F);
  std::vector<Vec> targets;
  std::uniform_real_distribution<float> anywhere(0, kTurn), height(0.2F, 1.8F);
  for (int i = 0; i < 1000; ++i) targets.push_back(wall(anywhere(scene.random), height(scene.random)));
  EXPECT_EQ(rays_through(mesh, {0, 0, 1}, targets), 0U);
}

// Variance: the vertex of several cells is better known than that of one, and noise shows.
TEST(MeshExtraction, VarianceIsCarried) {
  const auto mean_variance = [](float sigma_m) {
    MappingScene scene;
    scene.sigma_m = sigma_m;
    scene.add_patch({0, 0, 0.25F}, {2, 0, 0}, {0, 2, 0}, 0.05F);
    scene.fuse({1, 1, 3}, 2);
    const Mesh mesh = scene.mesh();
    double sum = 0;
    for (const MeshVertex& v : mesh.vertices) {
      EXPECT_GT(v.variance_m2, 0);
      EXPECT_LE(v.variance_m2, 0.05F * 0.05F);
      sum += v.variance_m2;
    }
    return sum / static_cast<double>(mesh.vertices.size());
  };
  EXPECT_GT(mean_variance(0.03F), 2 * mean_variance(0.003F));
}

// Given scattered returns as of leaves; then chance planes are few: below two in a hundred of the quads that the cells
// hold.
TEST(MeshExtraction, ScatteredPointsGiveHardlyAnyFaces) {
  MappingScene scene;
  constexpr int kCells = 8 * 8 * 8;
  std::uniform_real_distribution<float> anywhere(0, 4);
  for (int i = 0; i < kCells * 4; ++i)
    scene.add({anywhere(scene.random), anywhere(scene.random), anywhere(scene.random)});
  scene.fuse({2, 2, 9}, 10);
  EXPECT_LT(scene.mesh().faces.size(), kCells * 2 * kLayerQuads / 50);
}

TEST(MeshExtraction, EmptySubMeshGivesAnEmptyMesh) {
  MappingScene scene;
  const Mesh mesh = scene.mesh();
  EXPECT_TRUE(mesh.vertices.empty());
  EXPECT_TRUE(mesh.faces.empty());
}

struct Lost {
  MeshCapacity capacity;
  bool complete;
  std::uint64_t MeshCounters::*counter;
};

class MeshCapacityLimit : public testing::TestWithParam<Lost> {};

// A floor of 1 m x 1 m on the lattice takes 4 layers, 144 corners, 121 vertices, 200 faces and 40 boundary vertices.
TEST_P(MeshCapacityLimit, IsCountedAndTheRestStaysSound) {
  MappingScene scene({}, test::kSceneCapacity, GetParam().capacity);
  scene.add_patch({0, 0, 0.25F}, {1, 0, 0}, {0, 1, 0});
  scene.fuse({0.5F, 0.5F, 3}, kLooks);
  const Mesh mesh = scene.mesh();
  expect_sound(mesh);
  EXPECT_EQ(scene.extraction.counters().*GetParam().counter == 0, GetParam().complete);
  const bool all_faces = GetParam().complete || GetParam().counter == &MeshCounters::seam_lost;
  EXPECT_EQ(mesh.faces.size() == 200U, all_faces) << mesh.faces.size();
}

INSTANTIATE_TEST_SUITE_P(BelowAtAbove, MeshCapacityLimit,
                         testing::Values(Lost{{3, 144, 121, 200, 40}, false, &MeshCounters::layers_lost},
                                         Lost{{4, 144, 121, 200, 40}, true, &MeshCounters::layers_lost},
                                         Lost{{5, 145, 122, 201, 41}, true, &MeshCounters::layers_lost},
                                         Lost{{4, 143, 121, 200, 40}, false, &MeshCounters::corners_lost},
                                         Lost{{4, 144, 121, 200, 40}, true, &MeshCounters::corners_lost},
                                         Lost{{4, 144, 120, 200, 40}, false, &MeshCounters::vertices_lost},
                                         Lost{{4, 144, 121, 200, 40}, true, &MeshCounters::vertices_lost},
                                         Lost{{4, 144, 121, 199, 40}, false, &MeshCounters::faces_lost},
                                         Lost{{4, 144, 121, 200, 40}, true, &MeshCounters::faces_lost},
                                         Lost{{4, 144, 121, 200, 39}, false, &MeshCounters::seam_lost},
                                         Lost{{4, 144, 121, 200, 40}, true, &MeshCounters::seam_lost}));

// The same sub-mesh gives the same bytes, and an extraction allocates nothing.
TEST(MeshExtraction, IsDeterministicAndAllocatesNothing) {
  MappingScene scene;
  scene.add_patch({0.13F, 0.17F, 0.21F}, {2, 0, 1}, {0, 2, 0});
  scene.fuse({1, 1, 5});
  const Mesh first = scene.mesh();
  const std::vector<MeshVertex> vertices(first.vertices.begin(), first.vertices.end());
  const std::vector<MeshFace> faces(first.faces.begin(), first.faces.end());
  const AllocationGuard guard;
  const Mesh second = scene.mesh();
  EXPECT_EQ(guard.count(), 0U);
  ASSERT_EQ(second.vertices.size(), vertices.size());
  EXPECT_EQ(std::vector<MeshFace>(second.faces.begin(), second.faces.end()), faces);
  for (std::size_t i = 0; i < vertices.size(); ++i) ASSERT_EQ(second.vertices[i].position_m, vertices[i].position_m);
}

}  // namespace
}  // namespace lxd::mapping_mesh_extraction_test
