// SPDX-License-Identifier: Apache-2.0
// See nmea_encoder.hpp.
#include "tools/recording/nmea_encoder.hpp"

#include <chrono>
#include <cmath>
#include <numbers>
#include <optional>

#include <fmt/format.h>

#include "drivers/gnss/nmea_fields.hpp"
#include "drivers/gnss/nmea_framer.hpp"

namespace lxd {
namespace {

constexpr std::int64_t kNanosPerMilli = 1'000'000;
constexpr double kDegree_rad = std::numbers::pi / 180;

// The fields of a sentence by their numbers; the rest stay empty.
class Sentence {
 public:
  Sentence(const char* address, std::size_t count) : fields_(count + 1) { fields_[0] = address; }
  void set(std::size_t field, std::string text) { fields_[field] = std::move(text); }
  void set(std::size_t field, const char* format, const std::optional<double>& value) {
    if (value) fields_[field] = fmt::format(fmt::runtime(format), *value);
  }
  [[nodiscard]] std::string text() const { return nmea_sentence(fmt::format("{}", fmt::join(fields_, ","))); }

 private:
  std::vector<std::string> fields_;
};

struct Clock {
  std::string time, date;  // hhmmss.sss, ddmmyy
};

Clock clock_of(const UtcLabel& label) {
  namespace chrono = std::chrono;
  const chrono::sys_time<chrono::milliseconds> time{chrono::milliseconds{label.unix_ns / kNanosPerMilli}};
  const auto day = chrono::floor<chrono::days>(time);
  const chrono::year_month_day date{day};
  const chrono::hh_mm_ss<chrono::milliseconds> clock{time - day};
  return {fmt::format("{:02}{:02}{:02}.{:03}", clock.hours().count(), clock.minutes().count(),
                      clock.seconds().count() + (label.leap ? 1 : 0), clock.subseconds().count()),
          fmt::format("{:02}{:02}{:02}", static_cast<unsigned>(date.day()), static_cast<unsigned>(date.month()),
                      static_cast<int>(date.year()) % 100)};
}

// ddmm.mmmmmmmm: 8 decimals are 19 um. In whole steps, so that 60 minutes cannot come out.
std::string angle(double degrees, int digits) {
  constexpr std::int64_t kStepsPerMinute = 100'000'000, kStepsPerDegree = 60 * kStepsPerMinute;
  const std::int64_t steps = std::llround(std::abs(degrees) * static_cast<double>(kStepsPerDegree));
  const std::int64_t rest = steps % kStepsPerDegree;
  return fmt::format("{:0{}}{:02}.{:08}", steps / kStepsPerDegree, digits, rest / kStepsPerMinute,
                     rest % kStepsPerMinute);
}

void set_position(Sentence& sentence, std::size_t latitude, std::size_t longitude, const GnssFix& fix) {
  if (!fix.has_position()) return;
  sentence.set(latitude, angle(*fix.latitude_deg, 2));
  sentence.set(latitude + 1, *fix.latitude_deg < 0 ? "S" : "N");
  sentence.set(longitude, angle(*fix.longitude_deg, 3));
  sentence.set(longitude + 1, *fix.longitude_deg < 0 ? "W" : "E");
}

std::string gga(const GnssFix& fix, const Clock& clock) {
  using L = nmea::Gga;
  Sentence sentence("GNGGA", L::kFields);
  sentence.set(L::kUtc, clock.time);
  set_position(sentence, L::kLatitude, L::kLongitude, fix);
  sentence.set(L::kQuality, fmt::format("{}", static_cast<int>(fix.quality)));
  sentence.set(L::kSatellites, fmt::format("{:02}", fix.satellites.value_or(0)));
  sentence.set(L::kHdop, "{:.2f}", fix.hdop);
  sentence.set(L::kAltitude, "{:.4f}", fix.altitude_msl_m);
  sentence.set(L::kGeoid, "{:.4f}", fix.geoid_m);
  if (fix.altitude_msl_m) sentence.set(L::kAltitudeUnit, "M");
  if (fix.geoid_m) sentence.set(L::kGeoidUnit, "M");
  sentence.set(L::kAge, "{:.1f}", fix.correction_age_s);
  if (fix.correction_age_s) sentence.set(L::kStation, "0001");
  return sentence.text();
}

std::string rmc(const GnssFix& fix, const Clock& clock) {
  using L = nmea::Rmc;
  constexpr const char* kModes[] = {"N", "A", "D", "P", "R", "F", "E", "M", "S"};  // as the qualities of GGA
  Sentence sentence("GNRMC", L::kFields);
  sentence.set(L::kUtc, clock.time);
  sentence.set(L::kStatus, fix.has_position() ? "A" : "V");
  set_position(sentence, L::kLatitude, L::kLongitude, fix);
  if (fix.speed_mps) sentence.set(L::kSpeed, "{:.4f}", *fix.speed_mps / nmea::kKnot_mps);
  if (fix.course_rad) sentence.set(L::kCourse, "{:.3f}", *fix.course_rad / kDegree_rad);
  sentence.set(L::kDate, clock.date);
  sentence.set(L::kMode, kModes[static_cast<std::size_t>(fix.quality)]);
  return sentence.text();
}

std::string gst(const GnssFix& fix, const Clock& clock) {
  using L = nmea::Gst;
  Sentence sentence("GNGST", L::kFields);
  sentence.set(L::kUtc, clock.time);
  sentence.set(L::kSigmaLatitude, "{:.4f}", fix.sigma_latitude_m);
  sentence.set(L::kSigmaLongitude, "{:.4f}", fix.sigma_longitude_m);
  sentence.set(L::kSigmaAltitude, "{:.4f}", fix.sigma_altitude_m);
  return sentence.text();
}

std::string gsa(const GnssFix& fix) {
  using L = nmea::Gsa;
  Sentence sentence("GNGSA", L::kFieldsWithSystem);
  sentence.set(L::kSelection, "A");
  sentence.set(L::kMode, fix.has_position() ? "3" : "1");
  for (std::size_t i = 0; i < L::kSatellites && i < fix.satellites.value_or(0); ++i)
    sentence.set(L::kFirstSatellite + i, fmt::format("{:02}", i + 1));
  sentence.set(L::kPdop, "{:.2f}", fix.pdop);
  sentence.set(L::kHdop, "{:.2f}", fix.hdop);
  sentence.set(L::kVdop, "{:.2f}", fix.vdop);
  sentence.set(L::kFieldsWithSystem, "1");
  return sentence.text();
}

}  // namespace

std::string nmea_sentence(const std::string& body) { return fmt::format("${}*{:02X}", body, nmea_checksum(body)); }

std::vector<std::string> encode_epoch(const GnssFix& fix, const UtcLabel& label) {
  const Clock clock = clock_of(label);
  return {gga(fix, clock), rmc(fix, clock), gst(fix, clock), gsa(fix)};
}

}  // namespace lxd
