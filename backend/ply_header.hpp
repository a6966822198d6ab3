// SPDX-License-Identifier: Apache-2.0
// The head of a PLY file (Turk 1994): which elements with which properties, and where the data begins.
#pragma once

#include <cstdint>
#include <filesystem>
#include <istream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rt/result.hpp"

namespace lxd {

enum class PlyType { i8, u8, i16, u16, i32, u32, f32, f64 };
std::size_t size_bytes(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::f32;
  std::optional<PlyType> list_count;  // of a list: the type of its count
  std::size_t offset = 0;             // bytes from the start of a record; means nothing after a list
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;

  [[nodiscard]] bool has_list() const;
  [[nodiscard]] std::size_t record_bytes() const;  // without lists
  [[nodiscard]] const PlyProperty* find(std::string_view property) const;
};

struct PlyHeader {
  bool ascii = false;
  bool big_endian = false;  // of a binary file
  std::vector<PlyElement> elements;
  [[nodiscard]] const PlyElement* find(std::string_view element) const;
};

// Reads up to and with `end_header`. Error: file, line, found, wanted.
Result<PlyHeader> read_ply_header(std::istream& in, const std::filesystem::path& name);

// One number of a little-endian record as double.
double read_ply_number(const char* bytes, PlyType type);

}  // namespace lxd
