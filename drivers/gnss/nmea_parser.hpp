// SPDX-License-Identifier: Apache-2.0
// NMEA 0183 bytes in, fixes out. The sentences of one epoch (equal UTC) are merged into one fix. Allocates nothing.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "drivers/gnss/gnss_fix.hpp"
#include "drivers/gnss/nmea_fields.hpp"
#include "drivers/gnss/nmea_framer.hpp"
#include "drivers/replay/rejections.hpp"

namespace lxd {

struct NmeaCounts {
  std::uint64_t gga = 0, rmc = 0, gst = 0, gsa = 0, zda = 0;
  std::uint64_t other_sentence = 0;  // sound, of no use here
  std::uint64_t bad_field = 0;       // refused whole: a field is neither empty nor sound
  std::uint64_t no_time = 0;         // GGA, RMC, GST without UTC: a receiver that has not found the time
  std::uint64_t late = 0;            // of an epoch whose fix was given already
  std::uint64_t fixes = 0, fixes_with_position = 0;
};

// When a fix is given: with the sentence that completes the kinds which the epochs so far consisted of, so that a fix
// does not wait for the next epoch; while these kinds are still unknown, with the first sentence of the next epoch.
class NmeaParser {
 public:
  // At most one fix a byte.
  std::optional<GnssFix> push(std::uint8_t byte, RigTime received);
  // Calls on_fix(const GnssFix&) for every fix that the bytes complete.
  template <typename OnFix>
  void feed(std::span<const std::uint8_t> bytes, RigTime received, OnFix&& on_fix) {
    for (const std::uint8_t byte : bytes)
      if (const auto fix = push(byte, received)) on_fix(*fix);
  }
  // The epoch under way, when the stream has ended.
  std::optional<GnssFix> flush();

  [[nodiscard]] const NmeaCounts& counts() const { return counts_; }
  [[nodiscard]] const NmeaFramerCounts& framer_counts() const { return framer_.counts(); }

 private:
  using Kinds = std::uint8_t;  // a set of bits
  static constexpr Kinds kGga = 1, kRmc = 2, kGst = 4;

  std::optional<GnssFix> take(const NmeaLine& line);
  std::optional<GnssFix> take_timed(Kinds kind, const NmeaFields& fields, RigTime received);
  void take_gsa(const NmeaFields& fields);
  void take_zda(const NmeaFields& fields);
  std::optional<GnssFix> give();
  void begin_epoch(std::int64_t time_of_day_ns, RigTime received);
  void merge_date(std::optional<std::int64_t> days);
  void set_utc();

  NmeaFramer framer_;
  GnssFix epoch_;
  GnssFix between_;                            // holds what GSA said since the last fix was given; none has a time
  Kinds seen_ = 0;                             // of the epoch under way; 0: none is
  Kinds expected_ = 0;                         // of all epochs so far
  bool owed_ = false;                          // the epoch under way is complete and not given yet
  std::optional<std::int64_t> given_time_ns_;  // of the last fix
  struct Date {
    std::int64_t days, time_of_day_ns;
  };
  std::optional<Date> date_;  // the last that a sentence said, and when
  NmeaCounts counts_;
};

// What was refused since the start, by cause.
Rejections rejections_of(const NmeaParser& parser);

}  // namespace lxd
