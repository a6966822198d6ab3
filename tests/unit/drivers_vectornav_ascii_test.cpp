// SPDX-License-Identifier: Apache-2.0
// What only VectorNav's lines have: several sentences, two checks, replies and errors between samples.
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "drivers/imu/crc16.hpp"
#include "drivers/imu/vectornav_ascii_parser.hpp"
#include "tests/support/serial_stream.hpp"
#include "tools/simulator/imu/vectornav_ascii_encoder.hpp"

namespace lxd::drivers_vectornav_ascii_test {
namespace {

using sim::vectornav_line;
using test::Bytes;

constexpr double kBaud = 115200;

Bytes bytes_of_text(std::string_view text) { return {text.begin(), text.end()}; }

std::vector<ImuSample> samples_of_body(VectorNavAsciiParser& parser, std::string_view body) {
  return test::samples_of(parser, vectornav_line(body));
}

TEST(VectorNavLines, TheProtocolsReadRequestIsSoundAndNoSample) {
  EXPECT_EQ(vectornav_line("VNRRG,01"), bytes_of_text("$VNRRG,01*72\r\n"));
  VectorNavAsciiParser parser(kBaud);
  EXPECT_TRUE(samples_of_body(parser, "VNRRG,01").empty());
  EXPECT_EQ(parser.counts().no_imu_fields, 1U);
  EXPECT_TRUE(samples_of_body(parser, "VNERR,03").empty());
  EXPECT_EQ(parser.counts().sensor_error, 1U);
  EXPECT_EQ(parser.counts().bytes_skipped, 0U);
}

TEST(VectorNavLines, EverySentenceSaysWhereItsVectorsAre) {
  for (const std::string_view body :
       {"VNIMU,0,0,0,1,2,3,4,5,6,25.0,101.3", "VNMAR,0,0,0,1,2,3,4,5,6", "VNYMR,9,9,9,0,0,0,1,2,3,4,5,6",
        "VNQMR,9,9,9,9,0,0,0,1,2,3,4,5,6", "VNMAR,0,0,0,1,2,3,4,5,6,T0123456789"}) {
    VectorNavAsciiParser parser(kBaud);
    const auto samples = samples_of_body(parser, body);
    ASSERT_EQ(samples.size(), 1U) << body;
    EXPECT_EQ(samples[0].accel_mps2, Eigen::Vector3d(1, 2, 3)) << body;
    EXPECT_EQ(samples[0].gyro_radps, Eigen::Vector3d(4, 5, 6)) << body;
    EXPECT_EQ(samples[0].sensor_ns, std::nullopt);
  }
}

TEST(VectorNavLines, TheCrcOfFourDigitsIsACheckToo) {
  const std::string body = "VNMAR,0,0,0,1,2,3,4,5,6";
  const unsigned crc = crc16(bytes_of_text(body));
  VectorNavAsciiParser parser(kBaud);
  EXPECT_EQ(test::samples_of(parser, bytes_of_text(fmt::format("${}*{:04X}\r\n", body, crc))).size(), 1U);
  EXPECT_TRUE(test::samples_of(parser, bytes_of_text(fmt::format("${}*{:04X}\r\n", body, crc ^ 1U))).empty());
  EXPECT_EQ(parser.counts().bad_checksum, 1U);
}

TEST(VectorNavLines, FieldsThatAreNoNumbersAreCounted) {
  for (const std::string_view body :
       {"VNMAR,0,0,0,1,2,3,4,5", "VNMAR,0,0,0,1,2,3,4,5,", "VNMAR,0,0,0,1,2,3,4,5,nan", "VNMAR,0,0,0,1,2,3,4,5,1e3",
        "VNMAR,0,0,0,1,2,3,4,5,--6", "VNMAR", "VNMAR,0,0,0,1,2,3,4,5,6-"}) {
    VectorNavAsciiParser parser(kBaud);
    EXPECT_TRUE(samples_of_body(parser, body).empty()) << body;
    EXPECT_EQ(parser.counts().bad_field, 1U) << body;
    EXPECT_EQ(parser.counts().bytes_skipped, 0U);
  }
}

TEST(VectorNavLines, ALineThatEndsWrongOrNeverIsRefused) {
  for (const std::string_view text :
       {"$VNRRG,01\r\n", "$VNRRG,01*72\n", "$VNRRG,01*7\r\n", "$VNRRG,01*072\r\n", "$\n", "$*\r\n"}) {
    VectorNavAsciiParser parser(kBaud);
    EXPECT_TRUE(test::samples_of(parser, bytes_of_text(text)).empty());
    EXPECT_EQ(parser.counts().broken_line, 1U) << text;
    EXPECT_EQ(parser.bytes_pending(), 0U);
  }
  VectorNavAsciiParser parser(kBaud);
  Bytes endless(kVectorNavLineMax, 'x');
  endless[0] = '$';
  EXPECT_TRUE(test::samples_of(parser, endless).empty());
  EXPECT_EQ(parser.counts().too_long, 1U);
  EXPECT_EQ(parser.bytes_pending(), 0U);
}

TEST(VectorNavLines, ANewLineEndsABrokenOne) {
  VectorNavAsciiParser parser(kBaud);
  Bytes stream = bytes_of_text("$VNMAR,0,0");
  test::append(stream, vectornav_line("VNMAR,0,0,0,1,2,3,4,5,6"));
  EXPECT_EQ(test::samples_of(parser, stream).size(), 1U);
  EXPECT_EQ(parser.counts().broken_line, 1U);
}

}  // namespace
}  // namespace lxd::drivers_vectornav_ascii_test
