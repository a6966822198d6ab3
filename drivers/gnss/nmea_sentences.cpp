// SPDX-License-Identifier: Apache-2.0
// See nmea_sentences.hpp.
#include "drivers/gnss/nmea_sentences.hpp"

#include <numbers>

namespace lxd {
namespace {

// Beyond these a field is damaged, whatever the receiver.
constexpr double kHeightMax_m = 1e5, kSigmaMax_m = 1e7, kDopMax = 1000, kAgeMax_s = 1e6, kSpeedMax_knots = 1e5;
constexpr std::uint32_t kSatellitesMax = 200;
constexpr double kDegree_rad = std::numbers::pi / 180;

template <typename T>
void keep(std::optional<T>& into, const std::optional<T>& value) {
  if (value) into = value;
}

void read_position(NmeaValues& values, std::size_t latitude, std::size_t longitude, GnssFix& fix) {
  keep(fix.latitude_deg, values.latitude_deg(latitude));
  keep(fix.longitude_deg, values.longitude_deg(longitude));
}

// Heights are in metres, the only unit that the standard allows.
std::optional<double> height_m(NmeaValues& values, const NmeaFields& fields, std::size_t field) {
  if (!fields[field + 1].empty() && fields[field + 1] != "M") values.reject();
  return values.number(field, -kHeightMax_m, kHeightMax_m);
}

}  // namespace

bool read_gga(const NmeaFields& fields, GnssFix& fix) {
  using L = nmea::Gga;
  NmeaValues values(fields);
  GnssFix read = fix;
  if (fields.count() < L::kFields) values.reject();
  read_position(values, L::kLatitude, L::kLongitude, read);
  constexpr auto kQualityMax = static_cast<std::uint32_t>(GnssQuality::simulator);
  read.quality = static_cast<GnssQuality>(values.count(L::kQuality, kQualityMax).value_or(0));
  keep(read.satellites, values.count(L::kSatellites, kSatellitesMax));
  keep(read.hdop, values.number(L::kHdop, 0, kDopMax));
  keep(read.altitude_msl_m, height_m(values, fields, L::kAltitude));
  keep(read.geoid_m, height_m(values, fields, L::kGeoid));
  keep(read.correction_age_s, values.number(L::kAge, 0, kAgeMax_s));
  if (!values.wrong()) fix = read;
  return !values.wrong();
}

bool read_rmc(const NmeaFields& fields, GnssFix& fix, std::optional<std::int64_t>& days) {
  using L = nmea::Rmc;
  NmeaValues values(fields);
  GnssFix read = fix;
  const std::string_view status = fields[L::kStatus];
  if (fields.count() < L::kFieldsLeast || (status != "A" && status != "V")) values.reject();
  read.warned = status == "V";
  read_position(values, L::kLatitude, L::kLongitude, read);
  if (const auto knots = values.number(L::kSpeed, 0, kSpeedMax_knots)) read.speed_mps = *knots * nmea::kKnot_mps;
  if (const auto course_deg = values.number(L::kCourse, 0, 360)) read.course_rad = *course_deg * kDegree_rad;
  const auto date = values.days(L::kDate);
  if (values.wrong()) return false;
  fix = read;
  days = date;
  return true;
}

bool read_gst(const NmeaFields& fields, GnssFix& fix) {
  using L = nmea::Gst;
  NmeaValues values(fields);
  GnssFix read = fix;
  if (fields.count() < L::kFields) values.reject();
  keep(read.sigma_major_m, values.number(L::kMajor, 0, kSigmaMax_m));
  keep(read.sigma_minor_m, values.number(L::kMinor, 0, kSigmaMax_m));
  if (const auto deg = values.number(L::kOrientation, -180, 360)) read.major_azimuth_rad = *deg * kDegree_rad;
  keep(read.sigma_latitude_m, values.number(L::kSigmaLatitude, 0, kSigmaMax_m));
  keep(read.sigma_longitude_m, values.number(L::kSigmaLongitude, 0, kSigmaMax_m));
  keep(read.sigma_altitude_m, values.number(L::kSigmaAltitude, 0, kSigmaMax_m));
  if (!values.wrong()) fix = read;
  return !values.wrong();
}

bool read_gsa(const NmeaFields& fields, GnssFix& fix) {
  using L = nmea::Gsa;
  NmeaValues values(fields);
  const bool many = fields.count() >= L::kFields + L::kSatellitesLong - L::kSatellites;
  const std::size_t more = many ? L::kSatellitesLong - L::kSatellites : 0;
  if (fields.count() < L::kFields) values.reject();
  const auto pdop = values.number(L::kPdop + more, 0, kDopMax), hdop = values.number(L::kHdop + more, 0, kDopMax),
             vdop = values.number(L::kVdop + more, 0, kDopMax);
  if (values.wrong()) return false;
  keep(fix.pdop, pdop);
  keep(fix.hdop, hdop);
  keep(fix.vdop, vdop);
  return true;
}

bool read_zda(const NmeaFields& fields, std::optional<std::int64_t>& time_of_day_ns,
              std::optional<std::int64_t>& days) {
  using L = nmea::Zda;
  NmeaValues values(fields);
  if (fields.count() < L::kFieldsLeast) values.reject();
  const auto time = values.time_of_day_ns(L::kUtc);
  const auto date = values.days_in_three(L::kDay, L::kMonth, L::kYear);
  if (values.wrong()) return false;
  time_of_day_ns = time;
  days = date;
  return true;
}

}  // namespace lxd
