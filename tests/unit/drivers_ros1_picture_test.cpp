// SPDX-License-Identifier: Apache-2.0
// ROS 1 messages of cameras, by bytes put together by hand.
#include "drivers/ros1/picture.hpp"
#include "tests/support/ros1_bytes.hpp"

namespace lxd::drivers_ros1_picture_test {
namespace {

using test::Ros1Bytes;

// 2 x 2 pixels whose bytes count up, a gap of one byte behind each row.
std::vector<std::uint8_t> picture(std::string_view encoding, std::uint32_t channels) {
  const std::uint32_t row_bytes = 2 * channels + 1;
  std::vector<std::uint8_t> data;
  for (std::uint32_t i = 0; i < 2 * row_bytes; ++i) data.push_back(static_cast<std::uint8_t>(i));
  Ros1Bytes m;
  m.header(1, 2).put(std::uint32_t{2}).put(std::uint32_t{2}).text(encoding).put(std::uint8_t{0}).put(row_bytes);
  return m.array(data).bytes;
}

TEST(Ros1Picture, OfTheKnownEncodingsHasItsRows) {
  const auto grey = picture("mono8", 1), coloured = picture("bgr8", 3);
  Ros1Picture out;
  ASSERT_EQ(read_ros1_picture(grey, out), Ros1Fault::none);
  EXPECT_EQ(out.channels, 1U);
  EXPECT_EQ(out.row(1)[0], 3);
  EXPECT_EQ(out.row(1).size(), 2U);
  ASSERT_EQ(read_ros1_picture(coloured, out), Ros1Fault::none);
  EXPECT_TRUE(out.blue_first);
  EXPECT_EQ(out.row(1).size(), 6U);
  EXPECT_EQ(read_ros1_picture(picture("8UC1", 1), out), Ros1Fault::none);
  ASSERT_EQ(read_ros1_picture(picture("rgb8", 3), out), Ros1Fault::none);
  EXPECT_FALSE(out.blue_first);
}

TEST(Ros1Picture, OfAnotherEncodingIsRefusedAndNamed) {
  const auto bytes = picture("bayer_rggb8", 1);
  Ros1Picture out;
  EXPECT_EQ(read_ros1_picture(bytes, out), Ros1Fault::unknown_encoding);
  EXPECT_EQ(out.encoding, "bayer_rggb8");
}

TEST(Ros1Picture, WithFewerPixelsThanItSaysIsRefused) {
  Ros1Picture out;
  EXPECT_EQ(read_ros1_picture(picture("rgb8", 1), out), Ros1Fault::bad_layout);
}

TEST(Ros1Picture, CutOffOrDamagedIsToldOrStood) {
  test::expect_told_when_cut(read_ros1_picture, picture("bgr8", 3));
  test::expect_to_stand_every_bit(read_ros1_picture, picture("bgr8", 3), [](const Ros1Picture& out) {
    unsigned sum = 0;
    for (std::uint32_t y = 0; y < out.height; ++y)
      for (const std::uint8_t byte : out.row(y)) sum += byte;
    EXPECT_LT(sum, 100'000U);
  });
}

std::vector<std::uint8_t> compressed(const std::vector<std::uint8_t>& data) {
  Ros1Bytes m;
  return m.header(1, 2).text("jpeg").array(data).bytes;
}

TEST(Ros1CompressedPicture, IsWhatItsFirstBytesSay) {
  Ros1CompressedPicture out;
  const auto jpeg = compressed({0xFF, 0xD8, 0xFF, 0xE0}), png = compressed({0x89, 'P', 'N', 'G'});
  ASSERT_EQ(read_ros1_compressed_picture(jpeg, out), Ros1Fault::none);
  EXPECT_EQ(out.compression, Ros1Compression::jpeg);
  ASSERT_EQ(read_ros1_compressed_picture(png, out), Ros1Fault::none);
  EXPECT_EQ(out.compression, Ros1Compression::png);
  EXPECT_EQ(read_ros1_compressed_picture(compressed({1, 2, 3}), out), Ros1Fault::unknown_encoding);
  EXPECT_EQ(read_ros1_compressed_picture(compressed({}), out), Ros1Fault::empty);
}

TEST(Ros1CompressedPicture, CutOffOrDamagedIsToldOrStood) {
  const auto jpeg = compressed({0xFF, 0xD8, 0xFF, 0xE0});
  test::expect_told_when_cut(read_ros1_compressed_picture, jpeg);
  test::expect_to_stand_every_bit(read_ros1_compressed_picture, jpeg,
                                  [](const Ros1CompressedPicture& out) { EXPECT_EQ(out.data.size(), 4U); });
}

}  // namespace
}  // namespace lxd::drivers_ros1_picture_test
