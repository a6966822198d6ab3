// SPDX-License-Identifier: Apache-2.0
// Frames of a camera into images: golden pixels of each format, gaps between lines, damage.
#include <gtest/gtest.h>

#include "drivers/camera/pixel_format.hpp"
#include "rt/allocation_guard.hpp"
#include "tests/support/made_jpeg.hpp"

namespace lxd::drivers_pixel_format_test {
namespace {

using Bytes = std::vector<std::uint8_t>;

PixelConverter must_create(const FrameLayout& layout) {
  auto converter = PixelConverter::create(layout);
  EXPECT_TRUE(converter.ok()) << converter.error().message;
  return *converter;
}

void expect_bgr(std::span<const std::uint8_t> pixel, int blue, int green, int red, int tolerance) {
  EXPECT_NEAR(pixel[0], blue, tolerance);
  EXPECT_NEAR(pixel[1], green, tolerance);
  EXPECT_NEAR(pixel[2], red, tolerance);
}

TEST(PixelFormats, AreFoundByTheirFourCharacters) {
  EXPECT_EQ(find_pixel_format(0x56595559), PixelFormat::yuyv);  // V4L2_PIX_FMT_YUYV
  EXPECT_EQ(find_pixel_format(fourcc("GREY")), PixelFormat::grey);
  EXPECT_EQ(find_pixel_format(fourcc("RGB3")), PixelFormat::rgb);
  EXPECT_EQ(find_pixel_format(fourcc("MJPG")), PixelFormat::mjpeg);
  EXPECT_EQ(find_pixel_format(fourcc("H264")), std::nullopt);
}

// Black, white and the three colours of a colour bar at full saturation, in BT.601's limited range.
TEST(PixelFormats, YuyvIsBt601) {
  struct Colour {
    std::uint8_t y, u, v;
    int blue, green, red;
  };
  for (const Colour& c :
       {Colour{16, 128, 128, 0, 0, 0}, Colour{235, 128, 128, 255, 255, 255}, Colour{81, 90, 240, 0, 0, 255},
        Colour{145, 54, 34, 0, 255, 0}, Colour{41, 240, 110, 255, 0, 0}}) {
    PixelConverter converter = must_create({PixelFormat::yuyv, 2, 1});
    const Bytes frame{c.y, c.u, c.y, c.v};
    Bytes grey(2), bgr(6);
    ASSERT_TRUE(converter.to_grey(frame, grey));
    ASSERT_TRUE(converter.to_bgr(frame, bgr));
    EXPECT_EQ(grey, (Bytes{c.y, c.y}));
    expect_bgr(std::span(bgr).first(3), c.blue, c.green, c.red, 2);
    expect_bgr(std::span(bgr).last(3), c.blue, c.green, c.red, 2);
  }
}

TEST(PixelFormats, GreyAndRgbAreTakenAsTheyAre) {
  PixelConverter grey = must_create({PixelFormat::grey, 2, 1});
  Bytes image(2), colours(6);
  ASSERT_TRUE(grey.to_grey(Bytes{7, 200}, image));
  EXPECT_EQ(image, (Bytes{7, 200}));
  ASSERT_TRUE(grey.to_bgr(Bytes{7, 200}, colours));
  EXPECT_EQ(colours, (Bytes{7, 7, 7, 200, 200, 200}));
  PixelConverter rgb = must_create({PixelFormat::rgb, 2, 1});
  ASSERT_TRUE(rgb.to_bgr(Bytes{1, 2, 3, 4, 5, 6}, colours));
  EXPECT_EQ(colours, (Bytes{3, 2, 1, 6, 5, 4}));
  ASSERT_TRUE(rgb.to_grey(Bytes{255, 255, 255, 0, 255, 0}, image));
  EXPECT_EQ(image, (Bytes{255, 149}));
}

TEST(PixelFormats, GapsBetweenLinesArePassedOver) {
  PixelConverter converter = must_create({PixelFormat::grey, 2, 2, 5});
  Bytes image(4);
  ASSERT_TRUE(converter.to_grey(Bytes{1, 2, 9, 9, 9, 3, 4, 9, 9, 9}, image));
  EXPECT_EQ(image, (Bytes{1, 2, 3, 4}));
  ASSERT_TRUE(converter.to_grey(Bytes{1, 2, 9, 9, 9, 3, 4}, image));  // the last line's gap may be missing
}

TEST(PixelFormats, ShorterFramesAndOtherImagesAreRefused) {
  for (const FrameLayout& layout : {FrameLayout{PixelFormat::grey, 6, 4}, FrameLayout{PixelFormat::yuyv, 6, 4, 16},
                                    FrameLayout{PixelFormat::rgb, 6, 4}}) {
    PixelConverter converter = must_create(layout);
    Bytes image(converter.bgr_bytes());
    const std::size_t line = converter.layout().bytes_per_line;
    const std::size_t whole = 3 * line + 6 * (layout.format == PixelFormat::rgb    ? 3
                                              : layout.format == PixelFormat::yuyv ? 2
                                                                                   : 1);
    for (std::size_t size = 0; size < whole; ++size) EXPECT_FALSE(converter.to_bgr(Bytes(size), image)) << size;
    EXPECT_EQ(converter.counts().bad_size, whole);
    EXPECT_TRUE(converter.to_bgr(Bytes(whole), image));
    EXPECT_FALSE(converter.to_grey(Bytes(whole), image));
    EXPECT_EQ(converter.counts().no_room, 1U);
  }
}

TEST(PixelFormats, LayoutsThatNoFrameHasAreErrors) {
  const auto error = [](const FrameLayout& layout) {
    const auto converter = PixelConverter::create(layout);
    return converter.ok() ? std::string() : converter.error().message;
  };
  EXPECT_NE(error({PixelFormat::grey, 0, 4}).find("found 0 x 4 pixels"), std::string::npos);
  EXPECT_NE(error({PixelFormat::grey, 4, 20'000}).find("wanted 1 to 16384"), std::string::npos);
  EXPECT_NE(error({PixelFormat::yuyv, 5, 4}).find("wanted an even one"), std::string::npos);
  EXPECT_NE(error({PixelFormat::rgb, 4, 4, 11}).find("found 11 bytes a line, wanted at least 12"), std::string::npos);
  EXPECT_TRUE(error({PixelFormat::mjpeg, 5, 4}).empty());
}

TEST(PixelFormats, NothingIsAllocatedForRawFrames) {
  PixelConverter converter = must_create({PixelFormat::yuyv, 64, 48});
  const Bytes frame(64 * 48 * 2);
  Bytes image(converter.bgr_bytes());
  const AllocationGuard guard;
  EXPECT_TRUE(converter.to_bgr(frame, image));
  EXPECT_EQ(guard.count(), 0U);
}

class MotionJpeg : public testing::Test {
 protected:
  static constexpr std::uint32_t kWidth = 48, kHeight = 32;
  PixelConverter converter_ = must_create({PixelFormat::mjpeg, kWidth, kHeight});
  Bytes grey_ = Bytes(converter_.grey_bytes()), bgr_ = Bytes(converter_.bgr_bytes());
};

TEST_F(MotionJpeg, ColoursAreThoseOfTheImage) {
  ASSERT_TRUE(converter_.to_bgr(test::made_jpeg(kWidth, kHeight), bgr_));
  for (const std::size_t x : {4U, 20U, 40U}) {
    for (const std::size_t y : {4U, 25U}) {
      const auto pixel = std::span(bgr_).subspan(3 * (y * kWidth + x), 3);
      expect_bgr(pixel, 64, static_cast<int>(4 * y), static_cast<int>(4 * x), 14);
    }
  }
  ASSERT_TRUE(converter_.to_grey(test::made_jpeg(kWidth, kHeight), grey_));
  EXPECT_NEAR(grey_[25 * kWidth + 40], 0.299 * 160 + 0.587 * 100 + 0.114 * 64, 6);
}

TEST_F(MotionJpeg, GreyImagesMayBeWantedInColour) {
  ASSERT_TRUE(converter_.to_bgr(test::made_jpeg(kWidth, kHeight, {false, false}), bgr_));
  expect_bgr(std::span(bgr_).subspan(3 * (20 * kWidth + 20), 3), 80, 80, 80, 6);
}

// As USB cameras send them: without the tables, which are the standard's.
TEST_F(MotionJpeg, ImagesWithoutHuffmanTablesAreRead) {
  Bytes jpeg = test::made_jpeg(kWidth, kHeight), stripped(jpeg.begin(), jpeg.begin() + 2);
  std::size_t at = 2, tables = 0;
  while (jpeg[at + 1] != 0xDA) {
    const std::size_t bytes = 2 + (std::size_t{jpeg[at + 2]} << 8U) + jpeg[at + 3];
    if (jpeg[at + 1] != 0xC4) {
      stripped.insert(stripped.end(), jpeg.begin() + static_cast<std::ptrdiff_t>(at),
                      jpeg.begin() + static_cast<std::ptrdiff_t>(at + bytes));
    } else {
      ++tables;
    }
    at += bytes;
  }
  stripped.insert(stripped.end(), jpeg.begin() + static_cast<std::ptrdiff_t>(at), jpeg.end());
  EXPECT_EQ(tables, 4U);
  Bytes wanted = grey_;
  ASSERT_TRUE(converter_.to_grey(jpeg, wanted));
  ASSERT_TRUE(converter_.to_grey(stripped, grey_));
  EXPECT_EQ(grey_, wanted);
}

TEST_F(MotionJpeg, AnyTruncationIsRefused) {
  const Bytes jpeg = test::made_jpeg(kWidth, kHeight);
  for (std::size_t size = 0; size < jpeg.size(); ++size) {
    EXPECT_FALSE(converter_.to_bgr(Bytes(jpeg.begin(), jpeg.begin() + static_cast<std::ptrdiff_t>(size)), bgr_))
        << size;
  }
  EXPECT_EQ(converter_.counts().bad_jpeg + converter_.counts().other_size, jpeg.size());
}

// JPEG has no check value: a flipped bit may give another image, but never more than one, nor beyond its bytes.
TEST_F(MotionJpeg, AnySingleBitFlipIsCountedOnce) {
  Bytes jpeg = test::made_jpeg(kWidth, kHeight);
  std::uint64_t flips = 0;
  for (std::size_t bit = 0; bit < jpeg.size() * 8; bit += 3, ++flips) {
    jpeg[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
    (void)converter_.to_bgr(Bytes(jpeg), bgr_);
    jpeg[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
  }
  const PixelCounts& c = converter_.counts();
  EXPECT_EQ(c.frames + c.bad_jpeg + c.other_size, flips);
  EXPECT_GT(c.bad_jpeg, flips / 10);
}

TEST_F(MotionJpeg, OtherSizesAndSortsAreRefused) {
  EXPECT_FALSE(converter_.to_bgr(test::made_jpeg(kWidth, kHeight + 1), bgr_));
  EXPECT_FALSE(converter_.to_bgr(test::made_jpeg(kHeight, kWidth), bgr_));
  EXPECT_EQ(converter_.counts().other_size, 2U);
  EXPECT_FALSE(converter_.to_bgr(test::made_jpeg(kWidth, kHeight, {true, true}), bgr_));
  EXPECT_EQ(converter_.counts().bad_jpeg, 1U);
}

}  // namespace
}  // namespace lxd::drivers_pixel_format_test
