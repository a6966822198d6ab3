// SPDX-License-Identifier: Apache-2.0
// One map of a YAML file, read key by key: types, ranges and units are checked, problems are collected, and whatever
// was not asked for is an unknown key. Loading only.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <yaml-cpp/yaml.h>

#include "board/problems.hpp"

namespace lxd {

// What a number may be, with what a number far outside is probably given in instead.
struct ValueRange {
  double low = 0;
  double high = 0;
  std::string_view unit;
  std::string_view hint_above;  // e.g. "is it in millimetres?"
};

// "in 0 .. 1000 m"
std::string text_of(const ValueRange& range);
// A complaint about a value outside, nothing for a value inside.
std::string complaint_about(double value, const ValueRange& range);

class YamlSection {
 public:
  // `path` is the key path of the map itself ("lidar0"; empty for the root); problems go to `problems`.
  YamlSection(const YAML::Node& node, std::string path, std::string_view file, Problems& problems);

  // Each leaves `value` as it is when the key is missing or wrong.
  void read(std::string_view key, double& value, const ValueRange& range);
  void read(std::string_view key, std::uint32_t& value, const ValueRange& range);
  void read(std::string_view key, bool& value);  // as YAML 1.1 writes it: true, yes, on; false, no, off
  void read(std::string_view key, std::string& value, std::span<const std::string_view> allowed);
  void read(std::string_view key, std::string& value);
  // Exactly count numbers.
  [[nodiscard]] std::optional<std::vector<double>> read_numbers(std::string_view key, std::size_t count,
                                                                const ValueRange& range);

  // A map within this one, whose path goes on with `key`.
  [[nodiscard]] YamlSection below(const YAML::Node& node, std::string_view key) const {
    return {node, path_of(key), file_, problems_};
  }

  // The node of a key, which counts as known from now on; nothing when the file does not have it.
  [[nodiscard]] std::optional<YAML::Node> find(std::string_view key);
  [[nodiscard]] bool has(std::string_view key) const { return entries_.contains(std::string(key)); }

  // Called last: what was never asked for is a problem, with the nearest of what was.
  void reject_unknown();

  void complain(std::string_view key, std::string what);                        // at the key's own line
  void complain(const YAML::Node& at, std::string_view key, std::string what);  // at a node's line
  // Complains when the key is missing.
  void require(std::string_view key, std::string_view wanted);
  [[nodiscard]] std::string path_of(std::string_view key) const;

 private:
  struct Entry {
    YAML::Node key;
    YAML::Node value;
  };
  void add(const YAML::Node& key, const YAML::Node& value);
  void add_problem(const YAML::Mark& mark, std::string_view key, std::string what);
  std::optional<double> number(const YAML::Node& node, std::string_view key, const ValueRange& range);

  std::string path_;
  std::string_view file_;
  Problems& problems_;
  YAML::Mark mark_;
  std::map<std::string, Entry> entries_;
  std::vector<std::string> known_;
};

// file:line, lines from 1; a node that the file does not have is in its first line.
std::string place_of(std::string_view file, const YAML::Mark& mark);

// A node as a message quotes it: 'text', "a list of 3", "a map", "nothing".
std::string describe(const YAML::Node& node);

}  // namespace lxd
