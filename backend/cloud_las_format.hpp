// SPDX-License-Identifier: Apache-2.0
// LAS files as they lie on the disk: little-endian, packed. LAS 1.2 (ASPRS, 2008), and of LAS 1.4 (2011) the record
// that says what stands behind each point, which readers know in files of all versions.
#pragma once

#include <cstdint>

namespace lxd {

inline constexpr double kLasScale_m = 0.001;

// Plain arrays: a member of a packed structure may lie anywhere, where std::array may not be called.
struct __attribute__((packed)) LasHeader {
  char signature[4]{'L', 'A', 'S', 'F'};
  std::uint16_t file_source_id = 0;
  std::uint16_t global_encoding = 0;
  std::uint8_t project_guid[16]{};
  std::uint8_t version_major = 1;
  std::uint8_t version_minor = 2;
  char system_identifier[32]{};
  char generating_software[32]{};
  std::uint16_t creation_day = 0;
  std::uint16_t creation_year = 0;
  std::uint16_t header_bytes = 227;
  std::uint32_t points_offset = 227;
  std::uint32_t variable_records = 0;
  std::uint8_t point_format = 1;
  std::uint16_t point_bytes = 28;
  std::uint32_t points = 0;
  std::uint32_t points_by_return[5]{};
  double scale[3]{kLasScale_m, kLasScale_m, kLasScale_m};
  double offset[3]{};
  double bounds[6]{};  // max x, min x, max y, min y, max z, min z
};
static_assert(sizeof(LasHeader) == 227);

struct __attribute__((packed)) LasPoint {
  std::int32_t position[3];
  std::uint16_t intensity = 0;
  std::uint8_t returns = 1 | 1 << 3;  // return 1 of 1
  std::uint8_t classification = 0;
  std::int8_t scan_angle = 0;
  std::uint8_t user_data = 0;
  std::uint16_t point_source = 0;
  double gps_time = 0;
};
static_assert(sizeof(LasPoint) == 28);

// What point format 3 has behind format 1.
struct __attribute__((packed)) LasColour {
  std::uint16_t rgb[3];
};

// Before what a variable length record holds.
struct __attribute__((packed)) LasRecordHeader {
  std::uint16_t reserved = 0;
  char user_id[16]{'L', 'A', 'S', 'F', '_', 'S', 'p', 'e', 'c'};
  std::uint16_t record_id = 4;  // extra bytes
  std::uint16_t bytes = 0;      // that follow
  char description[32]{};
};
static_assert(sizeof(LasRecordHeader) == 54);

// One dimension behind each point. No bit in `options` says that none of the numbers below means anything.
struct __attribute__((packed)) LasExtraDimension {
  std::uint8_t reserved[2]{};
  std::uint8_t data_type = 9;  // float
  std::uint8_t options = 0;
  char name[32]{};
  std::uint8_t unused[4]{};
  std::uint64_t no_data[3]{}, min[3]{}, max[3]{};
  double scale[3]{}, offset[3]{};
  char description[32]{};
};
static_assert(sizeof(LasExtraDimension) == 192);

}  // namespace lxd
