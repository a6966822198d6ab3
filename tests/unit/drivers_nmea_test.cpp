// SPDX-License-Identifier: Apache-2.0
// NMEA 0183, line by line: golden lines, and everything damaged.
#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/data_folders.hpp"
#include "tests/support/nmea_text.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/simulator/random.hpp"

namespace lxd::drivers_nmea_test {
namespace {

using test::bytes;
using test::fixes_of;
using test::sentence;

// The checksums of these four were verified independently.
const std::string kRmc = "$GPRMC,210230,A,3855.4487,N,09446.0071,W,0.0,076.2,130495,003.8,E*69\r\n";
const std::string kGga =
    "$GPGGA,132820.60,4134.49821229,N,09345.03351845,W,2,09,1.0,278.020,M,-31.442,M,7.6,0133*7E\r\n";
const std::string kGst = "$GPGST,024603.00,3.2,6.6,4.7,47.3,5.8,5.6,22.0*58\r\n";
const std::string kEmptyGga = "$GPGGA,,,,,,0,,,,,,,,*66\r\n";

GnssFix one_fix(const std::string& text) {
  NmeaParser parser;
  const auto fixes = fixes_of(parser, text);
  EXPECT_EQ(fixes.size(), 1U) << text;
  return fixes.empty() ? GnssFix{} : fixes.front();
}

TEST(NmeaSentences, GoldenRmc) {
  const GnssFix fix = one_fix(kRmc);
  EXPECT_NEAR(fix.latitude_deg.value(), 38.924145, 1e-9);
  EXPECT_NEAR(fix.longitude_deg.value(), -94.766785, 1e-9);
  EXPECT_TRUE(fix.has_position());
  EXPECT_NEAR(fix.course_rad.value(), 76.2 * std::numbers::pi / 180, 1e-12);
  EXPECT_EQ(fix.utc_ns.value(), 797'806'950 * kNanosPerSecond);  // date -u -d '1995-04-13 21:02:30' +%s
  EXPECT_FALSE(fix.altitude_msl_m);
}

TEST(NmeaSentences, GoldenGga) {
  const GnssFix fix = one_fix(kGga);
  EXPECT_NEAR(fix.latitude_deg.value(), 41 + 34.49821229 / 60, 1e-12);
  EXPECT_NEAR(fix.longitude_deg.value(), -(93 + 45.03351845 / 60), 1e-12);
  EXPECT_EQ(fix.quality, GnssQuality::differential);
  EXPECT_EQ(fix.satellites.value(), 9U);
  EXPECT_NEAR(fix.ellipsoid_height_m().value(), 278.020 - 31.442, 1e-9);
  EXPECT_EQ(fix.time_of_day_ns, (13 * 3600 + 28 * 60 + 20) * kNanosPerSecond + 600'000'000);
  EXPECT_FALSE(fix.utc_ns) << "no sentence has said the date";
}

TEST(NmeaSentences, GoldenGst) {
  const GnssFix fix = one_fix(kGst);
  EXPECT_EQ(fix.sigma_latitude_m, 5.8);
  EXPECT_EQ(fix.sigma_longitude_m, 5.6);
  EXPECT_EQ(fix.sigma_altitude_m, 22.0);
  EXPECT_FALSE(fix.has_position());
}

TEST(NmeaSentences, EmptyFieldsAreUnknown) {
  NmeaParser parser;
  EXPECT_TRUE(fixes_of(parser, kEmptyGga).empty());
  EXPECT_EQ(parser.counts().no_time, 1U);
  const GnssFix fix = one_fix(sentence("GNGGA,101112.00,,,,,0,00,99.99,,,,,,") + sentence("GNGST,101112.00,,,,,,,"));
  EXPECT_FALSE(fix.has_position());
  EXPECT_FALSE(fix.latitude_deg || fix.longitude_deg || fix.altitude_msl_m || fix.sigma_latitude_m);
  EXPECT_EQ(fix.satellites, 0U);
}

TEST(NmeaSentences, GsaGivesDops) {
  const std::string gga = sentence("GPGGA,101112.00,4134.0,N,09345.0,E,4,12,,1.0,M,2.0,M,,");
  const GnssFix fix = one_fix(gga + sentence("GNGSA,A,3,13,16,21,15,10,29,27,20,,,,,1.05,0.64,0.83,1"));
  EXPECT_EQ(fix.pdop, 1.05);
  EXPECT_EQ(fix.hdop, 0.64);
  EXPECT_EQ(fix.vdop, 0.83);
  const GnssFix many = one_fix(gga + sentence("GNGSA,A,3" + std::string(24, ',') + ",1.5,0.7,0.9"));
  EXPECT_EQ(many.vdop, 0.9);
}

TEST(NmeaSentences, DamagedFieldsRefuseTheSentence) {
  for (const char* const body :
       {"GPGGA,246000.00,4134.0,N,09345.0,W,1,09,1.0,2.0,M,3.0,M,,",
        "GPGGA,132820,9134.0,N,09345.0,W,1,09,1.0,2.0,M,3.0,M,,",
        "GPGGA,132820,4160.0,N,09345.0,W,1,09,1.0,2.0,M,3.0,M,,",
        "GPGGA,132820,4134.0,X,09345.0,W,1,09,1.0,2.0,M,3.0,M,,",
        "GPGGA,132820,4134.0,,09345.0,W,1,09,1.0,2.0,M,3.0,M,,", "GPGGA,132820,,N,09345.0,W,1,09,1.0,2.0,M,3.0,M,,",
        "GPGGA,132820,4134.0,N,18100.0,W,1,09,1.0,2.0,M,3.0,M,,",
        "GPGGA,132820,4134.0,N,09345.0,W,9,09,1.0,2.0,M,3.0,M,,",
        "GPGGA,132820,4134.0,N,09345.0,W,1,-9,1.0,2.0,M,3.0,M,,",
        "GPGGA,132820,4134.0,N,09345.0,W,1,09,nan,2.0,M,3.0,M,,",
        "GPGGA,132820,4134.0,N,09345.0,W,1,09,1e2,2.0,M,3.0,M,,",
        "GPGGA,132820,4134.0,N,09345.0,W,1,09,1.0,2.0,F,3.0,M,,", "GPGGA,132820,4134.0,N,09345.0,W,1,09,1.0,2.0,M",
        "GPRMC,132820,B,4134.0,N,09345.0,W,0.0,0.0,130495,,", "GPRMC,132820,A,4134.0,N,09345.0,W,0.0,361.0,130495,,",
        "GPRMC,132820,A,4134.0,N,09345.0,W,0.0,0.0,310295,,", "GPRMC,132820,A,4134.0,N",
        "GPGST,132820,1,1,1,1,-5.8,5.6,22.0", "GPGSA,A,3,1,2,3"}) {
    NmeaParser parser;
    EXPECT_TRUE(fixes_of(parser, sentence(body)).empty()) << body;
    EXPECT_EQ(parser.counts().bad_field, 1U) << body;
  }
}

TEST(NmeaSentences, OthersAreNoneOfOurs) {
  NmeaParser parser;
  const std::string text = sentence("PGRMC,A,1,2") + sentence("PUBX,00,1") + sentence("GNVTG,,T,,M,0.025,N") +
                           sentence("GPRMB") + sentence("") + sentence(std::string(60, ','));
  EXPECT_TRUE(fixes_of(parser, text).empty());
  EXPECT_EQ(parser.counts().other_sentence, 6U);
  EXPECT_EQ(parser.framer_counts().lines, 6U);
}

class NmeaDamage : public testing::Test {
 protected:
  // Fixes and refusals of a stream that holds one line.
  static std::size_t fixes(const std::string& text) {
    NmeaParser parser;
    return fixes_of(parser, text).size();
  }
};

TEST_F(NmeaDamage, EveryTruncationGivesNothing) {
  for (const std::string& line : {kRmc, kGga, kGst})
    for (std::size_t size = 0; size + 2 <= line.size() - 1; ++size) EXPECT_EQ(fixes(line.substr(0, size)), 0U) << size;
}

TEST_F(NmeaDamage, EveryFlippedBitGivesNothing) {
  for (const std::string& line : {kRmc, kGga, kGst}) {
    for (std::size_t bit = 0; bit < 8 * (line.size() - 2); ++bit) {
      std::string flipped = line;
      flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ 1 << (bit % 8));
      EXPECT_EQ(fixes(flipped), 0U) << bit;
    }
  }
}

TEST_F(NmeaDamage, NextLineIsReadAfterAnyDamage) {
  for (const std::string& before :
       {std::string("noise\x01\xFF"), kGga.substr(0, 40), std::string("$"), std::string(500, 'A').insert(0, 1, '$'),
        std::string("$GPGGA*"), std::string("$*7E\r\n"), std::string("$$"), kGga.substr(0, 30) + '\0'}) {
    NmeaParser parser;
    EXPECT_EQ(fixes_of(parser, before + kGga).size(), 1U) << before;
    EXPECT_EQ(parser.counts().gga, 1U);
  }
}

TEST_F(NmeaDamage, CausesAreCounted) {
  NmeaParser parser;
  fixes_of(parser, "abc" + kGga.substr(0, 20) + "$" + std::string(130, 'A') + "\r\n$GPGGA\r\n$GPGGA,1*00\r\n$\x01");
  const NmeaFramerCounts& counts = parser.framer_counts();
  EXPECT_EQ(counts.skipped_bytes, 3U);
  EXPECT_EQ(counts.broken, 2U);
  EXPECT_EQ(counts.too_long, 1U);
  EXPECT_EQ(counts.no_checksum, 1U);
  EXPECT_EQ(counts.bad_checksum, 1U);
}

TEST_F(NmeaDamage, ChunksDoNotMatter) {
  const std::string log = test::read_file(test::clone_data("gnss") / "gr8013-w.log");
  sim::Random random(5, "chunks");
  for (int round = 0; round < 50; ++round) {
    NmeaParser whole, parts;
    const std::size_t expected = fixes_of(whole, log).size();
    std::size_t found = 0;
    for (std::size_t at = 0; at < log.size();) {
      const std::size_t size = std::min<std::size_t>(random.bits() % 90, log.size() - at);
      parts.feed(bytes(log.substr(at, size)), {}, [&](const GnssFix&) { ++found; });
      at += size;
    }
    found += parts.flush().has_value();
    EXPECT_EQ(found, expected);
  }
}

}  // namespace
}  // namespace lxd::drivers_nmea_test
