// SPDX-License-Identifier: Apache-2.0
// See nmea_parser.hpp.
#include "drivers/gnss/nmea_parser.hpp"

#include "drivers/gnss/nmea_sentences.hpp"

namespace lxd {
namespace {

constexpr std::int64_t kDay_ns = 86'400 * kNanosPerSecond;

}  // namespace

std::optional<GnssFix> NmeaParser::push(std::uint8_t byte, RigTime received) {
  const auto line = framer_.push(byte, received);
  if (line) return take(*line);
  return owed_ ? give() : std::nullopt;
}

std::optional<GnssFix> NmeaParser::take(const NmeaLine& line) {
  const NmeaFields fields(line.body);
  const std::string_view type = fields.overflow() ? std::string_view() : fields.type();
  if (type == "GGA") return take_timed(kGga, fields, line.received);
  if (type == "RMC") return take_timed(kRmc, fields, line.received);
  if (type == "GST") return take_timed(kGst, fields, line.received);
  if (type == "GSA") {
    take_gsa(fields);
  } else if (type == "ZDA") {
    take_zda(fields);
  } else {
    ++counts_.other_sentence;
  }
  return std::nullopt;
}

std::optional<GnssFix> NmeaParser::take_timed(Kinds kind, const NmeaFields& fields, RigTime received) {
  static_assert(nmea::Gga::kUtc == nmea::Rmc::kUtc && nmea::Gga::kUtc == nmea::Gst::kUtc);
  NmeaValues values(fields);
  const auto time_ns = values.time_of_day_ns(nmea::Gga::kUtc);
  // Read into a copy first: a sentence that is refused must not end an epoch.
  const bool same_epoch = time_ns && seen_ != 0 && *time_ns == epoch_.time_of_day_ns;
  GnssFix read = same_epoch ? epoch_ : GnssFix{};
  std::optional<std::int64_t> days;
  const bool sound = !values.wrong() && (kind == kGga   ? read_gga(fields, read)
                                         : kind == kRmc ? read_rmc(fields, read, days)
                                                        : read_gst(fields, read));
  if (!sound) {
    ++counts_.bad_field;
    return std::nullopt;
  }
  ++(kind == kGga ? counts_.gga : kind == kRmc ? counts_.rmc : counts_.gst);
  if (!time_ns) {
    ++counts_.no_time;
    return std::nullopt;
  }
  if (!same_epoch && given_time_ns_ == time_ns) {
    ++counts_.late;
    expected_ |= kind;
    return std::nullopt;
  }
  std::optional<GnssFix> given;
  if (!same_epoch) {
    given = give();
    begin_epoch(*time_ns, received);
    read.received = epoch_.received;
    read.time_of_day_ns = *time_ns;
    read.pdop = between_.pdop;
    read.vdop = between_.vdop;
    if (!read.hdop) read.hdop = between_.hdop;
    between_ = {};
  }
  epoch_ = read;
  if (kind == kRmc && (seen_ & kGga) == 0 && !epoch_.warned) epoch_.quality = GnssQuality::single;
  seen_ |= kind;
  merge_date(days);
  if (expected_ == 0 || (seen_ & expected_) != expected_) return given;
  if (!given) return give();
  owed_ = true;  // with the next byte: the line before this one took this one's turn
  return given;
}

// Where GSA comes after the sentence that completes an epoch, its numbers are the next one's.
void NmeaParser::take_gsa(const NmeaFields& fields) {
  if (!read_gsa(fields, seen_ != 0 ? epoch_ : between_)) {
    ++counts_.bad_field;
  } else {
    ++counts_.gsa;
  }
}

// Says the date for the epochs from its own time on, as RMC does; it is no part of a fix.
void NmeaParser::take_zda(const NmeaFields& fields) {
  std::optional<std::int64_t> time_ns, days;
  if (!read_zda(fields, time_ns, days)) {
    ++counts_.bad_field;
    return;
  }
  ++counts_.zda;
  if (!time_ns || !days) return;
  date_ = Date{*days, *time_ns};
  if (seen_ != 0 && epoch_.time_of_day_ns == *time_ns) set_utc();
}

void NmeaParser::begin_epoch(std::int64_t time_of_day_ns, RigTime received) {
  epoch_ = {};
  epoch_.received = received;
  epoch_.time_of_day_ns = time_of_day_ns;
  set_utc();
}

void NmeaParser::merge_date(std::optional<std::int64_t> days) {
  if (days) date_ = Date{*days, epoch_.time_of_day_ns};
  set_utc();
}

// The date holds for this epoch, or, when the clock has gone back over midnight since it was said, the next day's does.
void NmeaParser::set_utc() {
  if (!date_) return;
  const bool next_day = epoch_.time_of_day_ns < date_->time_of_day_ns - kDay_ns / 2;
  epoch_.utc_ns = (date_->days + (next_day ? 1 : 0)) * kDay_ns + epoch_.time_of_day_ns;
}

std::optional<GnssFix> NmeaParser::give() {
  owed_ = false;
  if (seen_ == 0) return std::nullopt;
  expected_ |= seen_;
  seen_ = 0;
  given_time_ns_ = epoch_.time_of_day_ns;
  ++counts_.fixes;
  if (epoch_.has_position()) ++counts_.fixes_with_position;
  return epoch_;
}

std::optional<GnssFix> NmeaParser::flush() { return give(); }

Rejections rejections_of(const NmeaParser& parser) {
  const NmeaFramerCounts& framer = parser.framer_counts();
  Rejections rejected;
  count_rejected(rejected, "skipped_byte", framer.skipped_bytes);
  count_rejected(rejected, "bad_checksum", framer.bad_checksum);
  count_rejected(rejected, "no_checksum", framer.no_checksum);
  count_rejected(rejected, "too_long", framer.too_long);
  count_rejected(rejected, "broken_line", framer.broken);
  count_rejected(rejected, "bad_field", parser.counts().bad_field);
  count_rejected(rejected, "late", parser.counts().late);
  return rejected;
}

}  // namespace lxd
