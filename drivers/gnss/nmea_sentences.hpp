// SPDX-License-Identifier: Apache-2.0
// The fields of one sentence into a fix.
#pragma once

#include "drivers/gnss/gnss_fix.hpp"
#include "drivers/gnss/nmea_fields.hpp"

namespace lxd {

// Each leaves `fix` as it is and returns false when a field is wrong. What a sentence leaves empty stays as it was.
bool read_gga(const NmeaFields& fields, GnssFix& fix);
bool read_rmc(const NmeaFields& fields, GnssFix& fix, std::optional<std::int64_t>& days);
bool read_gst(const NmeaFields& fields, GnssFix& fix);
bool read_gsa(const NmeaFields& fields, GnssFix& fix);
// Date and time; each may be unknown.
bool read_zda(const NmeaFields& fields, std::optional<std::int64_t>& time_of_day_ns, std::optional<std::int64_t>& days);

}  // namespace lxd
