// SPDX-License-Identifier: Apache-2.0
// What runs for every packet allocates nothing: fixes, wheels, clocks.
#include <gtest/gtest.h>

#include "drivers/sync/clock_model.hpp"
#include "drivers/wheel/wheel_decoder.hpp"
#include "rt/allocation_guard.hpp"
#include "tests/support/data_folders.hpp"
#include "tests/support/nmea_text.hpp"
#include "tests/support/temporary_folder.hpp"

namespace lxd::drivers_real_time_test {
namespace {

class DriversRealTime : public testing::Test {
 protected:
  void SetUp() override {
#ifdef LXD_SANITIZED
    GTEST_SKIP() << "the sanitizer has an allocator of its own";
#else
    ASSERT_TRUE(AllocationGuard::active()) << "this executable does not link lxd_alloc_hook";
#endif
  }
};

TEST_F(DriversRealTime, FixesAllocateNothing) {
  const std::string log = test::read_file(test::clone_data("gnss") / "quectel-L70.log");
  std::size_t fixes = 0;
  const AllocationGuard guard;
  NmeaParser parser;
  parser.feed(test::bytes(log), {}, [&](const GnssFix&) { ++fixes; });
  EXPECT_EQ(guard.count(), 0U);
  EXPECT_EQ(fixes, 16U);
}

TEST_F(DriversRealTime, WheelsAllocateNothing) {
  CanFrame frame;
  frame.length = 8;
  std::size_t samples = 0;
  const AllocationGuard guard;
  WheelDecoder decoder({agilex_messages(), WheelSource::odometer, 0.5});
  for (std::uint32_t i = 0; i < 2000; ++i) {
    frame.id = i % 4 == 0 ? 0x311 : 0x380 + i % 0x400;  // among others
    frame.received = RigTime::from_ns(5'000'000 * std::int64_t{i});
    samples += decoder.decode(frame).has_value();
  }
  EXPECT_EQ(guard.count(), 0U);
  EXPECT_EQ(samples, 499U);
}

TEST_F(DriversRealTime, ClocksAllocateNothing) {
  std::int64_t sum_ns = 0;
  const AllocationGuard guard;
  ClockModel model{{}};
  for (std::int64_t i = 0; i < 200'000; ++i) {
    const std::int64_t t_ns = 1'000'000 * i;
    model.add(t_ns, RigTime::from_ns(t_ns + 5'000'000 + i * 7919 % 1'000'000));
    if (i % 1000 == 0) model.add_edge(RigTime::from_ns(t_ns + 5'000'000));
    sum_ns += model.to_rig(t_ns).ns() - t_ns;
  }
  EXPECT_EQ(guard.count(), 0U);
  EXPECT_NEAR(static_cast<double>(sum_ns) / 200'000, 5'000'000, 10'000);
  EXPECT_TRUE(model.pulse_locked());
}

}  // namespace
}  // namespace lxd::drivers_real_time_test
