// SPDX-License-Identifier: Apache-2.0
// A file of records that grows while it may be read, cut off or run out of disk: whatever happens, what is there are
// whole records. One thread at a time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <span>
#include <string>
#include <vector>

#include "drivers/device/file_descriptor.hpp"
#include "rt/result.hpp"

namespace lxd {

class GrowingFile {
 public:
  // Made anew. Errors, here and below, name the file and the system's cause; after the first the file takes nothing
  // more, and ends behind the last record that was flushed whole.
  static Result<GrowingFile> create(const std::filesystem::path& path);

  // One record, in pieces. It waits in memory, at most kBufferBytes of them together, until it is flushed.
  using Piece = std::span<const std::uint8_t>;
  Status append(std::initializer_list<Piece> pieces);
  // All records are with the operating system: killing this process loses none of them.
  Status flush();
  // All are on the disk: nor does a power cut.
  Status sync();
  // Flushes to the disk. Nothing may be appended afterwards.
  Status close();

  [[nodiscard]] std::uint64_t flushed_bytes() const { return flushed_; }

  static constexpr std::size_t kBufferBytes = 256 * 1024;

 private:
  GrowingFile(FileDescriptor file, std::string name);
  Status write(Piece bytes);
  Status fail();

  FileDescriptor file_;
  std::string name_;
  std::vector<std::uint8_t> buffer_;
  std::uint64_t flushed_ = 0;  // whole records
  int cause_ = 0;              // errno of the first failure
};

}  // namespace lxd
