// SPDX-License-Identifier: Apache-2.0
// The folder that a replay leaves, as its user finds it; and the recording that the replay's tests share.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "backend/archive.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/evaluate/triangle_mesh.hpp"
#include "tools/evaluate/tum_file.hpp"

namespace lxd::test {

// 6 s of the hall with boxes, made once a build by lxd-boxroom (tests/CMakeLists.txt): moving/ and frozen/.
inline std::filesystem::path boxroom() { return LXD_TEST_BOXROOM; }

class RunResult {
 public:
  explicit RunResult(std::filesystem::path folder) : folder_(std::move(folder)) {}

  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return folder_ / name; }
  [[nodiscard]] std::string bytes(const std::string& name) const { return read_file(folder_ / name); }
  [[nodiscard]] nlohmann::json report() const {
    return nlohmann::json::parse(bytes("report.json"), nullptr, /*allow_exceptions=*/false);
  }
  // Stamps and poses of the filter's path.
  [[nodiscard]] std::vector<StampedPose> path(const std::string& name = "odometry.tum") const {
    const auto file = load_tum(folder_ / name);
    EXPECT_TRUE(file.ok()) << file.error().message;
    return file.ok() ? file->poses : std::vector<StampedPose>();
  }
  [[nodiscard]] std::size_t faces() const {
    const auto mesh = load_mesh_ply(folder_ / "mesh.ply");
    EXPECT_TRUE(mesh.ok()) << mesh.error().message;
    return mesh.ok() ? mesh->faces.size() : 0;
  }

 private:
  std::filesystem::path folder_;
};

// Replays into folder/name; the test fails when the program does not succeed.
inline RunResult replayed(const std::filesystem::path& recording, const TemporaryFolder& folder,
                          const std::string& options, const std::string& name = "run") {
  const Ended ended =
      lxd_slam(fmt::format("replay {} {} --out {}", recording.string(), options, (folder / name).string()));
  EXPECT_EQ(ended.status, 0) << ended.text;
  return RunResult(folder / name);
}

}  // namespace lxd::test
