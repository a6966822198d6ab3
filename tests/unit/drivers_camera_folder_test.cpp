// SPDX-License-Identifier: Apache-2.0
// Images from folders: rig recordings, KITTI's layouts, and what is missing or broken in them.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <jpeglib.h>

#include "drivers/replay/camera_folder.hpp"
#include "tests/support/data_folders.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/recording/png_writer.hpp"

namespace lxd::drivers_camera_folder_test {
namespace {

using test::TemporaryFolder;
using test::write_file;

class CameraFolderTest : public testing::Test {
 protected:
  // 7 x 5 pixels of one value and its neighbours.
  static void write_image(const std::filesystem::path& path, std::uint8_t value, int channels = 1) {
    PixelImage image{7, 5, channels, std::vector<std::uint8_t>(static_cast<std::size_t>(35 * channels), value)};
    image.data[0] = static_cast<std::uint8_t>(value + 1);
    ASSERT_TRUE(write_png(path, image));
  }
  static CameraFolder opened(const std::filesystem::path& path) {
    auto camera = CameraFolder::open(path);
    EXPECT_TRUE(camera.ok()) << camera.error().message;
    return std::move(*camera);
  }
  static std::vector<std::uint32_t> numbers(CameraFolder& camera) {
    std::vector<std::uint32_t> out;
    CameraImage image;
    while (camera.next(image)) out.push_back(image.number);
    return out;
  }

  TemporaryFolder folder;
};

TEST_F(CameraFolderTest, ReadsARigRecordingsImagesInOrder) {
  write_file(folder / "times.txt", "10.5\n10.6\n");
  write_file(folder / "frames.csv",
             "image,sequence,exposure_begin_s,exposure_s,gain,received_s,corrupt\n"
             "000000.png,4,10.5,0.008,1.0,10.52,0\n000001.png,5,10.6,oops,1.0,10.62,0\n");
  write_image(folder / "000000.png", 40);
  write_image(folder / "000001.png", 90);
  CameraFolder camera = opened(folder.path() / "");
  EXPECT_EQ(camera.kind(), "camera-folder");
  EXPECT_EQ(camera.size(), 2U);
  CameraImage image;
  ASSERT_TRUE(camera.next(image));
  EXPECT_EQ(image.stamp, RigTime::from_ns(10'500'000'000));
  EXPECT_EQ(image.exposure, Duration::from_ns(8'000'000));
  EXPECT_EQ(image.received, RigTime::from_ns(10'520'000'000));
  ASSERT_EQ(image.pixels.width, 7U);
  ASSERT_EQ(image.pixels.height, 5U);
  EXPECT_EQ(image.pixels.data[0], 41);
  EXPECT_EQ(image.pixels.data[34], 40);
  ASSERT_TRUE(camera.next(image));
  EXPECT_EQ(image.pixels.data[34], 90);
  EXPECT_EQ(image.exposure, Duration());
  EXPECT_FALSE(camera.next(image));
  EXPECT_TRUE(camera.rejected().empty());
}

TEST_F(CameraFolderTest, ColourBecomesGrey) {
  write_file(folder / "times.txt", "1\n");
  write_image(folder / "000000.png", 120, 3);
  CameraFolder camera = opened(folder.path());
  CameraImage image;
  ASSERT_TRUE(camera.next(image));
  EXPECT_EQ(image.pixels.data.size(), 35U);
  EXPECT_EQ(image.pixels.data[34], 120);
}

// Missing files, cut ones, garbage, an empty one, lines without a time, times that go back, images without a time.
TEST_F(CameraFolderTest, WhatIsDamagedIsCountedAndPassedOver) {
  write_file(folder / "times.txt", "1\n2\n3\n\n5\n4\n5\n6\n");
  for (int i = 0; i < 10; ++i)
    if (i != 1) write_image(folder / ("00000" + std::to_string(i) + ".png"), 50);
  std::filesystem::resize_file(folder / "000002.png", 50);
  write_file(folder / "000000.png", "no image");
  write_file(folder / "notes.txt", "");
  write_file(folder / "last.png", "");
  CameraFolder camera = opened(folder.path());
  EXPECT_EQ(numbers(camera), (std::vector<std::uint32_t>{4, 7}));
  const Rejections expected{{"missing_image", 1},  {"broken_image", 2},  {"time_missing", 1},
                            {"time_backwards", 1}, {"time_repeated", 1}, {"image_without_time", 2}};
  EXPECT_EQ(camera.rejected(), expected);
}

// A camera's JPEG of 24 x 16 pixels, grey, 128 but for one dark half, as libjpeg writes it.
std::string small_jpeg() {
  std::vector<std::uint8_t> row(24, 128), pixels;
  std::fill(row.begin(), row.begin() + 8, std::uint8_t{20});
  jpeg_compress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* memory = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&jpeg, &memory, &size);
  jpeg.image_width = 24;
  jpeg.image_height = 16;
  jpeg.input_components = 1;
  jpeg.in_color_space = JCS_GRAYSCALE;
  jpeg_set_defaults(&jpeg);
  jpeg_start_compress(&jpeg, TRUE);
  JSAMPROW line = row.data();
  while (jpeg.next_scanline < jpeg.image_height) jpeg_write_scanlines(&jpeg, &line, 1);
  jpeg_finish_compress(&jpeg);
  jpeg_destroy_compress(&jpeg);
  std::string out(reinterpret_cast<char*>(memory), size);
  std::free(memory);  // NOLINT(cppcoreguidelines-no-malloc): libjpeg allocates it so
  return out;
}

TEST_F(CameraFolderTest, ReadsJpegToo) {
  write_file(folder / "times.txt", "1\n2\n3\n");
  const std::string whole = small_jpeg();
  write_file(folder / "000000.jpg", whole);
  write_file(folder / "000001.jpg", whole.substr(0, whole.size() - 20));
  write_file(folder / "000002.jpg", "\xFF\xD8\xFF");
  CameraFolder camera = opened(folder.path());
  CameraImage image;
  ASSERT_TRUE(camera.next(image));
  EXPECT_EQ(image.pixels.width, 24U);
  EXPECT_NEAR(image.pixels.data[0], 20, 3);
  EXPECT_NEAR(image.pixels.data[24 * 16 - 1], 128, 3);
  EXPECT_FALSE(camera.next(image));
  EXPECT_EQ(camera.rejected().at("broken_image"), 2U);
}

// Every truncation of a small image, and a flipped bit in each of its bytes: read or refused, never more than it says.
TEST_F(CameraFolderTest, DamagedImagesAreReadOrRefused) {
  write_image(folder / "whole.png", 77);
  const std::string whole = test::read_file(folder / "whole.png");
  GreyPixels pixels;
  for (std::size_t length = 0; length + 12 < whole.size(); ++length) {
    write_file(folder / "cut.png", whole.substr(0, length));
    EXPECT_FALSE(read_image(folder / "cut.png", pixels)) << length;
  }
  for (std::size_t byte = 0; byte < whole.size(); ++byte) {
    std::string flipped = whole;
    flipped[byte] = static_cast<char>(flipped[byte] ^ (1 << byte % 8));
    write_file(folder / "flipped.png", flipped);
    EXPECT_TRUE(!read_image(folder / "flipped.png", pixels) ||
                pixels.data.size() == std::size_t{pixels.width} * pixels.height);
  }
}

TEST_F(CameraFolderTest, ReadsKittiRaw) {
  const auto images = folder / "image_00/data";
  std::filesystem::create_directories(images);
  std::filesystem::create_directories(folder / "velodyne_points");
  write_file(folder / "velodyne_points/timestamps.txt",
             "2011-09-26 13:04:32.000000000\n2011-09-26 13:04:32.100000000\n");
  write_file(folder / "image_00/timestamps.txt", "2011-09-26 13:04:32.010000000\n2011-09-26 13:04:32.110000000\n");
  write_image(images / "0000000000.png", 10);
  write_image(images / "0000000001.png", 20);
  CameraFolder camera = opened(folder / "image_00");
  EXPECT_EQ(camera.kind(), "kitti-raw");
  CameraImage image;
  ASSERT_TRUE(camera.next(image) && camera.next(image));
  EXPECT_EQ(image.stamp, RigTime::from_ns(110'000'000));
  EXPECT_EQ(image.pixels.data[34], 20);
}

TEST_F(CameraFolderTest, ReadsKittiOdometry) {
  std::filesystem::create_directories(folder / "image_0");
  write_file(folder / "times.txt", "0.000000e+00\n1.037e-01\n");
  write_image(folder / "image_0/000001.png", 30);
  CameraFolder camera = opened(folder / "image_0");
  EXPECT_EQ(camera.kind(), "kitti-odometry");
  CameraImage image;
  ASSERT_TRUE(camera.next(image));
  EXPECT_EQ(image.stamp, RigTime::from_ns(103'700'000));
  EXPECT_EQ(camera.rejected().at("missing_image"), 1U);
}

// The drive that others publish, when it is there: every image is read.
TEST_F(CameraFolderTest, ReadsARealDrive) {
  const auto images = test::shared_data("kitti_0005/image_02");
  if (!images) GTEST_SKIP() << "LXD_SHARED_DATA has no kitti_0005/image_02";
  CameraFolder camera = opened(*images);
  CameraImage image;
  RigTime last = RigTime::from_seconds(-1);
  int count = 0;
  for (; camera.next(image); ++count, last = image.stamp) {
    EXPECT_EQ(image.pixels.width, 1242U);
    EXPECT_GT(image.stamp, last);
  }
  EXPECT_EQ(count, 154);
  EXPECT_TRUE(camera.rejected().empty());
}

TEST_F(CameraFolderTest, WhatIsNoCameraIsAnErrorThatNamesIt) {
  const auto nothing = CameraFolder::open(folder / "camera0");
  ASSERT_FALSE(nothing);
  EXPECT_NE(nothing.error().message.find("times.txt"), std::string::npos);
  std::filesystem::create_directories(folder / "camera1");
  write_file(folder / "camera1/times.txt", "1\n");
  const auto empty = CameraFolder::open(folder / "camera1");
  ASSERT_FALSE(empty);
  EXPECT_NE(empty.error().message.find("000000.png"), std::string::npos);
  write_file(folder / "camera1/times.txt", "1\nsoon\n");
  const auto garbage = CameraFolder::open(folder / "camera1");
  ASSERT_FALSE(garbage);
  EXPECT_NE(garbage.error().message.find("line 2"), std::string::npos);
}

}  // namespace
}  // namespace lxd::drivers_camera_folder_test
