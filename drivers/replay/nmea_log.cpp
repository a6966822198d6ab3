// SPDX-License-Identifier: Apache-2.0
// See nmea_log.hpp.
#include "drivers/replay/nmea_log.hpp"

#include <fmt/format.h>

#include "drivers/replay/times_file.hpp"

namespace lxd {

Result<NmeaLog> NmeaLog::open(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::error_code ignored;  // a folder opens like a file, and reads as an empty one
  if (!file || std::filesystem::is_directory(path, ignored))
    return Error{fmt::format("{}: cannot be read, wanted lines `<host time s> <sentence>`", path.string())};
  return NmeaLog(std::move(file));
}

bool NmeaLog::next(NmeaChunk& chunk) {
  while (std::getline(file_, line_)) {
    ++line_number_;
    if (line_.find_first_not_of(" \t\r") == std::string::npos) continue;
    const std::size_t space = line_.find(' ');
    const auto time = parse_seconds(std::string_view(line_).substr(0, space));
    if (!time || space == std::string::npos) {
      if (garbage_++ == 0) first_garbage_line_ = line_number_;
      continue;
    }
    line_ += '\n';
    chunk = {*time, {reinterpret_cast<const std::uint8_t*>(line_.data()) + space + 1, line_.size() - space - 1}};
    ++lines_;
    return true;
  }
  return false;
}

}  // namespace lxd
