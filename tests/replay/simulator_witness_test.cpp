// SPDX-License-Identifier: Apache-2.0
// Independent witnesses of simulated captures: what tshark and capinfos (Wireshark) make of them.
#include <array>
#include <cstdio>
#include <map>
#include <sstream>

#include "tests/support/decoded_ouster.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/simulator/lidar/livox_writer.hpp"

namespace lxd::test::simulator_witness_test {
namespace {

using namespace sim;

bool installed(const std::string& program) {
  return std::system(("command -v " + program + " > /dev/null").c_str()) == 0;
}

std::string output_of(const std::string& command) {
  std::string text;
  std::FILE* const pipe = popen((command + " 2> /dev/null").c_str(), "r");
  if (pipe == nullptr) {
    ADD_FAILURE() << command;
    return text;
  }
  std::array<char, 4096> block{};
  for (std::size_t read = 0; (read = std::fread(block.data(), 1, block.size(), pipe)) > 0;)
    text.append(block.data(), read);
  EXPECT_EQ(pclose(pipe), 0) << command;
  return text;
}

// tshark's reading of a capture: datagrams whole, by destination port and length of UDP.
std::map<std::string, int> datagrams(const std::filesystem::path& pcap) {
  const std::string checks = "-o ip.check_checksum:TRUE -o udp.check_checksum:TRUE -o ip.defragment:TRUE";
  const std::string text =
      output_of("tshark -r " + pcap.string() + " " + checks +
                " -Y 'udp && !_ws.malformed && ip.checksum.status == 1 && udp.checksum.status == 1'"
                " -T fields -e udp.dstport -e udp.length");
  std::map<std::string, int> found;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) ++found[line];
  return found;
}

class SimulatedCaptureWitness : public testing::Test {
 protected:
  void SetUp() override {
    if (!installed("tshark") || !installed("capinfos")) GTEST_SKIP() << "tshark, capinfos: not installed";
  }
  LidarRig rig_{0.3};
  TemporaryFolder folder_;
};

TEST_F(SimulatedCaptureWitness, OusterDatagramsAreWholeAndTheirCheckSumsGood) {
  const LidarLog log = must_write(rig_, small_ouster(), folder_.path());
  const std::map<std::string, int> expected{{"7502\t3336", static_cast<int>(log.datagrams)}, {"7503\t56", 30}};
  EXPECT_EQ(datagrams(folder_ / "lidar0.pcap"), expected);  // 3328 and 48 bytes and UDP's header
}

TEST_F(SimulatedCaptureWitness, LivoxDatagramsAreWholeAndTheirCheckSumsGood) {
  const auto log = write_livox(rig_.context, LivoxConfig{}, folder_.path());
  ASSERT_TRUE(log.ok());
  const std::map<std::string, int> expected{{"56301\t1388", static_cast<int>(log->datagrams)}, {"56401\t68", 60}};
  EXPECT_EQ(datagrams(folder_ / "lidar0.pcap"), expected);
}

TEST_F(SimulatedCaptureWitness, NothingInACaptureIsMalformedOrOutOfOrder) {
  must_write(rig_, small_ouster(), folder_.path());
  const std::string pcap = (folder_ / "lidar0.pcap").string();
  EXPECT_EQ(output_of("tshark -r " + pcap +
                      " -Y '_ws.malformed || ip.checksum.status == 0 || ip.fragment.error'"
                      " -o ip.check_checksum:TRUE"),
            "");
  const std::string info = output_of("capinfos -t -E -o -c " + pcap);
  EXPECT_NE(info.find("nanosecond"), std::string::npos) << info;
  EXPECT_NE(info.find("Ethernet"), std::string::npos) << info;
  EXPECT_NE(info.find("Strict time order:   True"), std::string::npos) << info;
}

}  // namespace
}  // namespace lxd::test::simulator_witness_test
