// SPDX-License-Identifier: Apache-2.0
// The map archive with colours, and the meshes that are exported of it.
#include <array>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "backend/archive.hpp"
#include "backend/mesh_export.hpp"
#include "tests/support/file_bytes.hpp"
#include "tests/support/synthetic_mesh.hpp"
#include "tests/support/temporary_folder.hpp"

namespace lxd::backend_coloured_archive_test {
namespace {

using test::number_at;
using test::SyntheticMesh;
using test::TemporaryFolder;

class ColouredArchive : public ::testing::Test {
 protected:
  void SetUp() override {
    mesh_.add_patch({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0.5F);
    colours_.resize(mesh_.vertices.size());
    colours_[1] = {255, 0, 51, 3};
    auto writer = ArchiveWriter::create(folder_ / "coloured.db");
    ASSERT_TRUE(writer->append(mesh_.view(7)).ok());
    ASSERT_TRUE(writer->append(mesh_.view(9)).ok());
    ASSERT_TRUE(writer->set_colours(9, colours_).ok());
    ASSERT_TRUE(writer->finish().ok());
  }
  Archive open_coloured() { return std::move(Archive::open(folder_ / "coloured.db").value()); }

  TemporaryFolder folder_;
  SyntheticMesh mesh_;
  std::vector<VertexColour> colours_;
};

TEST_F(ColouredArchive, GivesBackItsColoursAndSaysThatTheOthersHaveNone) {
  const Archive archive = open_coloured();
  EXPECT_EQ(archive.totals().submeshes_coloured, 1U);
  const Status read = archive.for_each_submesh([&](const SubmeshView& s) {
    EXPECT_EQ(s.colours.size(), s.id == 9 ? colours_.size() : 0U);
    EXPECT_TRUE(s.id != 9 || s.colours[1] == colours_[1]);
    return success();
  });
  EXPECT_TRUE(read.ok());
}

// What had no camera is byte by byte what it was before there were colours, and is read as it was.
TEST_F(ColouredArchive, IsOfALaterVersionThanOneWithoutColours) {
  auto plain = ArchiveWriter::create(folder_ / "plain.db");
  ASSERT_TRUE(plain->append(mesh_.view(7)).ok());
  ASSERT_TRUE(plain->finish().ok());
  EXPECT_EQ(test::read_file(folder_ / "plain.db")[63], 2);
  EXPECT_EQ(test::read_file(folder_ / "coloured.db")[63], 3);
  EXPECT_FALSE(Archive::open(folder_ / "plain.db")->totals().coloured());
}

TEST_F(ColouredArchive, ForgetsThemWithTheSurfaceThatTheyAreOf) {
  auto writer = ArchiveWriter::create(folder_ / "again.db");
  ASSERT_TRUE(writer->append(mesh_.view(1)).ok());
  ASSERT_TRUE(writer->set_colours(1, colours_).ok());
  ASSERT_TRUE(writer->append(mesh_.view(1)).ok());
  ASSERT_TRUE(writer->finish().ok());
  EXPECT_FALSE(Archive::open(folder_ / "again.db")->totals().coloured());
}

TEST_F(ColouredArchive, WithTooFewColoursIsDamaged) {
  auto writer = ArchiveWriter::create(folder_ / "again.db");
  ASSERT_TRUE(writer->append(mesh_.view(1)).ok());
  ASSERT_TRUE(writer->set_colours(1, std::span(colours_).first(2)).ok());
  ASSERT_TRUE(writer->finish().ok());
  const Status read =
      Archive::open(folder_ / "again.db")->for_each_submesh([](const SubmeshView&) { return success(); });
  ASSERT_FALSE(read.ok());
  EXPECT_NE(read.error().message.find("colours are not one a vertex"), std::string::npos) << read.error().message;
}

TEST_F(ColouredArchive, PlyHasColoursBehindTheVariance) {
  ASSERT_TRUE(write_mesh_ply(folder_ / "mesh.ply", open_coloured()).ok());
  const std::string bytes = test::read_file(folder_ / "mesh.ply");
  EXPECT_NE(bytes.find("property float variance\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
                       "property uchar views\n"),
            std::string::npos);
  const std::string end = "end_header\n";
  const std::size_t data = bytes.find(end) + end.size(), n = mesh_.vertices.size();
  ASSERT_EQ(bytes.size(), data + 2 * n * 32 + 2 * mesh_.faces.size() * 13);
  EXPECT_EQ(number_at<VertexColour>(bytes, data + 28), VertexColour{});
  EXPECT_EQ(number_at<VertexColour>(bytes, data + (n + 1) * 32 + 28), colours_[1]);
}

TEST_F(ColouredArchive, GlbHasThemAsLinearLight) {
  ASSERT_TRUE(write_mesh_glb(folder_ / "mesh.glb", open_coloured()).ok());
  const std::string bytes = test::read_file(folder_ / "mesh.glb");
  const std::size_t json_bytes = number_at<std::uint32_t>(bytes, 12), binary = 20 + json_bytes + 8;
  const auto document = nlohmann::json::parse(bytes.substr(20, json_bytes));
  EXPECT_EQ(document["buffers"][0]["byteLength"].get<std::size_t>(), bytes.size() - binary);
  const auto& accessor =
      document["accessors"][document["meshes"][1]["primitives"][0]["attributes"]["COLOR_0"].get<std::size_t>()];
  EXPECT_EQ(accessor["componentType"], 5123);
  EXPECT_TRUE(accessor["normalized"]);
  const std::size_t colours =
      binary + document["bufferViews"][accessor["bufferView"].get<std::size_t>()]["byteOffset"].get<std::size_t>();
  const std::array<std::uint16_t, 4> unknown = number_at<std::array<std::uint16_t, 4>>(bytes, colours),
                                     known = number_at<std::array<std::uint16_t, 4>>(bytes, colours + 8);
  EXPECT_EQ(unknown[3], 0);
  EXPECT_EQ(known[0], 65535);
  EXPECT_EQ(known[1], 0);
  EXPECT_NEAR(known[2] / 65535.0, 0.0331, 1e-4) << "51 of 255";
  EXPECT_EQ(known[3], 65535);
}

}  // namespace
}  // namespace lxd::backend_coloured_archive_test
