// SPDX-License-Identifier: Apache-2.0
// Reading of what is evaluated: exact where it is sound, and with file, line and cause where it is not.
#include <string>

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"
#include "tools/evaluate/triangle_mesh.hpp"
#include "tools/evaluate/tum_file.hpp"

namespace lxd::evaluate_files_test {
namespace {

using test::TemporaryFolder;

TEST(Stamp, IsExactToTheNanosecond) {
  EXPECT_EQ(parse_stamp("1684567182.821034193")->ns(), 1'684'567'182'821'034'193);
  EXPECT_EQ(parse_stamp("-0.5")->ns(), -500'000'000);
  EXPECT_EQ(parse_stamp("7")->ns(), 7'000'000'000);
  EXPECT_EQ(parse_stamp("0.0000000015")->ns(), 2);
  EXPECT_EQ(parse_stamp("1.5e2")->ns(), 150'000'000'000);
}

TEST(Stamp, WhatIsNoTimeIsNone) {
  for (const char* const text : {"", "abc", "1.2.3", "nan", "inf", "1e30", "99999999999", "12s"})
    EXPECT_FALSE(parse_stamp(text).has_value()) << text;
}

struct BadLine {
  const char* line;
  const char* cause;
};

class BadTum : public ::testing::TestWithParam<BadLine> {};

TEST_P(BadTum, NamesFileLineAndCause) {
  const TemporaryFolder folder;
  const auto file = folder / "bad.tum";
  test::write_file(file, std::string("# comment\n1 0 0 0 0 0 0 1\n") + GetParam().line + "\n");
  const auto loaded = load_tum(file);
  ASSERT_FALSE(loaded.ok());
  EXPECT_NE(loaded.error().message.find(file.string() + ":3: "), std::string::npos) << loaded.error().message;
  EXPECT_NE(loaded.error().message.find(GetParam().cause), std::string::npos) << loaded.error().message;
}

INSTANTIATE_TEST_SUITE_P(Lines, BadTum,
                         ::testing::Values(BadLine{"2 0 0 0 0 0 0", "found 7 columns, wanted 8"},
                                           BadLine{"2 0 0 0 0 0 0 1 9", "found 9 columns"},
                                           BadLine{"2 0 x 0 0 0 0 1", "column 3: found 'x'"},
                                           BadLine{"2 0 nan 0 0 0 0 1", "found 'nan', wanted a finite number"},
                                           BadLine{"two 0 0 0 0 0 0 1", "wanted a time"},
                                           BadLine{"1 0 0 0 0 0 0 1", "wanted later"},
                                           BadLine{"0.5 0 0 0 0 0 0 1", "wanted later"},
                                           BadLine{"2 0 0 0 0 0 0 2", "norm 2.0000"},
                                           BadLine{"2 0 0 0 0 0 0 0", "one kind"}));

TEST(Tum, EmptyAndMissingFilesAreErrors) {
  const TemporaryFolder folder;
  test::write_file(folder / "empty.tum", "# nothing\n\n");
  EXPECT_NE(load_tum(folder / "empty.tum").error().message.find("no pose"), std::string::npos);
  EXPECT_NE(load_tum(folder / "none.tum").error().message.find("No such file"), std::string::npos);
}

TEST(Tum, WindowsLineEndsAndTabsAreWelcome) {
  const TemporaryFolder folder;
  test::write_file(folder / "a.tum", "1\t2 3  4 0 0 0 1 \r\n");
  const auto loaded = load_tum(folder / "a.tum");
  ASSERT_TRUE(loaded.ok()) << loaded.error().message;
  EXPECT_EQ(loaded->poses[0].T.p, Eigen::Vector3d(2, 3, 4));
}

constexpr const char* kAsciiHead =
    "ply\nformat ascii 1.0\ncomment a square\nelement vertex 4\nproperty double x\nproperty double y\nproperty double "
    "z\n"
    "property uchar red\nelement face 1\nproperty list uchar int vertex_index\nend_header\n";

TEST(MeshFile, AsciiPolygonBecomesAFan) {
  const TemporaryFolder folder;
  test::write_file(folder / "a.ply", std::string(kAsciiHead) + "0 0 0 255\n2 0 0 0\n2 2 0 0\n0 2 0 0\n4 0 1 2 3\n");
  const auto mesh = load_mesh_ply(folder / "a.ply");
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  EXPECT_EQ(mesh->faces.size(), 2U);
  EXPECT_DOUBLE_EQ(mesh->area_m2(), 4);
}

TEST(MeshFile, VarianceAndGlassAreKeptWhereTheyAre) {
  const TemporaryFolder folder;
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "property float variance\nelement face 2\nproperty list uchar int vertex_indices\nproperty uchar glass\n"
      "end_header\n";
  const std::string faces = "4 0 1 2 3 1\n3 0 1 2 0\n";
  test::write_file(folder / "a.ply", head + "0 0 0 0\n2 0 0 0.25\n2 2 0 0.5\n0 2 0 1\n" + faces);
  const auto mesh = load_mesh_ply(folder / "a.ply");
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  EXPECT_EQ(mesh->variance_m2, (std::vector<double>{0, 0.25, 0.5, 1}));
  EXPECT_EQ(mesh->glass, (std::vector<std::uint8_t>{1, 1, 0})) << "both triangles of the pane";
  EXPECT_DOUBLE_EQ(variance_m2(*mesh, {Eigen::Vector3d::Zero(), 0, {0.5, 0.25, 0.25}}), 0.1875);
  EXPECT_EQ(mesh->normal(0), Eigen::Vector3d::UnitZ());
  for (const char* const variance : {"-1", "nan"}) {
    test::write_file(folder / "a.ply", head + "0 0 0 " + variance + "\n2 0 0 0\n2 2 0 0\n0 2 0 0\n" + faces);
    EXPECT_FALSE(load_mesh_ply(folder / "a.ply").ok()) << variance;
  }
}

TEST(MeshFile, DamageIsNamed) {
  const TemporaryFolder folder;
  const auto error_of = [&](const std::string& content) {
    test::write_file(folder / "a.ply", content);
    const auto mesh = load_mesh_ply(folder / "a.ply");
    return mesh.ok() ? "" : mesh.error().message;
  };
  const std::string head = kAsciiHead;
  EXPECT_NE(error_of("solid\n").find("not a PLY file"), std::string::npos);
  EXPECT_NE(error_of("ply\nformat binary_middle_endian 1.0\n").find(":2: found 'format binary_middle_endian"),
            std::string::npos);
  EXPECT_NE(error_of("ply\nformat ascii 1.0\n").find("no end_header"), std::string::npos);
  EXPECT_NE(error_of(head + "0 0 0 0\n1 0 0 0\n").find("vertex 2 of 4: truncated"), std::string::npos);
  EXPECT_NE(error_of(head + "0 0 0 0\n1 0 0 0\n1 1 0 0\n0 1 0 0\n3 0 1 9\n").find("names vertex 9"), std::string::npos);
  EXPECT_NE(error_of("ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nend_header\n").find("no vertices"),
            std::string::npos);
}

}  // namespace
}  // namespace lxd::evaluate_files_test
