// SPDX-License-Identifier: Apache-2.0
// Captures of real Ouster sensors through the whole program: packets in, path and mesh out.
#include "tests/support/replay_files.hpp"
#include "tests/support/run_result.hpp"

namespace lxd::test::ouster_capture_test {
namespace {

using replay_test::clone_ouster;
using replay_test::shared_ouster;

struct Capture {
  const char* name;
  std::size_t sweeps;
  std::size_t faces_min;  // about half of what the sweeps' surfaces gave
};

RunResult expect_mapped(const std::filesystem::path& pcap, const Capture& capture, const TemporaryFolder& folder) {
  const RunResult run = replayed(pcap, folder, "");
  EXPECT_EQ(run.report()["sweeps"], capture.sweeps);
  EXPECT_EQ(run.path().size(), capture.sweeps);
  EXPECT_GE(run.faces(), capture.faces_min);
  return run;
}

class OusterCapture : public testing::TestWithParam<Capture> {};

TEST_P(OusterCapture, ThatTheCloneCarriesBecomesAMesh) {
  const TemporaryFolder folder;
  (void)expect_mapped(clone_ouster() / GetParam().name, GetParam(), folder);
}

INSTANTIATE_TEST_SUITE_P(Clone, OusterCapture,
                         testing::Values(Capture{"OS-1-32-G_v2.1.1_1024x10.pcap", 1, 7'000},
                                         Capture{"OS-0-32-U1_v2.2.0_1024x10.pcap", 1, 4'500}),
                         [](const auto& param) { return "OS" + std::string(param.param.name).substr(3, 1); });

// Three whole sweeps of a driving car's 128 beams.
TEST(OusterCaptureShared, ThreeSweepsOf128BeamsBecomeAMesh) {
  const auto pcap = shared_ouster("OS-1-128_v2.3.0_1024x10_lb_n3.pcap");
  if (!pcap) GTEST_SKIP() << "LXD_SHARED_DATA has no ouster/OS-1-128_v2.3.0_1024x10_lb_n3.pcap";
  const TemporaryFolder folder;
  const RunResult run = expect_mapped(*pcap, {"", 3, 115'000}, folder);
  // The vendor's own odometry of this capture, ..._poses_kitti.txt: 0.246 m and 0.498 m ahead. Its poses are of other
  // instants of the turn, at 2.5 m/s.
  const auto path = run.path();
  ASSERT_EQ(path.size(), 3U);
  EXPECT_NEAR((path[1].T.p - path[0].T.p).norm(), 0.246, 0.06);
  EXPECT_NEAR((path[2].T.p - path[0].T.p).norm(), 0.498, 0.06);
}

}  // namespace
}  // namespace lxd::test::ouster_capture_test
