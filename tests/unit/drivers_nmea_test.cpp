// SPDX-License-Identifier: Apache-2.0
// NMEA 0183: golden lines, everything damaged, epochs, real receivers' logs, and the frame that positions go to.
#include <functional>

#include <gtest/gtest.h>

#include "drivers/gnss/enu.hpp"
#include "drivers/gnss/nmea_parser.hpp"
#include "drivers/replay/nmea_log.hpp"
#include "drivers/replay/pps_log.hpp"
#include "tests/support/data_folders.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/simulator/random.hpp"

namespace lxd {
namespace {

// The checksums of these four were verified independently.
const std::string kRmc = "$GPRMC,210230,A,3855.4487,N,09446.0071,W,0.0,076.2,130495,003.8,E*69\r\n";
const std::string kGga =
    "$GPGGA,132820.60,4134.49821229,N,09345.03351845,W,2,09,1.0,278.020,M,-31.442,M,7.6,0133*7E\r\n";
const std::string kGst = "$GPGST,024603.00,3.2,6.6,4.7,47.3,5.8,5.6,22.0*58\r\n";
const std::string kEmptyGga = "$GPGGA,,,,,,0,,,,,,,,*66\r\n";

std::string sentence(const std::string& body) {
  constexpr const char* kHex = "0123456789ABCDEF";
  const std::uint8_t sum = nmea_checksum(body);
  return "$" + body + "*" + kHex[sum >> 4U] + kHex[sum & 15U] + "\r\n";
}

std::span<const std::uint8_t> bytes(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

std::vector<GnssFix> fixes_of(NmeaParser& parser, const std::string& text, RigTime received = {}) {
  std::vector<GnssFix> fixes;
  parser.feed(bytes(text), received, [&](const GnssFix& fix) { fixes.push_back(fix); });
  if (const auto last = parser.flush()) fixes.push_back(*last);
  return fixes;
}

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
  EXPECT_NEAR(fix.course_rad.value(), 76.2 * M_PI / 180, 1e-12);
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
       {std::string("noise\x01\xFF"), kGga.substr(0, 40), std::string("$"), "$" + std::string(500, 'A'),
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

class NmeaEpochs : public testing::Test {
 protected:
  static std::string gga(const std::string& utc) {
    return sentence("GNGGA," + utc + ",4134.0,N,09345.0,E,4,12,0.6,1.0,M,2.0,M,,");
  }
  static std::string rmc(const std::string& utc, const std::string& date = "130495", char status = 'A') {
    return sentence("GNRMC," + utc + "," + status + ",4134.0,N,09345.0,E,1.0,90.0," + date + ",,,R");
  }
  static std::string gst(const std::string& utc) { return sentence("GNGST," + utc + ",1,1,1,1,0.1,0.2,0.3"); }
  static std::string epoch(const std::string& utc) { return gga(utc) + rmc(utc) + gst(utc); }

  std::vector<GnssFix> feed(const std::string& text, double received_s = 0) {
    std::vector<GnssFix> fixes;
    parser_.feed(bytes(text), RigTime::from_seconds(received_s), [&](const GnssFix& fix) { fixes.push_back(fix); });
    return fixes;
  }
  NmeaParser parser_;
};

TEST_F(NmeaEpochs, EqualTimesAreOneFix) {
  EXPECT_TRUE(feed(epoch("101112.00"), 1).empty());
  const auto fixes = feed(gga("101112.20"), 2);
  ASSERT_EQ(fixes.size(), 1U);
  EXPECT_EQ(fixes[0].received, RigTime::from_seconds(1));
  EXPECT_EQ(fixes[0].quality, GnssQuality::rtk_fixed);
  EXPECT_EQ(fixes[0].sigma_longitude_m, 0.2);
  EXPECT_NEAR(fixes[0].speed_mps.value(), 0.514444, 1e-9);
  EXPECT_TRUE(fixes[0].utc_ns);
}

// Once it is known what an epoch consists of, its last sentence gives the fix.
TEST_F(NmeaEpochs, FixComesWithItsLastSentence) {
  feed(epoch("101112.00"));
  EXPECT_EQ(feed(gga("101112.20") + rmc("101112.20")).size(), 1U);  // of the epoch before
  EXPECT_EQ(feed(gst("101112.20")).size(), 1U);
  EXPECT_TRUE(feed(gga("101112.40") + rmc("101112.40")).empty());
  EXPECT_EQ(feed(gst("101112.40")).size(), 1U);
  EXPECT_FALSE(parser_.flush());
  EXPECT_EQ(parser_.counts().fixes, 3U);
}

TEST_F(NmeaEpochs, SentencesThatComeLaterAreWaitedForFromThenOn) {
  feed(gga("101112.00"));
  EXPECT_EQ(feed(gga("101112.20")).size(), 2U);  // the one before, and this one: a GGA is all that comes, so far
  EXPECT_TRUE(feed(gst("101112.20")).empty());
  EXPECT_EQ(parser_.counts().late, 1U);
  EXPECT_TRUE(feed(gga("101112.40")).empty());
  EXPECT_EQ(feed(gst("101112.40")).size(), 1U);
}

TEST_F(NmeaEpochs, DateGoesOnOverMidnight) {
  feed(rmc("235959.80", "311299"));
  feed(gga("235959.80") + gga("000000.00"));
  const auto fix = parser_.flush();
  ASSERT_TRUE(fix && fix->utc_ns);
  EXPECT_EQ(*fix->utc_ns, 946'684'800 * kNanosPerSecond);  // 2000-01-01
}

TEST_F(NmeaEpochs, LeapSecondIsASecondThatUnixTimeHasTwice) {
  feed(rmc("235960.00", "311216"));
  const auto leap = parser_.flush();
  const auto next = feed(rmc("000000.00", "010117"));
  ASSERT_TRUE(leap && next.size() == 1);
  EXPECT_EQ(leap->time_of_day_ns, 86'400 * kNanosPerSecond);
  EXPECT_EQ(leap->utc_ns, next[0].utc_ns);
}

TEST_F(NmeaEpochs, ReceiversWarningTakesThePosition) {
  feed(gga("101112.00") + rmc("101112.00", "130495", 'V'));
  EXPECT_FALSE(parser_.flush()->has_position());
  feed(rmc("101112.20"));
  EXPECT_TRUE(parser_.flush()->has_position());
}

TEST_F(NmeaEpochs, RefusedSentenceEndsNoEpoch) {
  feed(gga("101112.00"));
  EXPECT_TRUE(feed(sentence("GNGST,101112.20,1,1,1,1,-1,1,1")).empty());
  EXPECT_TRUE(feed(rmc("101112.00")).empty());
  EXPECT_TRUE(parser_.flush()->speed_mps);
}

struct RealLog {
  const char* name;
  std::uint64_t gga, rmc, gst, gsa, lines, bad_checksum, fixes;
};

// Counted by a separate script: lines `$...*HH` whose XOR is right, by the last three letters of the address; fixes are
// distinct UTC fields of GGA. `gpsdecode < log` (gpsd 3.22) gives one position less for each log: it prints an epoch
// when the next begins.
constexpr RealLog kRealLogs[] = {
    {"gr8013-w.log", 3, 3, 3, 6, 48, 0, 3},
    {"quectel-L70.log", 16, 16, 16, 16, 115, 0, 16},
    {"skytraq-fix.log", 11, 11, 11, 11, 100, 0, 11},
    {"st-teseo-liv4f.log", 12, 12, 12, 76, 329, 1, 12},
    {"ublox-neo-m9n-nmea.log", 61, 61, 61, 244, 1403, 0, 61},
    {"ublox-zed-f9p-nmea.log", 29, 29, 29, 116, 1015, 0, 29},
};

class NmeaRealReceivers : public testing::Test {
 protected:
  static void expect_counts(const std::filesystem::path& path, const RealLog& log) {
    NmeaParser parser;
    const std::vector<GnssFix> fixes = fixes_of(parser, test::read_file(path));
    EXPECT_EQ(parser.counts().gga, log.gga) << log.name;
    EXPECT_EQ(parser.counts().rmc, log.rmc) << log.name;
    EXPECT_EQ(parser.counts().gst, log.gst) << log.name;
    EXPECT_EQ(parser.counts().gsa, log.gsa) << log.name;
    EXPECT_EQ(parser.framer_counts().lines, log.lines) << log.name;
    EXPECT_EQ(parser.framer_counts().bad_checksum, log.bad_checksum) << log.name;
    EXPECT_EQ(parser.counts().bad_field, 0U) << log.name;
    EXPECT_EQ(fixes.size(), log.fixes) << log.name;
    EXPECT_EQ(parser.counts().fixes_with_position, log.fixes) << log.name;
    for (const GnssFix& fix : fixes) EXPECT_TRUE(fix.utc_ns && fix.ellipsoid_height_m()) << log.name;
  }
};

TEST_F(NmeaRealReceivers, LogsOfTheClone) {
  for (std::size_t i = 0; i < 3; ++i) expect_counts(test::clone_data("gnss") / kRealLogs[i].name, kRealLogs[i]);
  NmeaParser skytraq, parser;
  const auto some = fixes_of(skytraq, test::read_file(test::clone_data("gnss") / "skytraq-fix.log"));
  const auto has_sigma = [](const GnssFix& fix) { return fix.sigma_latitude_m.has_value(); };
  EXPECT_EQ(std::count_if(some.begin(), some.end(), has_sigma), 4) << "its other GST have empty fields";
  const auto fixes = fixes_of(parser, test::read_file(test::clone_data("gnss") / "ublox-zed-f9p-nmea.log"));
  ASSERT_EQ(fixes.size(), 3U);
  EXPECT_NEAR(fixes[0].latitude_deg.value(), -45.877567166666665, 1e-12);
  EXPECT_EQ(fixes[0].utc_ns.value(), 1'555'029'596 * kNanosPerSecond);  // 2019-04-12T00:39:56Z
}

TEST_F(NmeaRealReceivers, AllSixLogs) {
  for (const RealLog& log : kRealLogs) {
    const auto path = test::shared_data(std::string("gnss/") + log.name);
    if (!path) GTEST_SKIP() << "no LXD_SHARED_DATA with gnss/" << log.name;
    expect_counts(*path, log);
  }
}

TEST(NmeaLogs, LinesBecomeChunksWithTheirTimes) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "gnss.nmea", "1.250000001 " + kRmc + "no time\n\n2.5 " + kEmptyGga + "3.0");
  auto log = NmeaLog::open(folder / "gnss.nmea");
  ASSERT_TRUE(log.ok());
  NmeaParser parser;
  std::vector<std::int64_t> times;
  for (NmeaChunk chunk; log->next(chunk);) {
    times.push_back(chunk.received.ns());
    parser.feed(chunk.bytes, chunk.received, [](const GnssFix&) {});
  }
  EXPECT_EQ(times, (std::vector<std::int64_t>{1'250'000'001, 2'500'000'000}));
  EXPECT_EQ(parser.counts().rmc, 1U);
  EXPECT_EQ(log->garbage(), 2U);
  EXPECT_EQ(log->first_garbage_line(), 2U);
  EXPECT_FALSE(NmeaLog::open(folder / "none").ok());
}

TEST(PpsLogs, EdgesWithTheirCount) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "pps.csv", "assert_ns,sequence\r\n1700000000000001234,7\r\n1700000002000001234,9\r\n");
  const auto log = read_pps_log(folder / "pps.csv");
  ASSERT_TRUE(log.ok());
  ASSERT_EQ(log->edges.size(), 2U);
  EXPECT_EQ(log->edges[0], (PpsEdge{RigTime::from_ns(1'700'000'000'000'001'234), 7}));
  EXPECT_EQ(log->lost, 1U);
  for (const char* const content : {"", "time\n", "assert_ns,sequence\n12\n", "assert_ns,sequence\n1,2,3\n",
                                    "assert_ns,sequence\n1,2\n2,2\n", "assert_ns,sequence\nx,2\n"}) {
    test::write_file(folder / "bad.csv", content);
    const auto bad = read_pps_log(folder / "bad.csv");
    ASSERT_FALSE(bad.ok()) << content;
    EXPECT_NE(bad.error().message.find("bad.csv: line"), std::string::npos);
  }
}

TEST(EnuFrames, PlacesGoThereAndBack) {
  const auto frame = EnuFrame::at({37.7, -122.4, 30});
  ASSERT_TRUE(frame.ok());
  EXPECT_LT(frame->to_enu({37.7, -122.4, 30}).norm(), 1e-8);
  const Eigen::Vector3d p(1200, -340, 25);
  const Geodetic place = frame->to_geodetic(p);
  EXPECT_GT(place.longitude_deg, -122.4);
  EXPECT_LT(place.latitude_deg, 37.7);
  EXPECT_LT((frame->to_enu(place) - p).norm(), 1e-7);
  // One minute of latitude is 1850 m here (WGS-84 meridian radius at 37.7 degrees: 6359.4 km).
  EXPECT_NEAR(frame->to_enu({37.7 + 1.0 / 60, -122.4, 30}).y(), 1849.9, 0.5);
}

TEST(EnuFrames, OriginsThatAreNoPlaceAreErrors) {
  EXPECT_FALSE(EnuFrame::at({90.1, 0, 0}).ok());
  EXPECT_FALSE(EnuFrame::at({0, 180.1, 0}).ok());
  EXPECT_FALSE(EnuFrame::at({0, 0, std::numeric_limits<double>::infinity()}).ok());
  EXPECT_FALSE(EnuFrame::at({std::nan(""), 0, 0}).ok());
}

}  // namespace
}  // namespace lxd
