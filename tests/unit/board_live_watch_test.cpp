// SPDX-License-Identifier: Apache-2.0
// What a live rig is watched for: sensors that fall silent, threads that do not come back; and what happened, bounded.
#include <gtest/gtest.h>

#include "board/sensor_watch.hpp"
#include "board/thread_watch.hpp"

namespace lxd::board_live_watch_test {
namespace {

RigTime at(double s) { return RigTime::from_seconds(s); }

// Each event as "source: what".
std::vector<std::string> told(const EventLog& events) {
  std::vector<std::string> lines;
  for (const RigEvent& event : events.after(0)) lines.push_back(event.source + ": " + event.what);
  return lines;
}

class WatchedRig : public testing::Test {
 protected:
  WatchedRig() {
    live_.rig.lidar0.rate_hz = 10;
    live_.rig.imu.emplace().update_rate = 200;
    live_.sensors.imu = true;
  }
  LiveRig live_;
  EventLog events_;
};

// Given a LiDAR of 10 Hz and an IMU of 200 Hz, then silence is five periods, but 0.2 s at least; each change is told
// once.
TEST_F(WatchedRig, IsHeardSilentAndHeardAgain) {
  SensorWatch watch(live_, events_);
  watch.look(at(0));
  EXPECT_TRUE(told(events_).empty());
  EXPECT_EQ(watch.silent(), "lidar0, imu");
  watch.heard(LiveChannel::lidar0, at(1));
  watch.heard(LiveChannel::imu, at(1));
  watch.look(at(1.1));
  EXPECT_EQ(watch.silent(), "");
  watch.look(at(1.19));
  watch.look(at(1.3));
  EXPECT_EQ(watch.silent(), "imu");
  EXPECT_FALSE(watch.alive(LiveChannel::imu));
  watch.look(at(1.51));
  watch.heard(LiveChannel::imu, at(2));
  watch.look(at(2));
  EXPECT_EQ(told(events_), (std::vector<std::string>{"lidar0: heard", "imu: heard", "imu: silent", "lidar0: silent",
                                                     "imu: heard again"}));
  EXPECT_EQ(events_.after(0)[2].t, at(1)) << "a sensor is silent since it was last heard";
}

TEST(ThreadWatchDog, TellsAThreadThatDoesNotComeBackAndItsReturn) {
  EventLog events;
  ThreadWatch watch(events);
  watch.look(at(100));
  EXPECT_TRUE(told(events).empty()) << "a thread that has not begun is not missed";
  watch.round(WatchedThread::filter, at(100));
  watch.look(at(101));
  watch.look(at(101.1));
  watch.look(at(102));
  watch.round(WatchedThread::filter, at(102.5));
  watch.look(at(102.5));
  EXPECT_EQ(told(events), (std::vector<std::string>{"filter thread: does not come back", "filter thread: back"}));
  EXPECT_EQ(watch.missed(), 1U);
}

TEST(EventLog, KeepsTheFirstAndCountsTheRest) {
  EventLog events;
  for (std::size_t i = 0; i < EventLog::kEventsMax + 5; ++i) events.add(at(static_cast<double>(i)), "s", "w");
  EXPECT_EQ(events.after(0).size(), EventLog::kEventsMax);
  EXPECT_EQ(events.left_out(), 5U);
  EXPECT_EQ(events.after(EventLog::kEventsMax - 1).size(), 1U);
  EXPECT_TRUE(events.after(EventLog::kEventsMax + 1).empty());
}

}  // namespace
}  // namespace lxd::board_live_watch_test
