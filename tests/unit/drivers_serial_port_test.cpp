// SPDX-License-Identifier: Apache-2.0
// A serial port: plain bytes, a cable that is pulled, one that is put in again.
#include "drivers/device/serial_port.hpp"
#include "tests/support/emulated.hpp"
#include "tests/support/loopback.hpp"
#include "tests/support/temporary_folder.hpp"

namespace lxd::test::drivers_serial_port_test {
namespace {

constexpr Duration kLater = Duration::from_ns(3'000'000'000);  // than any interval between two looks

class SerialLine : public testing::Test {
 protected:
  SerialLine() : cable_(folder_ / "imu"), port_({(folder_ / "imu").string(), 921'600, 2}, clock_) {}

  void SetUp() override {
    if (emulated()) GTEST_SKIP() << kNoSerialLine;
  }

  void read(std::size_t bytes) {
    while (heard_.text().size() < bytes && readable(port_)) port_.read(heard_);
  }

  TemporaryFolder folder_;
  HostClock clock_;
  SerialCable cable_;
  SerialPort port_;
  KeepChunks heard_;
};

// Given every byte there is, control characters too, then the line changes none of them.
TEST_F(SerialLine, DeliversEveryByteAsItIs) {
  port_.tend(clock_.now());
  ASSERT_GE(port_.fd(), 0) << port_.trouble();
  std::string all;
  for (int byte = 0; byte < 256; ++byte) all += static_cast<char>(byte);
  const RigTime before = clock_.now();
  cable_.send(all);
  read(all.size());
  EXPECT_EQ(heard_.text(), all);
  EXPECT_EQ(heard_.chunks.front().channel, 2);
  EXPECT_GE(heard_.chunks.front().received, before);
  EXPECT_EQ(port_.counts().bytes, all.size());
}

TEST_F(SerialLine, DoesNotWaitWhereNothingCame) {
  port_.tend(clock_.now());
  port_.read(heard_);
  EXPECT_TRUE(heard_.chunks.empty());
  EXPECT_GE(port_.fd(), 0);
}

// Given a cable that is pulled, then the port is away and says so; when it is put in again (as another terminal below
// the same name), then bytes flow again.
TEST_F(SerialLine, ComesBackAfterTheCableWasPulled) {
  port_.tend(clock_.now());
  cable_.send("before");
  read(6);
  cable_.pull();
  ASSERT_TRUE(readable(port_));
  port_.read(heard_);
  EXPECT_EQ(port_.fd(), -1);
  EXPECT_FALSE(port_.trouble().empty());
  EXPECT_EQ(port_.counts().departures, 1U);
  RigTime now = clock_.now() + kLater;
  port_.tend(now);
  EXPECT_EQ(port_.fd(), -1);

  cable_.plug();
  port_.tend(now + kLater);
  ASSERT_GE(port_.fd(), 0) << port_.trouble();
  EXPECT_TRUE(port_.trouble().empty());
  cable_.send(" after");
  read(12);
  EXPECT_EQ(heard_.text(), "before after");
  EXPECT_EQ(port_.counts().openings, 2U);
}

// Given a port that is away, then it is not sought with each call but at growing intervals.
TEST_F(SerialLine, IsSoughtAtGrowingIntervals) {
  cable_.pull();
  const RigTime start = clock_.now();
  port_.tend(start);
  EXPECT_NE(port_.trouble().find("No such file"), std::string::npos) << port_.trouble();
  cable_.plug();
  port_.tend(start + Reopening::kFirst / 2);
  EXPECT_EQ(port_.fd(), -1);
  port_.tend(start + Reopening::kFirst);
  EXPECT_GE(port_.fd(), 0);
}

// Given a cable that was out for a minute, when it is put in again, then half a second is the longest that it takes to
// be found: a filter that waits for an IMU has little more.
TEST_F(SerialLine, IsFoundWithinHalfASecondHoweverLongItWasAway) {
  cable_.pull();
  const RigTime start = clock_.now();
  RigTime now = start;
  for (; now < start + Duration::from_seconds(60); now = now + Duration::from_seconds(0.1)) port_.tend(now);
  cable_.plug();
  for (int i = 0; i < 5; ++i, now = now + Duration::from_seconds(0.1)) port_.tend(now);
  EXPECT_GE(port_.fd(), 0) << port_.trouble();
}

TEST(SerialPortPath, MustBeATerminal) {
  const TemporaryFolder folder;
  write_file(folder / "file", "no terminal");
  const HostClock clock;
  SerialPort port({(folder / "file").string()}, clock);
  port.tend(clock.now());
  EXPECT_EQ(port.fd(), -1);
  EXPECT_NE(port.trouble().find("no serial line"), std::string::npos) << port.trouble();
}

}  // namespace
}  // namespace lxd::test::drivers_serial_port_test
