// SPDX-License-Identifier: Apache-2.0
// Reads values out of a JSON document and collects every fault with its path, so that a user sees all of them at once.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace lxd {

class JsonReader {
 public:
  struct Bounds {
    double low = 0, high = 0;
  };

  JsonReader(const nlohmann::json& root, std::string file) : root_(root), file_(std::move(file)) {}

  // Paths are keys with dots between. Null when absent.
  [[nodiscard]] const nlohmann::json* find(const std::string& path) const;
  [[nodiscard]] bool has_object(const std::string& path) const;

  // Each returns none, and records a fault, when the value is there but wrong; `want` records one when it is absent
  // too.
  std::optional<std::string> text(const std::string& path);
  std::optional<std::int64_t> integer(const std::string& path, Bounds bounds);
  std::optional<std::int64_t> want_integer(const std::string& path, Bounds bounds);
  std::optional<std::vector<double>> numbers(const std::string& path, std::size_t count, Bounds bounds);
  std::optional<std::vector<double>> want_numbers(const std::string& path, std::size_t count, Bounds bounds);

  void fault(const std::string& path, const std::string& sentence);
  void fault_missing(const std::string& path, const std::string& wanted);
  [[nodiscard]] bool sound() const { return faults_.empty(); }
  [[nodiscard]] const std::string& faults() const { return faults_; }

 private:
  const nlohmann::json& root_;
  std::string file_;
  std::string faults_;
};

}  // namespace lxd
