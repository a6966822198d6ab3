// SPDX-License-Identifier: Apache-2.0
// See pps_log.hpp.
#include "drivers/replay/pps_log.hpp"

#include <charconv>
#include <fstream>
#include <optional>
#include <string>

#include <fmt/format.h>

namespace lxd {
namespace {

std::optional<PpsEdge> parse_edge(std::string_view line) {
  std::int64_t ns = 0;
  PpsEdge edge;
  const char* const end = line.data() + line.size();
  const auto [comma, time_error] = std::from_chars(line.data(), end, ns);
  if (time_error != std::errc() || comma == end || *comma != ',') return std::nullopt;
  const auto [rest, sequence_error] = std::from_chars(comma + 1, end, edge.sequence);
  if (sequence_error != std::errc() || rest != end) return std::nullopt;
  edge.asserted = RigTime::from_ns(ns);
  return edge;
}

bool next_line(std::ifstream& file, std::string& line) {
  if (!std::getline(file, line)) return false;
  if (line.ends_with('\r')) line.pop_back();
  return true;
}

}  // namespace

Result<PpsLog> read_pps_log(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string line;
  if (!next_line(file, line) || line != kPpsLogHeader)
    return Error{fmt::format("{}: line 1: found \"{:.40}\", wanted {}", path.string(), line, kPpsLogHeader)};
  PpsLog log;
  for (std::uint64_t number = 2; next_line(file, line); ++number) {
    if (line.empty()) continue;
    const auto edge = parse_edge(line);
    if (!edge || (!log.edges.empty() && edge->sequence <= log.edges.back().sequence))
      return Error{fmt::format("{}: line {}: found \"{:.40}\", wanted unix ns and a growing count", path.string(),
                               number, line)};
    if (!log.edges.empty()) log.lost += edge->sequence - log.edges.back().sequence - 1;
    log.edges.push_back(*edge);
  }
  return log;
}

Result<std::vector<RigTime>> recorded_pulses(const std::filesystem::path& folder, bool pulsed) {
  std::vector<RigTime> pulses;
  std::error_code ignored;
  if (!pulsed || !std::filesystem::exists(folder / kPpsLogFile, ignored)) return pulses;
  const auto log = read_pps_log(folder / kPpsLogFile);
  if (!log) return log.error();
  for (const PpsEdge& edge : log->edges) pulses.push_back(edge.asserted);
  return pulses;
}

}  // namespace lxd
