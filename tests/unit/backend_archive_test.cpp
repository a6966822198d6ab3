// SPDX-License-Identifier: Apache-2.0
// The map archive gives back what was put in, and the exports say the same as the archive, read by other means.

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "backend/archive.hpp"
#include "backend/mesh_export.hpp"
#include "tests/support/file_bytes.hpp"
#include "tests/support/synthetic_mesh.hpp"
#include "tests/support/temporary_folder.hpp"

namespace lxd::backend_archive_test {
namespace {

using test::number_at;
using test::SyntheticMesh;
using test::TemporaryFolder;

Pose some_pose() {
  Pose T;
  T.R = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  T.p = {10.5, -3.25, 0.125};
  return T;
}

SyntheticMesh patch() {
  SyntheticMesh mesh;
  mesh.add_patch({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0.5F);
  return mesh;
}

class ArchiveOfTwo : public ::testing::Test {
 protected:
  void SetUp() override {
    auto writer = ArchiveWriter::create(folder_ / "map.db");
    ASSERT_TRUE(writer.ok()) << writer.error().message;
    ASSERT_TRUE(writer->set_meta("recording", "rooms").ok());
    ASSERT_TRUE(writer->append(mesh_.view(7)).ok());
    ASSERT_TRUE(writer->append(mesh_.view(9, some_pose())).ok());
    ASSERT_TRUE(writer->append_poses(std::vector<StampedPose>{{RigTime::from_ns(5), some_pose()}}).ok());
    ASSERT_TRUE(writer->finish().ok());
  }

  Archive open() { return std::move(Archive::open(folder_ / "map.db").value()); }

  TemporaryFolder folder_;
  SyntheticMesh mesh_ = patch();
};

TEST_F(ArchiveOfTwo, GivesBackWhatWasPutIn) {
  const Archive archive = open();
  EXPECT_EQ(archive.totals().submeshes, 2U);
  EXPECT_EQ(archive.totals().vertices, 2 * mesh_.vertices.size());
  EXPECT_EQ(archive.totals().faces, 2 * mesh_.faces.size());
  EXPECT_EQ(archive.meta().value().at("recording"), "rooms");
  std::vector<std::int64_t> ids;
  const Status read = archive.for_each_submesh([&](const SubmeshView& s) {
    ids.push_back(s.id);
    EXPECT_EQ(s.first.ns(), s.id);
    EXPECT_EQ(s.last.ns(), s.id + 1);
    EXPECT_EQ(std::memcmp(s.vertices.data(), mesh_.vertices.data(), s.vertices.size_bytes()), 0);
    EXPECT_EQ(std::memcmp(s.faces.data(), mesh_.faces.data(), s.faces.size_bytes()), 0);
    EXPECT_EQ(s.T_map_submesh.R, s.id == 9 ? some_pose().R : Eigen::Matrix3d::Identity());
    return success();
  });
  EXPECT_TRUE(read.ok());
  EXPECT_EQ(ids, (std::vector<std::int64_t>{7, 9}));
  const auto poses = archive.poses();
  ASSERT_EQ(poses->size(), 1U);
  EXPECT_EQ((*poses)[0].stamp.ns(), 5);
  EXPECT_EQ((*poses)[0].T.p, some_pose().p);
}

TEST_F(ArchiveOfTwo, IsOneFileOnceFinished) {
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
    files += entry.is_regular_file() ? 1 : 0;
  EXPECT_EQ(files, 1U);
}

TEST_F(ArchiveOfTwo, StopsAtTheVisitorsFirstError) {
  int visits = 0;
  const Status read = open().for_each_submesh([&](const SubmeshView&) -> Status {
    ++visits;
    return Error{"enough"};
  });
  EXPECT_EQ(visits, 1);
  ASSERT_FALSE(read.ok());
  EXPECT_EQ(read.error().message, "enough");
}

TEST_F(ArchiveOfTwo, SubmeshOfTheSameIdIsReplaced) {
  auto writer = ArchiveWriter::create(folder_ / "again.db");
  ASSERT_TRUE(writer->append(mesh_.view(1)).ok());
  mesh_.add_patch({2, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0.5F);
  ASSERT_TRUE(writer->append(mesh_.view(1)).ok());
  ASSERT_TRUE(writer->finish().ok());
  const auto archive = Archive::open(folder_ / "again.db");
  EXPECT_EQ(archive->totals().submeshes, 1U);
  EXPECT_EQ(archive->totals().vertices, mesh_.vertices.size());
}

TEST_F(ArchiveOfTwo, KeyFramesGoWithTheirSubmesh) {
  auto writer = ArchiveWriter::create(folder_ / "again.db");
  const std::vector<SubmeshKeyFrame> frames{{RigTime::from_ns(3), some_pose()}, {RigTime::from_ns(4), {}}};
  SubmeshView view = mesh_.view(1);
  view.key_frames = frames;
  ASSERT_TRUE(writer->append(mesh_.view(0)).ok());
  ASSERT_TRUE(writer->append(view).ok());
  ASSERT_TRUE(writer->finish().ok());
  const auto archive = Archive::open(folder_ / "again.db");
  const Status read = archive->for_each_submesh([&](const SubmeshView& s) {
    EXPECT_EQ(s.key_frames.size(), s.id == 1 ? 2U : 0U);
    if (s.id != 1) return success();
    EXPECT_EQ(s.key_frames[0].stamp.ns(), 3);
    EXPECT_EQ(s.key_frames[0].T_submesh_body.p, some_pose().p);
    return success();
  });
  EXPECT_TRUE(read.ok());
}

// What nobody knows the place of is kept, and is no part of the map.
TEST_F(ArchiveOfTwo, PiecesApartAreNotOfTheMap) {
  auto writer = ArchiveWriter::create(folder_ / "again.db");
  for (int id = 0; id < 3; ++id) ASSERT_TRUE(writer->append(mesh_.view(id)).ok());
  ASSERT_TRUE(writer->set_pose(1, some_pose(), 2).ok());
  ASSERT_TRUE(writer->finish().ok());
  const auto archive = Archive::open(folder_ / "again.db");
  EXPECT_EQ(archive->totals().submeshes, 2U);
  EXPECT_EQ(archive->totals().submeshes_apart, 1U);
  EXPECT_EQ(archive->totals().last_id, 2);
  EXPECT_EQ(archive->totals().vertices, 2 * mesh_.vertices.size());
  EXPECT_TRUE(
      archive->for_each_submesh([](const SubmeshView& s) { return s.id == 1 ? Status(Error{"apart"}) : success(); })
          .ok());
}

TEST_F(ArchiveOfTwo, SessionsWithTheSameStampsKeepTheirPaths) {
  auto writer = ArchiveWriter::create(folder_ / "again.db");
  const std::vector<StampedPose> first{{RigTime::from_ns(5), {}}}, second{{RigTime::from_ns(5), some_pose()}};
  ASSERT_TRUE(writer->append_poses(first, 0).ok());
  ASSERT_TRUE(writer->append_poses(second, 1).ok());
  ASSERT_TRUE(writer->finish().ok());
  const auto archive = Archive::open(folder_ / "again.db");
  EXPECT_EQ(archive->totals().sessions, 2);
  EXPECT_EQ(archive->poses(0)->front().T.p, Eigen::Vector3d::Zero());
  EXPECT_EQ(archive->poses()->front().T.p, some_pose().p);
}

TEST_F(ArchiveOfTwo, AStepThatFailsLeavesNothingBehind) {
  auto writer = ArchiveWriter::create(folder_ / "again.db");
  ASSERT_TRUE(writer->append(mesh_.view(0)).ok());
  const Status failed = writer->all_or_nothing([&] {
    EXPECT_TRUE(writer->append(mesh_.view(1)).ok());
    return Status(Error{"enough"});
  });
  EXPECT_EQ(failed.error().message, "enough");
  ASSERT_TRUE(writer->append(mesh_.view(2)).ok());
  ASSERT_TRUE(writer->finish().ok());
  EXPECT_EQ(Archive::open(folder_ / "again.db")->totals().submeshes, 2U);
}

TEST_F(ArchiveOfTwo, PlyHoldsEverySubmeshInTheMapFrame) {
  ASSERT_TRUE(write_mesh_ply(folder_ / "mesh.ply", open()).ok());
  const std::string bytes = test::read_file(folder_ / "mesh.ply");
  const std::string end = "end_header\n";
  const std::size_t data = bytes.find(end) + end.size();
  const std::size_t n = mesh_.vertices.size(), m = mesh_.faces.size();
  EXPECT_NE(bytes.find("element vertex " + std::to_string(2 * n) + "\n"), std::string::npos);
  EXPECT_EQ(bytes.find("red"), std::string::npos) << "no colour is known, so none is claimed";
  ASSERT_EQ(bytes.size(), data + 2 * n * 28 + 2 * m * 13);
  // The last vertex of the second sub-mesh, which is at (1, 1, 0) in its own frame.
  const std::size_t last = data + (2 * n - 1) * 28;
  const Eigen::Vector3f wanted = (some_pose() * Eigen::Vector3d(1, 1, 0)).cast<float>();
  const Eigen::Vector3f normal = some_pose().R.col(2).cast<float>();
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_FLOAT_EQ(number_at<float>(bytes, last + 4 * axis), wanted[axis]);
    EXPECT_FLOAT_EQ(number_at<float>(bytes, last + 12 + 4 * axis), normal[axis]);
  }
  EXPECT_FLOAT_EQ(number_at<float>(bytes, last + 24), 1e-4F);
  // The first face of the second sub-mesh counts on from the first one's vertices.
  const std::size_t face = data + 2 * n * 28 + m * 13;
  EXPECT_EQ(bytes[face], 3);
  EXPECT_EQ(number_at<std::uint32_t>(bytes, face + 1), mesh_.faces[0][0] + n);
}

TEST_F(ArchiveOfTwo, GlbIsSoundByItsOwnDescription) {
  ASSERT_TRUE(write_mesh_glb(folder_ / "mesh.glb", open()).ok());
  const std::string bytes = test::read_file(folder_ / "mesh.glb");
  ASSERT_EQ(bytes.substr(0, 4), "glTF");
  EXPECT_EQ(number_at<std::uint32_t>(bytes, 4), 2U);
  EXPECT_EQ(number_at<std::uint32_t>(bytes, 8), bytes.size());
  const std::size_t json_bytes = number_at<std::uint32_t>(bytes, 12);
  EXPECT_EQ(json_bytes % 4, 0U);
  const auto document = nlohmann::json::parse(bytes.substr(20, json_bytes));
  const std::size_t binary = 20 + json_bytes + 8;
  EXPECT_EQ(document["buffers"][0]["byteLength"].get<std::size_t>(), bytes.size() - binary);
  ASSERT_EQ(document["meshes"].size(), 2U);
  ASSERT_EQ(document["nodes"].size(), 3U);
  for (const auto& accessor : document["accessors"]) {
    const auto& view = document["bufferViews"][accessor["bufferView"].get<int>()];
    const int components = accessor["type"] == "VEC3" ? 3 : 1;
    const int stride = view.value("byteStride", 4 * components);
    const int last = accessor["byteOffset"].get<int>() + (accessor["count"].get<int>() - 1) * stride + 4 * components;
    EXPECT_LE(last, view["byteLength"].get<int>());
  }
  // The node's matrix, below the root's turn, puts a vertex where the map has it: y up is z.
  const auto matrix = document["nodes"][2]["matrix"].get<std::vector<double>>();
  EXPECT_DOUBLE_EQ(matrix[12], some_pose().p.x());
  const auto root = document["nodes"][0]["matrix"].get<std::vector<double>>();
  const Eigen::Map<const Eigen::Matrix4d> T_gltf_map(root.data());
  EXPECT_TRUE((T_gltf_map * Eigen::Vector4d(0, 0, 1, 1)).isApprox(Eigen::Vector4d(0, 1, 0, 1)));
  const auto& primitive = document["meshes"][0]["primitives"][0];
  const auto& positions = document["accessors"][primitive["attributes"]["POSITION"].get<int>()];
  EXPECT_EQ(positions["max"], nlohmann::json({1.0, 1.0, 0.0}));
  EXPECT_TRUE(primitive["attributes"].contains("_VARIANCE"));
  const auto& indices =
      document["bufferViews"][document["accessors"][primitive["indices"].get<int>()]["bufferView"].get<int>()];
  const std::size_t third = binary + indices["byteOffset"].get<std::size_t>() + 8;
  EXPECT_EQ(number_at<std::uint32_t>(bytes, third), mesh_.faces[0][2]);
}

TEST(EmptyArchive, ExportsFilesThatAreSound) {
  const TemporaryFolder folder;
  ASSERT_TRUE(ArchiveWriter::create(folder / "map.db")->finish().ok());
  const auto archive = Archive::open(folder / "map.db");
  ASSERT_TRUE(archive.ok());
  ASSERT_TRUE(write_mesh_ply(folder / "mesh.ply", *archive).ok());
  ASSERT_TRUE(write_mesh_glb(folder / "mesh.glb", *archive).ok());
  EXPECT_NE(test::read_file(folder / "mesh.ply").find("element vertex 0\n"), std::string::npos);
  const std::string glb = test::read_file(folder / "mesh.glb");
  const auto document = nlohmann::json::parse(glb.substr(20));
  EXPECT_FALSE(document.contains("buffers")) << "glTF knows no empty buffer";
}

}  // namespace
}  // namespace lxd::backend_archive_test
