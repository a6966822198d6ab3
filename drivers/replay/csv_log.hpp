// SPDX-License-Identifier: Apache-2.0
// A sensor's text of a generic folder: a line a sample, `t,x,y,...`; seconds of the rig's clock, then numbers. Lines
// before the first number are headings.
#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "drivers/replay/rejections.hpp"
#include "drivers/replay/times_file.hpp"
#include "rt/result.hpp"
#include "rt/time.hpp"

namespace lxd {

template <std::size_t Values>
class CsvLog {
 public:
  struct Row {
    RigTime t;
    std::array<double, Values> values{};
  };

  // Error: the file cannot be read.
  static Result<CsvLog> open(const std::filesystem::path& path) {
    std::ifstream file(path);
    if (!file) return Error{fmt::format("{}: cannot be read", path.string())};
    return CsvLog(std::move(file));
  }

  // False: the file has ended. Lines that are no row are counted and passed over.
  bool next(Row& row) {
    while (std::getline(file_, line_)) {
      if (parse(row)) {
        begun_ = true;
        return true;
      }
      if (begun_) count_rejected(rejected_, "bad_line");
    }
    return false;
  }

  [[nodiscard]] const Rejections& rejected() const { return rejected_; }

 private:
  explicit CsvLog(std::ifstream file) : file_(std::move(file)) {}

  // Cuts the text before the next comma off `rest`.
  static std::string_view field(std::string_view& rest) {
    const std::size_t comma = rest.find(',');
    const std::string_view text = rest.substr(0, comma);
    rest = comma == std::string_view::npos ? std::string_view() : rest.substr(comma + 1);
    return text;
  }

  static bool number(std::string_view text, double& value) {
    while (!text.empty() && (text.back() == '\r' || text.back() == ' ')) text.remove_suffix(1);
    while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
  }

  bool parse(Row& row) const {
    std::string_view rest = line_;
    const auto t = parse_seconds(field(rest));
    if (!t) return false;
    row.t = *t;
    for (double& value : row.values) {
      if (!number(field(rest), value)) return false;
    }
    return true;
  }

  std::ifstream file_;
  std::string line_;
  bool begun_ = false;
  Rejections rejected_;
};

}  // namespace lxd
