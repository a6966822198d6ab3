// SPDX-License-Identifier: Apache-2.0
// Worlds that users bring, sound and broken, and the world that goes beside a recording.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"
#include "tools/evaluate/triangle_mesh.hpp"
#include "tools/simulator/world/scene.hpp"
#include "tools/simulator/world/surfaces.hpp"
#include "tools/simulator/world/world_file.hpp"
#include "tools/simulator/world/world_makers.hpp"

namespace lxd::sim::simulator_world_file_test {
namespace {

using test::TemporaryFolder;

Result<World> world_of(const TemporaryFolder& folder, const std::string& name, const std::string& content) {
  test::write_file(folder / name, content);
  return load_world(folder / name);
}

// A square of 2 m, 3 m ahead, as one quadrilateral.
constexpr const char* kSquare = "v 3 -1 -1\nv 3 1 -1\nv 3 1 1\nv 3 -1 1\n";

float range_ahead(const World& world) {
  return Scene(world).cast({.origin_m = {0, 0, 0}, .direction = {1, 0, 0}}).range_m;
}

TEST(SimulatorWorldFile, ObjOfEveryWayToNameAVertex) {
  const TemporaryFolder folder;
  for (const char* const face :
       {"f 1 2 3 4", "f 1/7 2/8 3/9 4/1", "f 1//1 2//1 3//1 4//1", "f 1/1/1 2/2/1 3/3/1 4/4/1", "f -4 -3 -2 -1",
        "f 1 2 3\nf 1 3 4", "o thing\ns off\nusemtl red\nf 1 2 3 4 # square"}) {
    const auto world = world_of(folder, "a.obj", "# comment\r\n" + std::string(kSquare) + "vn 1 0 0\n" + face + "\r\n");
    ASSERT_TRUE(world.ok()) << world.error().message;
    EXPECT_EQ(world->faces.size(), 2U) << face;
    EXPECT_EQ(world->materials.size(), 1U);
    EXPECT_TRUE(world->routes.empty());
    EXPECT_FLOAT_EQ(range_ahead(*world), 3) << face;
  }
}

struct BadObj {
  const char* content;
  const char* cause;
};
class BadWorldObj : public ::testing::TestWithParam<BadObj> {};

TEST_P(BadWorldObj, NamesPlaceAndCause) {
  const TemporaryFolder folder;
  const auto world = world_of(folder, "bad.obj", GetParam().content);
  ASSERT_FALSE(world.ok());
  EXPECT_NE(world.error().message.find((folder / "bad.obj").string()), std::string::npos) << world.error().message;
  EXPECT_NE(world.error().message.find(GetParam().cause), std::string::npos) << world.error().message;
}

INSTANTIATE_TEST_SUITE_P(
    Contents, BadWorldObj,
    ::testing::Values(BadObj{"", "found no face"}, BadObj{"v 0 0 0\nv 1 0 0\nv 0 1 0\n", "found no face"},
                      BadObj{"v 0 0\n", ":1: found '', wanted a finite number"},
                      BadObj{"v 0 0 0\nv 1 x 0\n", ":2: found 'x'"}, BadObj{"v 0 nan 0\n", ":1: found 'nan'"},
                      BadObj{"v 0 inf 0\n", ":1: found 'inf'"}, BadObj{"v 0 1e999 0\n", ":1: found '1e999'"},
                      BadObj{"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", ":4: found vertex 4, wanted one of the 3"},
                      BadObj{"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n", ":4: found vertex 0"},
                      BadObj{"v 0 0 0\nv 1 0 0\nv 0 1 0\nf -1 -2 -4\n", ":4: found vertex -4"},
                      BadObj{"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\n", ":4: found a face of 2 vertices"},
                      BadObj{"v 0 0 0\nv 1 0 0\nv 0 1 0\nf a b c\n", ":4: found 'a', wanted a vertex's number"},
                      BadObj{"v 0 0 0\nv 1 0 0\nv 0 1 500000\nf 1 2 3\n", "wanted within 8192 m of the origin"}));

std::string ply_head(const std::string& format) {
  return "ply\nformat " + format +
         " 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
         "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
}

template <typename T>
void append(std::string& bytes, T value, bool big_endian) {
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), &value, sizeof(T));
  if (big_endian) std::ranges::reverse(raw);
  bytes.append(raw.data(), raw.size());
}

std::string binary_square(bool big_endian) {
  std::string bytes = ply_head(big_endian ? "binary_big_endian" : "binary_little_endian");
  for (const float value : {3.F, -1.F, -1.F, 3.F, 1.F, -1.F, 3.F, 1.F, 1.F, 3.F, -1.F, 1.F})
    append(bytes, value, big_endian);
  bytes.push_back(4);
  for (const std::int32_t index : {0, 1, 2, 3}) append(bytes, index, big_endian);
  return bytes;
}

TEST(SimulatorWorldFile, PlyOfEveryEncoding) {
  const TemporaryFolder folder;
  for (const std::string& content :
       {ply_head("ascii") + "3 -1 -1\n3 1 -1\n3 1 1\n3 -1 1\n4 0 1 2 3\n", binary_square(false), binary_square(true)}) {
    const auto world = world_of(folder, "a.PLY", content);
    ASSERT_TRUE(world.ok()) << world.error().message;
    EXPECT_EQ(world->faces.size(), 2U);
    EXPECT_FLOAT_EQ(range_ahead(*world), 3);
  }
}

TEST(SimulatorWorldFile, APlyCutAnywhereIsAnError) {
  const TemporaryFolder folder;
  const std::string whole = binary_square(false);
  const std::size_t body = whole.size() - 65;  // every byte of it; the head by fives
  for (std::size_t length = 0; length < whole.size(); length += length < body ? 5 : 1) {
    const auto world = world_of(folder, "cut.ply", whole.substr(0, length));
    ASSERT_FALSE(world.ok()) << length;
    EXPECT_NE(world.error().message.find("cut.ply"), std::string::npos);
  }
}

TEST(SimulatorWorldFile, APlyOfNonsenseIsAnError) {
  const TemporaryFolder folder;
  const auto error_of = [&](const std::string& content) {
    const auto world = world_of(folder, "bad.ply", content);
    return world.ok() ? "" : world.error().message;
  };
  EXPECT_NE(error_of(ply_head("ascii") + "3 -1 nan\n3 1 -1\n3 1 1\n3 -1 1\n4 0 1 2 3\n").find("bad.ply"),
            std::string::npos);
  EXPECT_NE(error_of(ply_head("ascii") + "3 -1 0\n3 1 -1\n3 1 1\n3 -1 1\n4 0 1 2 4\n").find("names vertex 4"),
            std::string::npos);
  EXPECT_NE(error_of(ply_head("ascii") + "3 -1 0\n3 1 -1\n3 1 1\n3 -1 1\n2 0 1\n").find("found no face"),
            std::string::npos);
}

TEST(SimulatorWorldFile, WhatIsNoMeshFileIsSaid) {
  const TemporaryFolder folder;
  EXPECT_NE(load_world(folder / "none.ply").error().message.find("No such file"), std::string::npos);
  EXPECT_NE(world_of(folder, "a.stl", "solid").error().message.find("wanted .ply or .obj"), std::string::npos);
  EXPECT_FALSE(load_world(folder.path()).ok());
}

TEST(SimulatorWorldFile, WhatIsWrittenHoldsAllAndSaysWhatIsGlass) {
  const TemporaryFolder folder;
  const World world = *make_world("building", 3);
  ASSERT_TRUE(write_world_ply(folder / "world.ply", world).ok());
  const auto mesh = load_mesh_ply(folder / "world.ply");
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  const auto glass = static_cast<std::uint16_t>(Surface::glass);
  ASSERT_EQ(mesh->faces, world.faces);
  for (std::size_t i = 0; i < world.vertices.size(); ++i)
    ASSERT_EQ(mesh->vertices_m[i].cast<float>(), world.vertices[i]);
  ASSERT_EQ(mesh->glass.size(), world.faces.size());
  for (std::size_t i = 0; i < world.faces.size(); ++i)
    ASSERT_EQ(mesh->glass[i] != 0, world.face_material[i] == glass) << i;
  EXPECT_GT(std::ranges::count(mesh->glass, 1), 0);
  const auto again = load_world(folder / "world.ply");
  ASSERT_TRUE(again.ok()) << again.error().message;
  for (std::size_t i = 0; i < world.faces.size(); ++i)
    ASSERT_EQ(again->materials[again->face_material[i]].glass, world.face_material[i] == glass) << i;
}

TEST(SimulatorWorldFile, AFullDiskOrAMissingFolderIsAnError) {
  const TemporaryFolder folder;
  const World world = *make_world("field", 0);
  const Status status = write_world_ply(folder / "none" / "world.ply", world);
  ASSERT_FALSE(status.ok());
  EXPECT_NE(status.error().message.find("world.ply"), std::string::npos);
}

}  // namespace
}  // namespace lxd::sim::simulator_world_file_test
