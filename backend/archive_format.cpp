// SPDX-License-Identifier: Apache-2.0
// Identification of archive files and the packing of poses.
#include "backend/archive_format.hpp"

#include <cmath>
#include <cstring>
#include <fstream>
#include <string_view>

#include <fmt/format.h>

namespace lxd {
namespace {

constexpr std::size_t kHeaderBytes = 100;
constexpr std::string_view kMagic{"SQLite format 3\0", 16};
constexpr std::size_t kPageSizeAt = 16;  // u16, where 1 stands for 65536
constexpr std::size_t kPageCountAt = 28;
constexpr std::size_t kUserVersionAt = 60;
constexpr std::size_t kApplicationIdAt = 68;

using Header = std::array<char, kHeaderBytes>;

// SQLite's header is big-endian.
std::uint32_t read_big_endian(const Header& header, std::size_t offset, std::size_t bytes) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < bytes; ++i) value = value << 8U | static_cast<unsigned char>(header[offset + i]);
  return value;
}

std::uint64_t wanted_bytes(const Header& header) {
  const std::uint32_t page = read_big_endian(header, kPageSizeAt, 2);
  return std::uint64_t{page == 1 ? 65536 : page} * read_big_endian(header, kPageCountAt, 4);
}

// With a log beside it, the rest of a short file is still in the log.
bool has_log(const std::filesystem::path& path) {
  std::error_code ignored;
  const auto size = std::filesystem::file_size(path.string() + "-wal", ignored);
  return !ignored && size > 0;
}

}  // namespace

Result<bool> has_colours(const Database& database) {
  Result<Statement> table = database.prepare("SELECT 1 FROM sqlite_master WHERE type = 'table' AND name = 'colour'");
  if (!table.ok()) return table.error();
  return table->step();
}

PackedPose pack(const Pose& T) {
  PackedPose packed;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) packed[4 * row + column] = T.R(row, column);
    packed[4 * row + 3] = T.p[row];
  }
  return packed;
}

std::optional<Pose> unpack_pose(std::span<const std::byte> blob) {
  PackedPose packed;
  if (blob.size() != sizeof(packed)) return std::nullopt;
  std::memcpy(packed.data(), blob.data(), sizeof(packed));
  Pose T;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) T.R(row, column) = packed[4 * row + column];
    T.p[row] = packed[4 * row + 3];
  }
  if (!T.R.allFinite() || !T.p.allFinite()) return std::nullopt;
  return T;
}

Status check_archive_header(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return Error{fmt::format("{}: cannot be read: {}", path.string(), std::strerror(errno))};
  Header header{};
  file.read(header.data(), header.size());
  const std::string_view magic(header.data(), kMagic.size());
  if (file.gcount() < static_cast<std::streamsize>(kHeaderBytes) || magic != kMagic)
    return Error{fmt::format("{}: not a map archive (no SQLite header)", path.string())};
  if (const auto id = read_big_endian(header, kApplicationIdAt, 4); id != kArchiveApplicationId)
    return Error{fmt::format("{}: a database, but no map archive: application id {:#010x}, wanted {:#010x}",
                             path.string(), id, kArchiveApplicationId)};
  if (const auto version = read_big_endian(header, kUserVersionAt, 4);
      version != kArchiveVersion && version != kColouredArchiveVersion)
    return Error{fmt::format("{}: archive version {}, this program reads version {} and {}", path.string(), version,
                             kArchiveVersion, kColouredArchiveVersion)};
  std::error_code cause;
  const auto size = std::filesystem::file_size(path, cause);
  if (!cause && size < wanted_bytes(header) && !has_log(path))
    return Error{fmt::format("{}: truncated: {} bytes, wanted {}", path.string(), size, wanted_bytes(header))};
  return success();
}

}  // namespace lxd
