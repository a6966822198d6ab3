// SPDX-License-Identifier: Apache-2.0
// `lxd-slam import`, through the program: a bag of the hall with boxes becomes a folder that replays as the hall does;
// and what is no bag, or no bag of this rig, is refused by name and leaves nothing.
#include <gtest/gtest.h>

#ifdef LXD_HAS_ROSBAG

#include "drivers/replay/csv_log.hpp"
#include "drivers/replay/image_file.hpp"
#include "drivers/replay/scan_folder.hpp"
#include "tests/support/bag_file.hpp"
#include "tests/support/made_jpeg.hpp"
#include "tests/support/ros1_bytes.hpp"
#include "tests/support/run_result.hpp"

namespace lxd::test::imported_bag_test {
namespace {

namespace fs = std::filesystem;

constexpr std::uint8_t kFloat32 = 7;
constexpr std::uint32_t kPointBytes = 20;
constexpr int kFailed = 1, kBadInput = 2;
constexpr double kSame = 1e-5;  // m, and of a rotation's matrix

Ros1Bytes begun(RigTime stamp) {
  Ros1Bytes message;
  message.header(static_cast<std::uint32_t>(stamp.ns() / kNanosPerSecond),
                 static_cast<std::uint32_t>(stamp.ns() % kNanosPerSecond));
  return message;
}

RawMessage cloud(RigTime stamp, std::span<const float> floats) {
  const auto bytes = std::as_bytes(floats);
  const auto width = static_cast<std::uint32_t>(bytes.size()) / kPointBytes;
  Ros1Bytes m = begun(stamp);
  m.put(std::uint32_t{1}).put(width).put(std::uint32_t{5});
  m.field("x", 0, kFloat32).field("y", 4, kFloat32).field("z", 8, kFloat32);
  m.field("intensity", 12, kFloat32).field("time", 16, kFloat32);
  m.put(std::uint8_t{0}).put(kPointBytes).put(width * kPointBytes);
  const auto* const data = reinterpret_cast<const std::uint8_t*>(bytes.data());
  m.array({data, data + bytes.size()}).put(std::uint8_t{1});
  return {"sensor_msgs/PointCloud2", m.bytes};
}

RawMessage inertial(RigTime stamp, const std::array<double, 6>& values) {
  Ros1Bytes m = begun(stamp);
  m.repeat(0.0, 13).put(values[0]).put(values[1]).put(values[2]).repeat(0.0, 9);
  m.put(values[3]).put(values[4]).put(values[5]).repeat(0.0, 9);
  return {"sensor_msgs/Imu", m.bytes};
}

class ImportedBag : public testing::Test {
 protected:
  // The hall's sweeps and readings.
  void write_hall(const fs::path& file) {
    BagFile bag(file);
    const fs::path scans = boxroom() / "moving" / "lidar0";
    const auto files = list_scan_files(scans);
    const auto times = read_seconds_file(scans / "times.txt");
    ASSERT_TRUE(files && times);
    ScanFileReader reader;
    Rejections none;
    for (const ScanFile& scan : *files) {
      const RigTime stamp = times->at(scan.number).value();
      bag.write("/points", stamp, cloud(stamp, reader.read(scan.path, 5, none).value()));
    }
    auto readings = CsvLog<6>::open(boxroom() / "moving" / "imu.csv");
    ASSERT_TRUE(readings);
    for (CsvLog<6>::Row row; readings->next(row);) bag.write("/imu", row.t, inertial(row.t, row.values));
  }
  Ended import(const std::string& options, const ProgramLimits& limits = {}) {
    return lxd_slam(fmt::format("import {} --rig {} --out {} {}", bag_.string(), rig_.string(), out_.string(), options),
                    limits);
  }
  void expect_refused(const Ended& ended, const std::string& words, int status = kBadInput) {
    EXPECT_EQ(ended.status, status) << ended.text;
    EXPECT_TRUE(ended.says(words)) << ended.text;
    EXPECT_FALSE(fs::exists(out_));
    for (const auto& entry : fs::directory_iterator(folder_.path()))
      EXPECT_EQ(entry.path().string().find(".part"), std::string::npos) << entry.path();
  }

  TemporaryFolder folder_;
  fs::path bag_ = folder_ / "hall.bag", out_ = folder_ / "recording", rig_ = boxroom() / "moving" / "rig.yaml";
};

// Points' times are whole nanoseconds on their way through a message; the floats of the hall's are not.
TEST_F(ImportedBag, ReplaysAsTheFolderThatItWasMadeOf) {
  write_hall(bag_);
  const Ended ended = import("");
  ASSERT_EQ(ended.status, 0) << ended.text;
  EXPECT_TRUE(ended.says("lidar0: 60 of 60 messages of /points")) << ended.text;
  const auto direct = replayed(boxroom() / "moving", folder_, "", "direct").path();
  const auto imported = replayed(out_, folder_, "", "imported").path();
  ASSERT_EQ(direct.size(), imported.size());
  ASSERT_FALSE(direct.empty());
  for (std::size_t i = 0; i < direct.size(); ++i) {
    EXPECT_EQ(direct[i].stamp, imported[i].stamp) << i;
    EXPECT_LT((direct[i].T.p - imported[i].T.p).norm(), kSame) << i;
    EXPECT_LT((direct[i].T.R - imported[i].T.R).norm(), kSame) << i;
  }
}

TEST_F(ImportedBag, ListsWhatItHolds) {
  write_hall(bag_);
  const Ended ended = lxd_slam(fmt::format("import {} --list", bag_.string()));
  ASSERT_EQ(ended.status, 0) << ended.text;
  EXPECT_TRUE(ended.says("60  sensor_msgs/PointCloud2") && ended.says("/points")) << ended.text;
  EXPECT_TRUE(ended.says("sensor_msgs/Imu") && ended.says("/imu")) << ended.text;
}

TEST_F(ImportedBag, ThatIsNoneOrIsCutOffIsRefused) {
  expect_refused(import(""), "hall.bag: found no such file");
  write_file(bag_, "no bag at all, whatever its name says");
  expect_refused(import(""), "hall.bag: cannot be read as a ROS 1 bag");
  write_hall(bag_);
  for (const std::uintmax_t part : {10U, 4U, 2U}) {
    fs::resize_file(bag_, fs::file_size(bag_) / part * (part - 1));
    expect_refused(import(""), "hall.bag: cannot be read as a ROS 1 bag");
  }
}

TEST_F(ImportedBag, ForADiskWithoutRoomOrATakenFolderLeavesNothingBehind) {
  write_hall(bag_);
  expect_refused(import("", {.file_bytes = 100'000}), "000000.bin: cannot be written", kFailed);
  fs::create_directories(out_);
  write_file(out_ / "thesis.tex", "x");
  const Ended ended = import("");
  EXPECT_EQ(ended.status, kBadInput);
  EXPECT_TRUE(ended.says("holds something else than an import")) << ended.text;
  EXPECT_TRUE(fs::exists(out_ / "thesis.tex"));
}

// Two LiDARs, a camera of each sort, a receiver and a truth; one point, one pixel, one place each.
void write_mixed(const fs::path& file) {
  BagFile bag(file);
  const RigTime t = RigTime::from_seconds(2000);
  const std::array<float, 10> points{1, 2, 3, 4, 0.01F, 5, 6, 7, 8, 0.0F};
  bag.write("/a/points", t, cloud(t, points));
  bag.write("/b/points", t, cloud(RigTime(), points));  // without a stamp
  Ros1Bytes picture = begun(t);
  picture.put(std::uint32_t{1}).put(std::uint32_t{2}).text("bgr8").put(std::uint8_t{0}).put(std::uint32_t{6});
  bag.write("/raw", t, {"sensor_msgs/Image", picture.array({255, 0, 0, 0, 0, 255}).bytes});
  Ros1Bytes jpeg = begun(t);
  bag.write("/jpeg", t, {"sensor_msgs/CompressedImage", jpeg.text("jpeg").array(made_jpeg(16, 8)).bytes});
  Ros1Bytes bayer = begun(t);
  bayer.put(std::uint32_t{1}).put(std::uint32_t{2}).text("bayer_rggb8").put(std::uint8_t{0}).put(std::uint32_t{2});
  bag.write("/bayer", t, {"sensor_msgs/Image", bayer.array({1, 2}).bytes});
  Ros1Bytes fix = begun(t);
  fix.put(std::int8_t{0}).put(std::uint16_t{1}).put(47.5).put(8.5).put(400.0).repeat(0.0, 9).put(std::uint8_t{0});
  bag.write("/fix", t, {"sensor_msgs/NavSatFix", fix.bytes});
  Ros1Bytes pose = begun(t);
  bag.write("/pose", t, {"geometry_msgs/PoseStamped", pose.put(1.0).put(2.0).put(3.0).repeat(0.0, 3).put(1.0).bytes});
}

class ImportedSensors : public ImportedBag {
 protected:
  void SetUp() override {
    write_mixed(bag_);
    rig_ = folder_ / "rig.yaml";
    write_file(rig_, "lidar0: {model: spinning}\ncamera0: {resolution: [16, 8], intrinsics: [9, 9, 8, 4]}\ngnss: {}\n");
  }
};

TEST_F(ImportedSensors, OfSeveralThatFitAreAskedFor) {
  expect_refused(import(""), "/a/points (sensor_msgs/PointCloud2), /b/points");
  expect_refused(import("--topic lidar0=/a/points"), "choose one by --topic camera0=");
  expect_refused(import("--topic lidar0=/a/points --topic camera0=/bayer"), "bayer_rggb8", kFailed);
}

TEST_F(ImportedSensors, AreWhereTheirReadersLookForThem) {
  const Ended ended = import("--topic lidar0=/a/points --topic camera0=/raw --topic truth=/pose");
  ASSERT_EQ(ended.status, 0) << ended.text;
  EXPECT_EQ(read_file(out_ / "lidar0" / "times.txt"), "2000.000000000\n");
  EXPECT_EQ(read_file(out_ / "camera0" / "times.txt"), "2000.000000000\n");
  ColourPixels image;
  ASSERT_TRUE(read_image(out_ / "camera0" / "000000.png", image));
  EXPECT_EQ(image.data, (std::vector<std::uint8_t>{255, 0, 0, 0, 0, 255}));
  EXPECT_TRUE(read_file(out_ / "gnss.nmea").starts_with("2000.000000000 $GNGGA,003320.000,4730.00000000,N,00830."));
  EXPECT_TRUE(read_file(out_ / "truth.tum").starts_with("2000.000000000 1.000000000 2.000000000 3.0000"));
  EXPECT_EQ(read_file(out_ / "rig.yaml"), read_file(rig_));
}

TEST_F(ImportedSensors, CompressedImagesStayAsTheyCame) {
  const Ended ended = import("--topic lidar0=/b/points --topic camera0=/jpeg");
  ASSERT_EQ(ended.status, 0) << ended.text;
  const auto jpeg = made_jpeg(16, 8);
  EXPECT_EQ(read_file(out_ / "camera0" / "000000.jpg"), std::string(jpeg.begin(), jpeg.end()));
  EXPECT_TRUE(ended.says("1 have no stamp in their header")) << ended.text;
  EXPECT_EQ(read_file(out_ / "lidar0" / "times.txt"), "2000.000000000\n");
}

}  // namespace
}  // namespace lxd::test::imported_bag_test

#else

TEST(ImportedBag, NeedsTheRosbagStorageLibrary) {
  GTEST_SKIP() << "librosbag-storage-dev was not there when this was built";
}

#endif
