// SPDX-License-Identifier: Apache-2.0
// ROS 1 messages of LiDARs, by bytes put together by hand: layouts of fields, and what points' times are told against.
#include <limits>

#include "drivers/ros1/livox_points.hpp"
#include "drivers/ros1/point_cloud.hpp"
#include "tests/support/ros1_bytes.hpp"

namespace lxd::drivers_ros1_scan_test {
namespace {

using test::Ros1Bytes;

constexpr std::uint8_t kUint8 = 2, kUint16 = 4, kUint32 = 6, kFloat32 = 7, kFloat64 = 8;
constexpr std::uint32_t kSeconds = 1'700'000'000;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// Points of x, y = 2, z = 3, uint16 intensity 9, a gap of two bytes, and a time of type T.
template <typename T>
struct CloudOf {
  const char* time_name;
  std::uint8_t time_type;
  std::vector<std::pair<float, T>> points;
  std::uint32_t height = 1, row_gap = 0;
  std::uint8_t big_endian = 0;
  std::uint32_t seconds = kSeconds;

  [[nodiscard]] std::vector<std::uint8_t> bytes() const {
    const auto point_bytes = static_cast<std::uint32_t>(16 + sizeof(T));
    const auto width = static_cast<std::uint32_t>(points.size()) / height;
    Ros1Bytes data;
    for (std::size_t i = 0; i < points.size(); ++i) {
      data.put(points[i].first).put(2.0F).put(3.0F).put(std::uint16_t{9}).put(std::uint16_t{0}).put(points[i].second);
      if ((i + 1) % width == 0) data.repeat(std::uint8_t{0xFF}, static_cast<int>(row_gap));
    }
    Ros1Bytes m;
    m.header(seconds, 0).put(height).put(width).put(std::uint32_t{6});
    m.field("x", 0, kFloat32).field("y", 4, kFloat32).field("z", 8, kFloat32).field("intensity", 12, kUint16);
    m.field("ring", 14, kUint8).field(time_name, 16, time_type);
    m.put(big_endian).put(point_bytes).put(width * point_bytes + row_gap).array(data.bytes).put(std::uint8_t{1});
    return m.bytes;
  }
};

Ros1Scan scan_of(const std::vector<std::uint8_t>& bytes) {
  Ros1Scan scan;
  EXPECT_EQ(read_ros1_point_cloud(bytes, scan), Ros1Fault::none);
  return scan;
}

Ros1Fault fault_of(const std::vector<std::uint8_t>& bytes) {
  Ros1Scan scan;
  return read_ros1_point_cloud(bytes, scan);
}

// As Ouster's driver sends it: rows of a range image, nanoseconds after the stamp.
TEST(Ros1PointCloud, OfAnOusterHasItsTimesAfterTheStamp) {
  const CloudOf<std::uint32_t> cloud{"t", kUint32, {{1, 2000}, {4, 1000}, {5, 3000}, {6, 5000}}, 2, 3};
  const Ros1Scan scan = scan_of(cloud.bytes());
  ASSERT_EQ(scan.points.size(), 4U);
  EXPECT_TRUE(scan.has_times);
  EXPECT_EQ(scan.first.ns(), 1000);  // the earliest point, wherever it stands
  EXPECT_EQ(scan.points[0].offset_ns, 1000);
  EXPECT_EQ(scan.points[1].offset_ns, 0);
  EXPECT_EQ(scan.points[3].offset_ns, 4000);
  EXPECT_EQ(scan.points[3].x_m, 6);
  EXPECT_EQ(scan.points[3].y_m, 2);
  EXPECT_EQ(scan.points[3].z_m, 3);
  EXPECT_EQ(scan.points[3].intensity, 9);
}

// A stamp of the last point, as Velodyne's driver may be set to: times are negative.
TEST(Ros1PointCloud, WithTimesBeforeTheStampBeginsBeforeIt) {
  const CloudOf<float> seconds{"time", kFloat32, {{1, -0.1F}, {2, -0.05F}, {3, 0.0F}}};
  const Ros1Scan scan = scan_of(seconds.bytes());
  EXPECT_NEAR(scan.first.seconds(), -0.1, 1e-8);
  EXPECT_EQ(scan.points[0].offset_ns, 0);
  EXPECT_NEAR(static_cast<double>(scan.points[2].offset_ns), 1e8, 10);
  const CloudOf<std::uint32_t> wrapped{"t", kUint32, {{1, static_cast<std::uint32_t>(-1000)}, {2, 0}}};
  EXPECT_EQ(scan_of(wrapped.bytes()).first.ns(), -1000);
}

TEST(Ros1PointCloud, WithTheTimeOfDayIsToldAgainstTheStamp) {
  const CloudOf<double> seconds{"timestamp", kFloat64, {{1, kSeconds - 0.25}, {2, kSeconds + 0.25}}};
  EXPECT_EQ(scan_of(seconds.bytes()).first.ns(), -250'000'000);
  EXPECT_EQ(scan_of(seconds.bytes()).points[1].offset_ns, 500'000'000);
  const CloudOf<double> nanos{"timestamp", kFloat64, {{1, kSeconds * 1e9}, {2, kSeconds * 1e9 + 1024}}};
  EXPECT_EQ(scan_of(nanos.bytes()).first.ns(), 0);
  EXPECT_EQ(scan_of(nanos.bytes()).points[1].offset_ns, 1024);
}

TEST(Ros1PointCloud, WithTheTimeOfDayNeedsNoStamp) {
  CloudOf<double> cloud{"timestamp", kFloat64, {{1, kSeconds + 0.5}, {2, kSeconds + 0.75}}};
  cloud.seconds = 0;
  const Ros1Scan scan = scan_of(cloud.bytes());
  EXPECT_EQ(scan.header.stamp.ns(), std::int64_t{kSeconds} * kNanosPerSecond + 500'000'000);
  EXPECT_EQ(scan.first.ns(), 0);
}

TEST(Ros1PointCloud, WithoutTimesSaysSo) {
  const CloudOf<std::uint32_t> cloud{"count", kUint32, {{1, 7}, {2, 9}}};
  const Ros1Scan scan = scan_of(cloud.bytes());
  EXPECT_FALSE(scan.has_times);
  EXPECT_EQ(scan.points[1].offset_ns, 0);
}

TEST(Ros1PointCloud, LeavesOutWhatIsNoPoint) {
  const CloudOf<float> cloud{"time", kFloat32, {{kNan, 0.0F}, {1, 0.01F}, {2, kNan}, {3, 0.02F}}};
  const Ros1Scan scan = scan_of(cloud.bytes());
  EXPECT_EQ(scan.points.size(), 2U);
  EXPECT_EQ(scan.non_finite, 2U);
}

TEST(Ros1PointCloud, ThatCannotBeIsRefusedByName) {
  CloudOf<std::uint32_t> cloud{"t", kUint32, {{1, 1}, {2, 2}}};
  cloud.big_endian = 1;
  EXPECT_EQ(fault_of(cloud.bytes()), Ros1Fault::big_endian);
  EXPECT_EQ(fault_of(CloudOf<std::uint32_t>{"t", kUint8, {}}.bytes()), Ros1Fault::empty);
  EXPECT_EQ(fault_of(CloudOf<std::uint32_t>{"t", kUint16, {{1, 1}}}.bytes()), Ros1Fault::unknown_datatype);
  EXPECT_EQ(fault_of(CloudOf<std::uint32_t>{"t", 9, {{1, 1}}}.bytes()), Ros1Fault::unknown_datatype);
  EXPECT_EQ(fault_of(CloudOf<std::uint32_t>{"t", kFloat64, {{1, 1}}}.bytes()), Ros1Fault::bad_layout);
  EXPECT_EQ(fault_of(CloudOf<std::uint32_t>{"t", kUint32, {{1, 0}, {2, 1'500'000'000}}}.bytes()), Ros1Fault::bad_time);
  CloudOf<std::uint32_t> rows{"t", kUint32, {{1, 1}, {2, 2}}, 2, 0};
  std::vector<std::uint8_t> bytes = rows.bytes();
  bytes[17] = 0xFF;  // the height: more rows than there are
  EXPECT_EQ(fault_of(bytes), Ros1Fault::bad_layout);
  bytes[17] = 2;
  bytes[18] = bytes[19] = bytes[20] = 0xFF;
  EXPECT_EQ(fault_of(bytes), Ros1Fault::bad_layout);
}

void check_points(const Ros1Scan& scan) {
  for (const Ros1Point& point : scan.points) {
    EXPECT_TRUE(std::isfinite(point.x_m) && std::isfinite(point.intensity));
    EXPECT_TRUE(point.offset_ns >= 0 && point.offset_ns <= kNanosPerSecond);
  }
}

TEST(Ros1PointCloud, CutOffOrDamagedIsToldOrStood) {
  const CloudOf<float> seconds{"time", kFloat32, {{1, 0.0F}, {2, 0.01F}, {3, 0.02F}, {4, 0.03F}}, 2, 2};
  const CloudOf<double> absolute{"timestamp", kFloat64, {{1, kSeconds}, {2, kSeconds + 0.25}}};
  for (const auto& bytes : {seconds.bytes(), absolute.bytes()}) {
    test::expect_told_when_cut(read_ros1_point_cloud, bytes);
    test::expect_to_stand_every_bit(read_ros1_point_cloud, bytes, check_points);
  }
}

std::vector<std::uint8_t> livox() {
  Ros1Bytes m;
  m.header(kSeconds, 100).put(std::uint64_t{5}).put(std::uint32_t{2}).repeat(std::uint8_t{0}, 4).put(std::uint32_t{3});
  const auto point = [&](std::uint32_t offset_ns, float x) {
    m.put(offset_ns).put(x).put(x == 0 ? 0.0F : 2.0F).put(x == 0 ? 0.0F : 3.0F);
    m.put(std::uint8_t{200}).put(std::uint8_t{0x10}).put(std::uint8_t{1});
  };
  point(500, 1);
  point(700, 0);
  point(900, 4);
  return m.bytes;
}

TEST(Ros1LivoxPoints, AreAfterTheStampByTheirOffsets) {
  Ros1Scan scan;
  ASSERT_EQ(read_ros1_livox_points(livox(), scan), Ros1Fault::none);
  EXPECT_EQ(scan.first.ns(), 500);
  EXPECT_EQ(scan.no_return, 1U);
  ASSERT_EQ(scan.points.size(), 2U);
  EXPECT_EQ(scan.points[1].offset_ns, 400);
  EXPECT_EQ(scan.points[1].x_m, 4);
  EXPECT_EQ(scan.points[1].intensity, 200);
}

TEST(Ros1LivoxPoints, CutOffOrDamagedIsToldOrStood) {
  test::expect_told_when_cut(read_ros1_livox_points, livox());
  test::expect_to_stand_every_bit(read_ros1_livox_points, livox(), check_points);
}

}  // namespace
}  // namespace lxd::drivers_ros1_scan_test
