// SPDX-License-Identifier: Apache-2.0
// Reads /proc/self/maps (see the header).
#include "rt/memory_map.hpp"

#include <charconv>
#include <fstream>
#include <system_error>

namespace lxd {
namespace {

constexpr int kHex = 16;
constexpr int kDecimal = 10;

// Takes what stands before the separator off the front of text; all of it when there is none.
std::string_view take_until(std::string_view& text, char separator) {
  const std::size_t end = text.find(separator);
  const std::string_view field = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return field;
}

template <typename Number>
bool parse_number(std::string_view text, int base, Number& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number, base);
  return error == std::errc{} && end == text.data() + text.size();
}

std::string_view trim_left(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(' ');
  return begin == std::string_view::npos ? std::string_view{} : text.substr(begin);
}

}  // namespace

Result<Mapping> parse_mapping(std::string_view line) {
  constexpr std::size_t kModeLetters = 4;
  std::string_view rest = line;
  Mapping mapping;
  const bool begin_ok = parse_number(take_until(rest, '-'), kHex, mapping.begin);
  const bool end_ok = parse_number(take_until(rest, ' '), kHex, mapping.end);
  const std::string_view mode = take_until(rest, ' ');
  take_until(rest, ' ');  // offset in the file
  take_until(rest, ' ');  // device
  const bool inode_ok = parse_number(take_until(rest, ' '), kDecimal, mapping.inode);
  if (!begin_ok || !end_ok || !inode_ok || mode.size() != kModeLetters || mapping.end < mapping.begin)
    return Error{"/proc/self/maps: found \"" + std::string(line) +
                 "\", wanted begin-end mode offset device inode name"};
  mapping.readable = mode[0] == 'r';
  mapping.writable = mode[1] == 'w';
  mapping.executable = mode[2] == 'x';
  mapping.shared = mode[3] == 's';
  mapping.name = trim_left(rest);
  return mapping;
}

Result<std::vector<Mapping>> read_memory_map() {
  std::ifstream file("/proc/self/maps");
  if (!file) return Error{"/proc/self/maps: cannot be opened; wanted a mounted /proc"};
  std::vector<Mapping> mappings;
  for (std::string line; std::getline(file, line);) {
    const Result<Mapping> mapping = parse_mapping(line);
    if (!mapping) return mapping.error();
    mappings.push_back(*mapping);
  }
  return mappings;
}

}  // namespace lxd
