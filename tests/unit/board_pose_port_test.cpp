// SPDX-License-Identifier: Apache-2.0
// What a controller is told: the datagram's bytes, and that each reading of the IMU brings one.
#include <cstring>

#include <gtest/gtest.h>

#include "board/pose_port.hpp"
#include "drivers/device/udp_socket.hpp"
#include "tests/support/inertial_motion.hpp"
#include "tests/support/loopback.hpp"

namespace lxd::board_pose_port_test {
namespace {

using Eigen::Vector3d;

template <typename T>
T at(const std::string& bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof(T));
  return value;
}

Vector3d vector_at(const std::string& bytes, std::size_t offset) {
  return {at<double>(bytes, offset), at<double>(bytes, offset + 8), at<double>(bytes, offset + 16)};
}

TEST(PoseMessage, HasItsFieldsWhereItsHeaderSaysTheyAre) {
  PoseMessage message;
  message.tracked = true;
  message.count = 0x0102030405060708;
  message.t = RigTime::from_ns(1'700'000'000'123'456'789);
  message.reach = Duration::from_ns(-2);
  message.T_world_reference = {Exp(Vector3d(0, 0, M_PI / 2)), {1, 2, 3}};
  message.v_world_mps = {4, 5, 6};
  message.rate_radps = {7, 8, 9};
  message.sigma_m = 10;
  message.sigma_rad = 11;
  const auto encoded = encode(message);
  const std::string bytes(encoded.begin(), encoded.end());
  ASSERT_EQ(bytes.size(), 152U);
  EXPECT_EQ(bytes.substr(0, 16), std::string("LXDP\1\0\1\0\x08\7\6\5\4\3\2\1", 16));
  EXPECT_EQ(at<std::int64_t>(bytes, 16), 1'700'000'000'123'456'789);
  EXPECT_EQ(at<std::int64_t>(bytes, 24), -2);
  EXPECT_EQ(vector_at(bytes, 32), Vector3d(1, 2, 3));
  EXPECT_NEAR((vector_at(bytes, 56) - Vector3d(0, 0, std::sqrt(0.5))).norm(), 0, 1e-12);
  EXPECT_NEAR(at<double>(bytes, 80), std::sqrt(0.5), 1e-12);
  EXPECT_EQ(vector_at(bytes, 88), Vector3d(4, 5, 6));
  EXPECT_EQ(vector_at(bytes, 112), Vector3d(7, 8, 9));
  EXPECT_EQ(at<double>(bytes, 136), 10);
  EXPECT_EQ(at<double>(bytes, 144), 11);
}

class PosePortTest : public testing::Test {
 protected:
  PosePortTest() {
    auto socket = UdpSocket::open({.sources = {{}}}, clock_);
    EXPECT_TRUE(socket);
    receiver_ = std::move(*socket);
    star_.T_body_reference = {Exp(Vector3d(0.1, -0.2, 0.3)), {0.5, -0.2, 1}};
    auto port = PosePort::open({test::kLoopback, receiver_->port()}, star_);
    EXPECT_TRUE(port);
    port_ = std::move(*port);
  }

  void read(double t_s) {
    const InertialReading reading = motion_.reading(t_s);
    port_->add({std::nullopt, reading.t, reading.t, reading.rate_radps, reading.force_mps2});
  }
  void sweep(double t_s) {
    State x = motion_.state(t_s);
    x.b_g.setZero();
    Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
    covariance.diagonal() << 1, 4, 9, 16, 25, 36;
    port_->leave(MotionAnchor::of(RigTime::from_seconds(t_s), x, true, true), covariance);
  }
  [[nodiscard]] std::vector<std::string> heard(std::size_t count) {
    while (chunks_.chunks.size() < count && test::readable(*receiver_)) receiver_->read(chunks_);
    std::vector<std::string> texts;
    for (const auto& chunk : chunks_.chunks) texts.push_back(chunk.text);
    return texts;
  }

  HostClock clock_;
  test::KeepChunks chunks_;
  std::unique_ptr<UdpSocket> receiver_;
  Star star_;
  std::unique_ptr<PosePort> port_;
  test::InertialMotion motion_ = test::walking_about();
};

// Given sweeps that are known a tenth of a second late, when the IMU reads on, then each reading after the first sweep
// is a datagram with the place, speed and turn of the rig file's reference.
TEST_F(PosePortTest, TellsAtEachReadingWhereTheReferenceIs) {
  constexpr int kReadings = 200;
  constexpr double kPeriod_s = 0.005;
  int told = 0;
  for (int i = 0; i < kReadings; ++i) {
    const double t_s = 2 + i * kPeriod_s;
    if (i >= 20 && i % 20 == 0) sweep(t_s - 0.1);
    read(t_s);
    told += i >= 20;
  }
  const auto messages = heard(static_cast<std::size_t>(told));
  ASSERT_EQ(messages.size(), static_cast<std::size_t>(told));
  EXPECT_EQ(port_->outlet().sent(), messages.size());
  for (std::size_t i = 0; i < messages.size(); ++i) {
    const double t_s = RigTime::from_ns(at<std::int64_t>(messages[i], 16)).seconds();
    const auto reference = [&](double t) { return motion_.pose(t) * star_.T_body_reference; };
    const Vector3d velocity = (reference(t_s + 1e-4).p - reference(t_s - 1e-4).p) / 2e-4;
    EXPECT_EQ(at<std::uint64_t>(messages[i], 8), i);
    EXPECT_LE(at<std::int64_t>(messages[i], 24), 200'000'000);
    EXPECT_LT((vector_at(messages[i], 32) - reference(t_s).p).norm(), 0.002) << t_s;
    EXPECT_LT((vector_at(messages[i], 88) - velocity).norm(), 0.01) << t_s;
    EXPECT_EQ(at<double>(messages[i], 136), 6);
    EXPECT_EQ(at<double>(messages[i], 144), 3);
  }
}

// Given a receiver that has gone, then nothing waits for it, and what it does not hear is counted.
TEST_F(PosePortTest, CountsWhatNobodyHears) {
  receiver_.reset();
  read(2);
  sweep(2);
  for (int i = 1; i < 20; ++i) read(2 + i * 0.005);
  EXPECT_EQ(port_->outlet().sent() + port_->outlet().unheard(), 19U);
  EXPECT_GT(port_->outlet().unheard(), 0U);
}

TEST(UdpEndpoints, AreAnAddressAndAPort) {
  const auto good = parse_endpoint("127.0.0.1:4711");
  ASSERT_TRUE(good);
  EXPECT_EQ(good->address, test::kLoopback);
  EXPECT_EQ(good->port, 4711);
  for (const char* const wrong : {"", ":", "127.0.0.1", "127.0.0.1:", "127.0.0.1:0", "127.0.0.1:65536", "127.0.0.1:1x",
                                  "localhost:1", ":4711", "1.2.3:4"}) {
    const auto refused = parse_endpoint(wrong);
    ASSERT_FALSE(refused) << wrong;
    EXPECT_NE(refused.error().message.find(wrong), std::string::npos);
  }
}

}  // namespace
}  // namespace lxd::board_pose_port_test
