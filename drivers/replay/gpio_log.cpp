// SPDX-License-Identifier: Apache-2.0
#include "drivers/replay/gpio_log.hpp"

#include <charconv>
#include <fstream>
#include <optional>
#include <string>

#include <fmt/format.h>

namespace lxd {
namespace {

struct LoggedEdge {
  RigTime t;
  std::string_view line, edge;
};

std::string_view cut_field(std::string_view& rest) {
  const std::size_t comma = rest.find(',');
  const std::string_view field = rest.substr(0, comma);
  rest = comma == std::string_view::npos ? std::string_view() : rest.substr(comma + 1);
  return field;
}

std::optional<LoggedEdge> parse_gpio_edge(std::string_view row) {
  const std::string_view stamp = cut_field(row);
  std::int64_t ns = 0;
  const auto [end, error] = std::from_chars(stamp.data(), stamp.data() + stamp.size(), ns);
  (void)cut_field(row);  // the line's offset within its chip
  const std::string_view line = cut_field(row), edge = cut_field(row);
  const bool sound =
      error == std::errc() && end == stamp.data() + stamp.size() && (edge == "rising" || edge == "falling");
  return sound ? std::optional(LoggedEdge{RigTime::from_ns(ns), line, edge}) : std::nullopt;
}

}  // namespace

Result<std::vector<RigTime>> read_gpio_edges(const std::filesystem::path& path, std::string_view line, bool rising) {
  std::ifstream file(path, std::ios::binary);
  std::string row;
  if (!std::getline(file, row) || row != kGpioLogHeader)
    return Error{fmt::format("{}: line 1: found \"{:.60}\", wanted {}", path.string(), row, kGpioLogHeader)};
  std::vector<RigTime> edges;
  for (std::uint64_t number = 2; std::getline(file, row); ++number) {
    const auto edge = parse_gpio_edge(row);
    if (!edge)
      return Error{fmt::format("{}: line {}: found \"{:.60}\", wanted {}", path.string(), number, row, kGpioLogHeader)};
    if (edge->line == line && (edge->edge == "rising") == rising) edges.push_back(edge->t);
  }
  return edges;
}

}  // namespace lxd
