// SPDX-License-Identifier: Apache-2.0
// Files of time stamps, a line each.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "rt/result.hpp"
#include "rt/time.hpp"

namespace lxd {

// One entry a line; none: the line is blank. Blank lines at the end of the file are not lines.
using StampLines = std::vector<std::optional<RigTime>>;

// "12.345678901", "1.234e+01": seconds; decimals are read exactly, to the nanosecond.
// Errors name file and line: a missing file, a line that is no finite number or beyond +-146 years.
Result<StampLines> read_seconds_file(const std::filesystem::path& path);

// "2011-09-26 13:04:32.335337762": KITTI raw; nanoseconds since 1970. Errors as above.
Result<StampLines> read_dates_file(const std::filesystem::path& path);

std::optional<RigTime> parse_seconds(std::string_view text);
std::optional<RigTime> parse_date(std::string_view text);

// Median distance of the stamps that follow each other in order; 0 with fewer than two.
Duration median_period(const StampLines& stamps);

}  // namespace lxd
