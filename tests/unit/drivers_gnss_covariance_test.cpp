// SPDX-License-Identifier: Apache-2.0
// What a fix's covariance is made of, and that dates come from ZDA too.
#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "drivers/gnss/gnss_covariance.hpp"
#include "tests/support/data_folders.hpp"
#include "tests/support/nmea_text.hpp"
#include "tests/support/temporary_folder.hpp"

namespace lxd::drivers_gnss_covariance_test {
namespace {

using test::fixes_of;
using test::sentence;

constexpr const char* kPlace = ",4134.0,N,09345.0,E,";

std::string gga(const std::string& utc, int quality = 4) {
  return sentence("GNGGA," + utc + kPlace + std::to_string(quality) + ",12,0.8,1.0,M,2.0,M,,");
}

GnssFix fix_of(const std::string& text) {
  NmeaParser parser;
  const auto fixes = fixes_of(parser, text);
  EXPECT_EQ(fixes.size(), 1U);
  return fixes.empty() ? GnssFix{} : fixes[0];
}

// An ellipse of 5 m by 3 m whose long axis points to the north-east: both sigmas are the root of the mean square.
TEST(GnssCovariances, AreTheReceiversEllipse) {
  const double side = std::sqrt((25 + 9) / 2.0);
  const std::string side_text = std::to_string(side);
  const auto covariance = covariance_of(
      fix_of(gga("101112.00") + sentence("GNGST,101112.00,1,5,3,45," + side_text + "," + side_text + ",7")));
  ASSERT_TRUE(covariance);
  EXPECT_TRUE(covariance->said);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(covariance->enu_m2);
  EXPECT_NEAR(axes.eigenvalues()[0], 9, 1e-4);
  EXPECT_NEAR(axes.eigenvalues()[1], 25, 1e-4);
  EXPECT_NEAR(axes.eigenvalues()[2], 49, 1e-4);
  EXPECT_GT(covariance->enu_m2(0, 1), 0);  // north-east: both grow together
}

TEST(GnssCovariances, StayPositiveDefiniteWhateverTheReceiverSays) {
  for (const char* const gst : {"1,100,0,45,1,1,1", "1,0,0,0,0,0,0", "1,9,9,200,0.001,50,1"}) {
    const auto covariance = covariance_of(fix_of(gga("101112.00") + sentence("GNGST,101112.00," + std::string(gst))));
    ASSERT_TRUE(covariance);
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance->enu_m2).eigenvalues()[0], 0) << gst;
  }
}

TEST(GnssCovariances, AreAssumedByTheSortOfFixWhereNothingIsSaid) {
  double before_m2 = 0;
  for (const int quality : {4, 5, 2, 1, 6}) {
    const auto covariance = covariance_of(fix_of(gga("101112.00", quality)));
    ASSERT_TRUE(covariance) << quality;
    EXPECT_FALSE(covariance->said);
    EXPECT_GT(covariance->enu_m2(0, 0), before_m2);
    EXPECT_GT(covariance->enu_m2(2, 2), covariance->enu_m2(0, 0));
    before_m2 = covariance->enu_m2(0, 0);
  }
}

TEST(GnssCovariances, AreNoneWithoutAPosition) {
  EXPECT_FALSE(covariance_of(fix_of(gga("101112.00", 0))));
  EXPECT_FALSE(covariance_of(fix_of(gga("101112.00", 8))));
}

TEST(NmeaDates, ComeFromZdaToo) {
  EXPECT_EQ(fix_of(gga("000000.00") + sentence("GPZDA,000000.00,01,01,2000,00,00")).utc_ns,
            946'684'800 * kNanosPerSecond);
  EXPECT_EQ(fix_of(sentence("GPZDA,000000.00,01,01,2000,,") + gga("000000.20")).utc_ns,
            946'684'800 * kNanosPerSecond + 200'000'000);
  EXPECT_FALSE(fix_of(sentence("GPZDA,,,,,,") + gga("000000.20")).utc_ns);
  NmeaParser parser;
  for (const char* const body : {"GPZDA,000000.00,31,02,2000", "GPZDA,000000.00,01,01,99", "GPZDA,000000.00,01,,2000",
                                 "GPZDA,250000.00,01,01,2000", "GPZDA,000000.00,1"}) {
    EXPECT_TRUE(fixes_of(parser, sentence(body)).empty());
  }
  EXPECT_EQ(parser.counts().bad_field, 5U);
  EXPECT_EQ(parser.counts().zda, 0U);
}

// Every fix of every log has a quality and a covariance that is sound.
TEST(NmeaRealReceiverLogs, CarryQualityAndCovariance) {
  for (const char* const name : {"gr8013-w.log", "quectel-L70.log", "skytraq-fix.log", "st-teseo-liv4f.log",
                                 "ublox-neo-m9n-nmea.log", "ublox-zed-f9p-nmea.log"}) {
    const auto path = test::shared_data(std::string("gnss/") + name);
    if (!path) GTEST_SKIP() << "no LXD_SHARED_DATA with gnss/" << name;
    NmeaParser parser;
    const auto fixes = fixes_of(parser, test::read_file(*path));
    const auto has_dilutions = [](const GnssFix& fix) { return fix.hdop && fix.pdop && fix.vdop; };
    const auto with = std::ranges::count_if(fixes, has_dilutions);
    EXPECT_GE(with + 1, std::ssize(fixes)) << name;  // where GSA comes last the first fix has none
    EXPECT_GT(with, 0) << name;
    for (const GnssFix& fix : fixes) {
      const auto covariance = covariance_of(fix);
      ASSERT_TRUE(covariance) << name;
      EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance->enu_m2).eigenvalues()[0], 0) << name;
    }
  }
}

}  // namespace
}  // namespace lxd::drivers_gnss_covariance_test
