// SPDX-License-Identifier: Apache-2.0
// Which field of a sentence says what (counted from 1 after the address), and how a field is read. Parser and encoder
// share the numbers. Source: gpsd's comments in driver_nmea0183.c.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace lxd {

namespace nmea {

struct Gga {
  static constexpr std::size_t kUtc = 1, kLatitude = 2, kLongitude = 4, kQuality = 6, kSatellites = 7, kHdop = 8,
                               kAltitude = 9, kAltitudeUnit = 10, kGeoid = 11, kGeoidUnit = 12, kAge = 13,
                               kStation = 14, kFields = 14;
};
struct Rmc {
  static constexpr std::size_t kUtc = 1, kStatus = 2, kLatitude = 3, kLongitude = 5, kSpeed = 7, kCourse = 8, kDate = 9,
                               kVariation = 10, kMode = 12, kFields = 12, kFieldsLeast = 9;
};
struct Gst {
  static constexpr std::size_t kUtc = 1, kRms = 2, kMajor = 3, kMinor = 4, kOrientation = 5, kSigmaLatitude = 6,
                               kSigmaLongitude = 7, kSigmaAltitude = 8, kFields = 8;
};
struct Zda {
  static constexpr std::size_t kUtc = 1, kDay = 2, kMonth = 3, kYear = 4, kFieldsLeast = 4;
};
// Some receivers list 24 satellites: the three last numbers are counted from the end.
struct Gsa {
  static constexpr std::size_t kSelection = 1, kMode = 2, kFirstSatellite = 3, kSatellites = 12, kSatellitesLong = 24,
                               kPdop = 15, kHdop = 16, kVdop = 17, kFields = 17, kFieldsWithSystem = 18;
};

inline constexpr double kKnot_mps = 0.514444;
inline constexpr std::size_t kFieldsMax = 40;  // of the sentences above at most 30

}  // namespace nmea

// The comma-separated parts of a body; [0] is the address ("GPGGA"). A view of the body.
class NmeaFields {
 public:
  explicit NmeaFields(std::string_view body);

  // Of fields that the sentence does not have: empty.
  [[nodiscard]] std::string_view operator[](std::size_t i) const { return i < count_ ? parts_[i] : std::string_view(); }
  // Fields after the address.
  [[nodiscard]] std::size_t count() const { return count_ - 1; }
  [[nodiscard]] bool overflow() const { return overflow_; }
  // "GGA" of any talker; empty for proprietary sentences, whose addresses begin with P.
  [[nodiscard]] std::string_view type() const;

 private:
  std::array<std::string_view, nmea::kFieldsMax + 1> parts_;
  std::size_t count_ = 0;
  bool overflow_ = false;
};

// A field that may be empty. `wrong` is set when it is neither empty nor what it should be.
class NmeaValues {
 public:
  explicit NmeaValues(const NmeaFields& fields) : fields_(fields) {}

  std::optional<double> number(std::size_t i, double low, double high);
  std::optional<std::uint32_t> count(std::size_t i, std::uint32_t high);
  // hhmmss with or without decimals, as ns since midnight; second 60 is a leap second.
  std::optional<std::int64_t> time_of_day_ns(std::size_t i);
  // ddmmyy as days since 1970; years 80..99 are of the last century.
  std::optional<std::int64_t> days(std::size_t i);
  // Day, month and year of four digits in three fields, as days since 1970; unknown when all are empty.
  std::optional<std::int64_t> days_in_three(std::size_t day, std::size_t month, std::size_t year);
  // ddmm.mmm and the hemisphere in the next field: degrees, north and east positive.
  std::optional<double> latitude_deg(std::size_t i) { return angle_deg(i, "NS", 90); }
  std::optional<double> longitude_deg(std::size_t i) { return angle_deg(i, "EW", 180); }

  void reject() { wrong_ = true; }
  [[nodiscard]] bool wrong() const { return wrong_; }

 private:
  std::optional<double> angle_deg(std::size_t i, std::string_view hemispheres, double high_deg);

  const NmeaFields& fields_;
  bool wrong_ = false;
};

}  // namespace lxd
