// SPDX-License-Identifier: Apache-2.0
// See fault_text.hpp.
#include "tools/simulator/fault_text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "board/nearest_names.hpp"

namespace lxd::sim {
namespace {

constexpr std::string_view kForm = "NAME[@BEGIN_S[+DURATION_S]][=VALUE]";

// The text cut at its separators; a part that is not there is absent, one that is empty is a mistake.
struct FaultParts {
  std::string_view name;
  std::optional<std::string_view> begin, duration, value;
};

// Cuts off what follows the separator.
std::optional<std::string_view> cut(std::string_view& text, char separator) {
  const std::size_t at = text.find(separator);
  if (at == std::string_view::npos) return std::nullopt;
  const std::string_view tail = text.substr(at + 1);
  text = text.substr(0, at);
  return tail;
}

FaultParts parts_of(std::string_view text) {
  FaultParts parts;
  parts.value = cut(text, '=');
  parts.begin = cut(text, '@');
  if (parts.begin) parts.duration = cut(*parts.begin, '+');
  parts.name = text;
  return parts;
}

std::optional<double> finite_number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  return whole && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

struct UnitRange {
  std::string_view unit;
  double least, most;
};
// Of values, by their unit: far beyond what sensors and wires do, and far within what numbers hold.
constexpr std::array<UnitRange, 5> kRanges{
    {{"part", 0, 1}, {"ppm", -1e4, 1e4}, {"s", -1e6, 1e6}, {"m", -1e5, 1e5}, {"g", 0, 1e3}}};
constexpr UnitRange kOtherRange{"", 0, 1e3};

const UnitRange& range_of(std::string_view unit) {
  const auto at = std::ranges::find(kRanges, unit, &UnitRange::unit);
  return at == kRanges.end() ? kOtherRange : *at;
}

Error bad(std::string_view text, std::string_view what) {
  return Error{fmt::format("--fault: found '{}', {} ({})", text, what, kForm)};
}

const KnownFault* find(std::string_view name, std::span<const KnownFault> known) {
  const auto at = std::ranges::find(known, name, &KnownFault::name);
  return at == known.end() ? nullptr : &*at;
}

Error unknown(std::string_view text, std::string_view name, std::span<const KnownFault> known) {
  std::vector<std::string_view> names;
  for (const KnownFault& fault : known) names.push_back(fault.name);
  return bad(text, fmt::format("wanted the name of a fault of this scenario's sensors, '{}' is none{}", name,
                               did_you_mean(name, names)));
}

// Of two faults of one name that are on at once only one could act.
bool overlap(const Fault& a, const Fault& b) { return a.name == b.name && a.begin_s < b.end_s && b.begin_s < a.end_s; }

}  // namespace

Result<Fault> parse_fault(std::string_view text, std::span<const KnownFault> known) {
  const FaultParts parts = parts_of(text);
  const KnownFault* const entry = find(parts.name, known);
  if (entry == nullptr) return unknown(text, parts.name, known);
  if (parts.value && entry->unit.empty()) return bad(text, "this fault takes no value");
  const auto begin_s = parts.begin ? finite_number(*parts.begin) : 0;
  const auto value = parts.value ? finite_number(*parts.value) : entry->value;
  if (!begin_s || *begin_s < 0) return bad(text, "wanted a begin of 0 s or later");
  if (!value) return bad(text, "wanted a number as value");
  const UnitRange& range = range_of(entry->unit);
  if (*value < range.least || *value > range.most)
    return bad(text, fmt::format("wanted a value in {} .. {} {}", range.least, range.most, entry->unit));
  Fault fault{std::string(parts.name), *begin_s, *begin_s + entry->duration_s, *value};
  if (!parts.duration) return fault;
  const auto duration_s = finite_number(*parts.duration);
  if (!duration_s || *duration_s <= 0) return bad(text, "wanted a duration above 0 s");
  fault.end_s = *begin_s + *duration_s;
  return fault;
}

Result<FaultPlan> plan_faults(std::span<const std::string> texts, std::span<const KnownFault> known,
                              double duration_s) {
  std::vector<Fault> faults;
  std::vector<std::string_view> written;  // as the user wrote them
  std::string complaints;
  const auto complain = [&](const Error& error) { complaints += (complaints.empty() ? "" : "\n") + error.message; };
  for (const std::string& text : texts) {
    const auto fault = parse_fault(text, known);
    if (!fault) {
      complain(fault.error());
    } else if (fault->begin_s >= duration_s) {
      complain(bad(text, fmt::format("wanted a begin before the recording's end at {} s", duration_s)));
    } else {
      for (std::size_t i = 0; i < faults.size(); ++i) {
        if (overlap(faults[i], *fault))
          complain(bad(text, fmt::format("wanted one that does not overlap with '{}' in time", written[i])));
      }
      faults.push_back(*fault);
      written.push_back(text);
    }
  }
  if (!complaints.empty()) return Error{complaints};
  return FaultPlan(std::move(faults));
}

std::string fault_list(std::span<const KnownFault> known) {
  std::string list;
  for (const KnownFault& fault : known) {
    list += fmt::format("  {:<24} {}", fault.name, fault.what);
    if (!fault.unit.empty()) list += fmt::format("; {} {}", fault.value, fault.unit);
    list += std::isfinite(fault.duration_s) ? fmt::format("; for {} s\n", fault.duration_s) : "; to the end\n";
  }
  return list;
}

}  // namespace lxd::sim
