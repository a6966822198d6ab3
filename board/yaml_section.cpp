// SPDX-License-Identifier: Apache-2.0
#include "board/yaml_section.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "board/nearest_names.hpp"

namespace lxd {

std::string text_of(const ValueRange& range) {
  return fmt::format("in {} .. {}{}{}", range.low, range.high, range.unit.empty() ? "" : " ", range.unit);
}

std::string complaint_about(double value, const ValueRange& range) {
  if (!std::isfinite(value)) return fmt::format("found {}, wanted a finite number {}", value, text_of(range));
  if (value >= range.low && value <= range.high) return {};
  const bool hinted = value > range.high && !range.hint_above.empty();
  return fmt::format("found {}, wanted a number {}{}{}{}", value, text_of(range), hinted ? " (" : "",
                     hinted ? range.hint_above : "", hinted ? ")" : "");
}

std::string place_of(std::string_view file, const YAML::Mark& mark) {
  return fmt::format("{}:{}", file, std::max(mark.line, 0) + 1);
}

std::string describe(const YAML::Node& node) {
  switch (node.Type()) {
    case YAML::NodeType::Scalar:
      return fmt::format("'{}'", node.Scalar());
    case YAML::NodeType::Sequence:
      return fmt::format("a list of {}", node.size());
    case YAML::NodeType::Map:
      return "a map";
    default:
      return "nothing";
  }
}

YamlSection::YamlSection(const YAML::Node& node, std::string path, std::string_view file, Problems& problems)
    : path_(std::move(path)), file_(file), problems_(problems), mark_(node.Mark()) {
  if (!node.IsMap()) {
    add_problem(mark_, "", fmt::format("found {}, wanted keys with values", describe(node)));
    return;
  }
  for (const auto& pair : node) add(pair.first, pair.second);
}

void YamlSection::add(const YAML::Node& key, const YAML::Node& value) {
  if (!key.IsScalar())
    return add_problem(key.Mark(), "", fmt::format("found {} as a key, wanted a name", describe(key)));
  const auto [known, is_new] = entries_.try_emplace(key.Scalar(), Entry{key, value});
  if (is_new) return;
  add_problem(key.Mark(), key.Scalar(),
              fmt::format("found twice, first in line {}; wanted once", known->second.key.Mark().line + 1));
}

std::optional<YAML::Node> YamlSection::find(std::string_view key) {
  if (std::ranges::find(known_, key) == known_.end()) known_.emplace_back(key);
  const auto entry = entries_.find(std::string(key));
  if (entry == entries_.end()) return std::nullopt;
  return entry->second.value;
}

std::optional<double> YamlSection::number(const YAML::Node& node, std::string_view key, const ValueRange& range) {
  double value = 0;
  if (!node.IsScalar() || !YAML::convert<double>::decode(node, value)) {
    complain(node, key, fmt::format("found {}, wanted a number {}", describe(node), text_of(range)));
    return std::nullopt;
  }
  const std::string complaint = complaint_about(value, range);
  if (complaint.empty()) return value;
  complain(node, key, complaint);
  return std::nullopt;
}

void YamlSection::read(std::string_view key, double& value, const ValueRange& range) {
  const auto node = find(key);
  if (node) value = number(*node, key, range).value_or(value);
}

void YamlSection::read(std::string_view key, std::uint32_t& value, const ValueRange& range) {
  const auto node = find(key);
  if (!node) return;
  const auto found = number(*node, key, range);
  if (!found) return;
  if (*found != std::floor(*found)) return complain(*node, key, fmt::format("found {}, wanted a whole number", *found));
  value = static_cast<std::uint32_t>(*found);
}

void YamlSection::read(std::string_view key, bool& value) {
  const auto node = find(key);
  if (!node || (node->IsScalar() && YAML::convert<bool>::decode(*node, value))) return;
  complain(*node, key, fmt::format("found {}, wanted true or false", describe(*node)));
}

void YamlSection::read(std::string_view key, std::string& value) {
  const auto node = find(key);
  if (!node) return;
  if (!node->IsScalar() || node->Scalar().empty()) {
    return complain(*node, key, fmt::format("found {}, wanted a name", describe(*node)));
  }
  value = node->Scalar();
}

void YamlSection::read(std::string_view key, std::string& value, std::span<const std::string_view> allowed) {
  const auto node = find(key);
  if (!node) return;
  if (node->IsScalar() && std::ranges::find(allowed, node->Scalar()) != allowed.end()) {
    value = node->Scalar();
    return;
  }
  complain(*node, key, fmt::format("found {}, wanted {}", describe(*node), fmt::join(allowed, " or ")));
}

std::optional<std::vector<double>> YamlSection::read_numbers(std::string_view key, std::size_t count,
                                                             const ValueRange& range) {
  const auto node = find(key);
  if (!node) return std::nullopt;
  if (!node->IsSequence() || node->size() != count) {
    complain(*node, key, fmt::format("found {}, wanted {} numbers {}", describe(*node), count, text_of(range)));
    return std::nullopt;
  }
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) {
    const auto value = number((*node)[i], fmt::format("{}[{}]", key, i), range);
    if (value) values.push_back(*value);
  }
  if (values.size() != count) return std::nullopt;
  return values;
}

void YamlSection::reject_unknown() {
  const std::vector<std::string_view> known(known_.begin(), known_.end());
  for (const auto& [name, entry] : entries_) {
    if (std::ranges::find(known_, name) != known_.end()) continue;
    const std::string hint = did_you_mean(name, known);
    add_problem(entry.key.Mark(), name,
                "unknown key" + (hint.empty() ? fmt::format("; wanted one of {}", fmt::join(known, ", ")) : hint));
  }
}

void YamlSection::require(std::string_view key, std::string_view wanted) {
  if (!has(key)) complain(key, fmt::format("found nothing, wanted {}", wanted));
}

void YamlSection::complain(std::string_view key, std::string what) {
  const auto entry = entries_.find(std::string(key));
  add_problem(entry == entries_.end() ? mark_ : entry->second.key.Mark(), key, std::move(what));
}

void YamlSection::complain(const YAML::Node& at, std::string_view key, std::string what) {
  add_problem(at.Mark(), key, std::move(what));
}

std::string YamlSection::path_of(std::string_view key) const {
  if (path_.empty()) return std::string(key);
  return key.empty() ? path_ : fmt::format("{}.{}", path_, key);
}

void YamlSection::add_problem(const YAML::Mark& mark, std::string_view key, std::string what) {
  problems_.push_back({place_of(file_, mark), path_of(key), std::move(what)});
}

}  // namespace lxd
