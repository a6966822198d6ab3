// SPDX-License-Identifier: Apache-2.0
// See json_reader.hpp.
#include "drivers/ouster/json_reader.hpp"

#include <fmt/format.h>

namespace lxd {

using nlohmann::json;

namespace {

bool within(double value, JsonReader::Bounds bounds) { return value >= bounds.low && value <= bounds.high; }

// Enough to recognise the value by; a whole array would drown the message.
std::string excerpt(const json& value) {
  constexpr std::size_t kLongest = 40;
  std::string text = value.dump(-1, ' ', true, json::error_handler_t::replace);
  if (text.size() > kLongest) text = text.substr(0, kLongest) + "...";
  return text;
}

}  // namespace

const json* JsonReader::find(const std::string& path) const {
  const json* node = &root_;
  for (std::size_t begin = 0; begin <= path.size();) {
    const std::size_t end = std::min(path.find('.', begin), path.size());
    if (!node->is_object()) return nullptr;
    const auto member = node->find(path.substr(begin, end - begin));
    if (member == node->end()) return nullptr;
    node = &*member;
    begin = end + 1;
  }
  return node;
}

bool JsonReader::has_object(const std::string& path) const {
  const json* const node = find(path);
  return node != nullptr && node->is_object();
}

std::optional<std::string> JsonReader::text(const std::string& path) {
  const json* const node = find(path);
  if (node == nullptr) return std::nullopt;
  if (node->is_string()) return node->get<std::string>();
  fault(path, fmt::format("found {}, wanted a text", excerpt(*node)));
  return std::nullopt;
}

std::optional<std::int64_t> JsonReader::integer(const std::string& path, Bounds bounds) {
  const json* const node = find(path);
  if (node == nullptr) return std::nullopt;
  if (node->is_number_integer() && within(node->get<double>(), bounds)) return node->get<std::int64_t>();
  fault(path, fmt::format("found {}, wanted an integer in [{}, {}]", excerpt(*node), bounds.low, bounds.high));
  return std::nullopt;
}

std::optional<std::int64_t> JsonReader::want_integer(const std::string& path, Bounds bounds) {
  if (find(path) == nullptr) fault_missing(path, fmt::format("an integer in [{}, {}]", bounds.low, bounds.high));
  return integer(path, bounds);
}

std::optional<std::vector<double>> JsonReader::numbers(const std::string& path, std::size_t count, Bounds bounds) {
  const json* const node = find(path);
  if (node == nullptr) return std::nullopt;
  if (!node->is_array() || node->size() != count) {
    const std::string found = node->is_array() ? fmt::format("{} entries", node->size()) : excerpt(*node);
    fault(path, fmt::format("found {}, wanted {} numbers", found, count));
    return std::nullopt;
  }
  std::vector<double> values;
  for (const json& entry : *node) {
    if (!entry.is_number() || !within(entry.get<double>(), bounds)) {
      fault(path, fmt::format("found {} at entry {}, wanted a number in [{}, {}]", excerpt(entry), values.size(),
                              bounds.low, bounds.high));
      return std::nullopt;
    }
    values.push_back(entry.get<double>());
  }
  return values;
}

std::optional<std::vector<double>> JsonReader::want_numbers(const std::string& path, std::size_t count, Bounds bounds) {
  if (find(path) == nullptr) fault_missing(path, fmt::format("{} numbers", count));
  return numbers(path, count, bounds);
}

void JsonReader::fault(const std::string& path, const std::string& sentence) {
  if (!faults_.empty()) faults_ += '\n';
  faults_ += fmt::format("{}: {}: {}", file_, path, sentence);
}

void JsonReader::fault_missing(const std::string& path, const std::string& wanted) {
  fault(path, "found nothing, wanted " + wanted);
}

}  // namespace lxd
