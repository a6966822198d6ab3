// SPDX-License-Identifier: Apache-2.0
// Parser of PLY heads.
#include "backend/ply_header.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <sstream>

#include <fmt/format.h>

namespace lxd {
namespace {

constexpr int kLinesMax = 1000;  // a head longer than this is no head

struct TypeName {
  std::string_view name;
  PlyType type;
};
constexpr std::array<TypeName, 16> kTypeNames{{{"char", PlyType::i8},
                                               {"int8", PlyType::i8},
                                               {"uchar", PlyType::u8},
                                               {"uint8", PlyType::u8},
                                               {"short", PlyType::i16},
                                               {"int16", PlyType::i16},
                                               {"ushort", PlyType::u16},
                                               {"uint16", PlyType::u16},
                                               {"int", PlyType::i32},
                                               {"int32", PlyType::i32},
                                               {"uint", PlyType::u32},
                                               {"uint32", PlyType::u32},
                                               {"float", PlyType::f32},
                                               {"float32", PlyType::f32},
                                               {"double", PlyType::f64},
                                               {"float64", PlyType::f64}}};

std::optional<PlyType> type_of(std::string_view name) {
  const auto* const found = std::ranges::find(kTypeNames, name, &TypeName::name);
  if (found == kTypeNames.end()) return std::nullopt;
  return found->type;
}

std::optional<PlyProperty> parse_property(std::istringstream& words) {
  PlyProperty property;
  std::string type;
  words >> type;
  if (type == "list") {
    std::string count;
    words >> count >> type;
    property.list_count = type_of(count);
    if (!property.list_count) return std::nullopt;
  }
  const auto known = type_of(type);
  if (!known || !(words >> property.name)) return std::nullopt;
  property.type = *known;
  return property;
}

// One line of the head. False: not understood.
bool parse_line(const std::string& line, PlyHeader& header) {
  std::istringstream words(line);
  std::string keyword;
  words >> keyword;
  if (keyword == "comment" || keyword == "obj_info") return true;
  if (keyword == "format") {
    std::string format;
    words >> format;
    header.ascii = format == "ascii";
    header.big_endian = format == "binary_big_endian";
    return header.ascii || header.big_endian || format == "binary_little_endian";
  }
  if (keyword == "element") {
    PlyElement element;
    if (!(words >> element.name >> element.count)) return false;
    header.elements.push_back(std::move(element));
    return true;
  }
  if (keyword != "property" || header.elements.empty()) return false;
  auto property = parse_property(words);
  if (!property) return false;
  property->offset = header.elements.back().record_bytes();
  header.elements.back().properties.push_back(*property);
  return true;
}

template <typename T>
double load(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return static_cast<double>(value);
}

}  // namespace

std::size_t size_bytes(PlyType type) {
  constexpr std::array<std::size_t, 8> kSizes{1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

bool PlyElement::has_list() const {
  return std::ranges::any_of(properties, [](const PlyProperty& p) { return p.list_count.has_value(); });
}

std::size_t PlyElement::record_bytes() const {
  std::size_t bytes = 0;
  for (const PlyProperty& p : properties) bytes += p.list_count ? 0 : size_bytes(p.type);
  return bytes;
}

const PlyProperty* PlyElement::find(std::string_view property) const {
  const auto found = std::ranges::find(properties, property, &PlyProperty::name);
  return found == properties.end() ? nullptr : &*found;
}

const PlyElement* PlyHeader::find(std::string_view element) const {
  const auto found = std::ranges::find(elements, element, &PlyElement::name);
  return found == elements.end() ? nullptr : &*found;
}

Result<PlyHeader> read_ply_header(std::istream& in, const std::filesystem::path& name) {
  PlyHeader header;
  std::string line;
  for (int number = 1; number <= kLinesMax && std::getline(in, line); ++number) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (number == 1 && line != "ply") return Error{fmt::format("{}: not a PLY file", name.string())};
    if (line == "end_header") return header;
    if (number > 1 && !parse_line(line, header))
      return Error{fmt::format("{}:{}: found '{}', wanted a line of a PLY head", name.string(), number, line)};
  }
  return Error{fmt::format("{}: the PLY head has no end_header", name.string())};
}

double read_ply_number(const char* bytes, PlyType type) {
  switch (type) {
    case PlyType::i8:
      return load<std::int8_t>(bytes);
    case PlyType::u8:
      return load<std::uint8_t>(bytes);
    case PlyType::i16:
      return load<std::int16_t>(bytes);
    case PlyType::u16:
      return load<std::uint16_t>(bytes);
    case PlyType::i32:
      return load<std::int32_t>(bytes);
    case PlyType::u32:
      return load<std::uint32_t>(bytes);
    case PlyType::f32:
      return load<float>(bytes);
    case PlyType::f64:
      return load<double>(bytes);
  }
  return 0;
}

}  // namespace lxd
