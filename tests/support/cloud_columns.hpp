// SPDX-License-Identifier: Apache-2.0
// Point clouds as other programs read them: PLY, PCD and LAS by their heads, knowing nothing of the product's readers.
#pragma once

#include <filesystem>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/file_bytes.hpp"
#include "tests/support/temporary_folder.hpp"

namespace lxd::test {

// Numbers by the name that the file gives them, one a point.
using CloudColumns = std::map<std::string, std::vector<double>>;

struct CloudColumn {
  std::string name;
  char kind = 'F';  // F: floating, U: unsigned, I: signed
  std::size_t bytes = 4;
};

inline double column_value(const std::string& file, std::size_t at, const CloudColumn& column) {
  if (column.kind == 'F') return column.bytes == 8 ? number_at<double>(file, at) : number_at<float>(file, at);
  if (column.kind == 'I') return number_at<std::int32_t>(file, at);
  if (column.bytes == 1) return number_at<std::uint8_t>(file, at);
  return column.bytes == 2 ? number_at<std::uint16_t>(file, at) : number_at<std::uint32_t>(file, at);
}

// `records` from `data` on. Nothing when the file is not exactly as long as they are.
inline CloudColumns columns_of(const std::string& file, std::size_t data, std::size_t records,
                               const std::vector<CloudColumn>& layout) {
  std::size_t record_bytes = 0;
  for (const CloudColumn& column : layout) record_bytes += column.bytes;
  EXPECT_EQ(file.size(), data + records * record_bytes);
  CloudColumns columns;
  if (file.size() != data + records * record_bytes) return columns;
  for (const CloudColumn& column : layout) columns[column.name].reserve(records);
  for (std::size_t i = 0, at = data; i < records; ++i)
    for (const CloudColumn& column : layout) {
      columns[column.name].push_back(column_value(file, at, column));
      at += column.bytes;
    }
  return columns;
}

inline CloudColumns ply_columns(const std::filesystem::path& path) {
  const std::string file = read_file(path), end = "end_header\n";
  std::istringstream head(file.substr(0, file.find(end)));
  std::vector<CloudColumn> layout;
  std::size_t records = 0;
  for (std::string line; std::getline(head, line);) {
    std::istringstream words(line);
    std::string word, type, name;
    words >> word >> type >> name;
    if (word == "element") records = std::stoul(name);
    if (word != "property") continue;
    layout.push_back({name, type == "uchar" ? 'U' : 'F', type == "uchar" ? 1U : type == "double" ? 8U : 4U});
  }
  return columns_of(file, file.find(end) + end.size(), records, layout);
}

inline CloudColumns pcd_columns(const std::filesystem::path& path) {
  const std::string file = read_file(path), end = "DATA binary\n";
  std::istringstream head(file.substr(0, file.find(end)));
  std::map<std::string, std::vector<std::string>> lines;
  for (std::string line; std::getline(head, line);) {
    std::istringstream words(line);
    std::string key;
    words >> key;
    for (std::string word; words >> word;) lines[key].push_back(word);
  }
  std::vector<CloudColumn> layout;
  const std::size_t fields = lines["FIELDS"].size();
  EXPECT_TRUE(lines["SIZE"].size() == fields && lines["TYPE"].size() == fields && lines["COUNT"].size() == fields);
  for (std::size_t i = 0; i < fields; ++i) {
    EXPECT_EQ(lines["COUNT"].at(i), "1");
    const bool packed = lines["FIELDS"][i] == "rgb";  // bits in a float
    layout.push_back({lines["FIELDS"][i], packed ? 'U' : lines["TYPE"].at(i)[0], std::stoul(lines["SIZE"].at(i))});
  }
  EXPECT_EQ(lines["WIDTH"], lines["POINTS"]);
  return columns_of(file, file.find(end) + end.size(), std::stoul(lines["POINTS"].at(0)), layout);
}

// Point formats 1 and 3; what stands behind, by the extra bytes record (LAS 1.4, table 24).
inline CloudColumns las_columns(const std::filesystem::path& path) {
  const std::string file = read_file(path);
  EXPECT_EQ(file.substr(0, 4), "LASF");
  const bool coloured = file[104] == 3;
  std::vector<CloudColumn> layout{{"X", 'I', 4},          {"Y", 'I', 4},         {"Z", 'I', 4},
                                  {"intensity", 'U', 2},  {"returns", 'U', 1},   {"classification", 'U', 1},
                                  {"scan_angle", 'U', 1}, {"user_data", 'U', 1}, {"source", 'U', 2},
                                  {"gps_time", 'F', 8}};
  for (const char* const name : {"red", "green", "blue"})
    if (coloured) layout.push_back({name, 'U', 2});
  std::size_t at = number_at<std::uint16_t>(file, 94);
  for (auto records = number_at<std::uint32_t>(file, 100); records > 0; --records) {
    const std::size_t begin = at + 54, bytes = number_at<std::uint16_t>(file, at + 20);
    if (file.substr(at + 2, 10) == std::string("LASF_Spec\0", 10) && number_at<std::uint16_t>(file, at + 18) == 4)
      for (std::size_t extra = begin; extra < begin + bytes; extra += 192) {
        EXPECT_EQ(file[extra + 2], 9) << "a float";
        EXPECT_EQ(file[extra + 3], 0) << "without scale, offset, bounds";
        layout.push_back({file.substr(extra + 4, 32).c_str(), 'F', 4});
      }
    at = begin + bytes;
  }
  EXPECT_EQ(number_at<std::uint32_t>(file, 96), at) << "points begin behind the records";
  std::size_t point_bytes = 0;
  for (const CloudColumn& column : layout) point_bytes += column.bytes;
  EXPECT_EQ(number_at<std::uint16_t>(file, 105), point_bytes);
  CloudColumns columns = columns_of(file, at, number_at<std::uint32_t>(file, 107), layout);
  for (int axis = 0; axis < 3; ++axis)
    for (double& value : columns[std::string(1, static_cast<char>('X' + axis))])
      value = value * number_at<double>(file, 131 + 8 * axis) + number_at<double>(file, 155 + 8 * axis);
  return columns;
}

}  // namespace lxd::test
