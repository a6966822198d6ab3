// SPDX-License-Identifier: Apache-2.0
// An output file that appears whole or not at all: written as `<path>.part`, flushed to the disk and renamed by
// commit(). The process being killed leaves the `.part`; a writer destroyed without commit() removes it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "rt/result.hpp"

namespace lxd {

class PartFile {
 public:
  // Error: the file cannot be made (path and the system's cause).
  static Result<PartFile> create(const std::filesystem::path& path);
  PartFile(PartFile&& other) noexcept;
  PartFile& operator=(PartFile&&) = delete;
  ~PartFile();

  // Buffered. After a failure (disk full, ...) nothing more is written; status() and commit() tell the first cause.
  void write(std::span<const std::byte> bytes);
  void write_text(std::string_view text);
  template <typename T>
  void write_values(std::span<const T> values) {
    write(std::as_bytes(values));
  }
  template <typename T>
  void write_value(const T& value) {
    write_values(std::span<const T>(&value, 1));
  }
  // Overwrites bytes that were written before, e.g. a count in the header. Flushes.
  void overwrite(std::uint64_t offset, std::span<const std::byte> bytes);
  void flush();
  // After a failure: goes on behind what was flushed whole; what was not is lost.
  void resume();

  [[nodiscard]] bool ok() const { return cause_ == 0; }
  [[nodiscard]] Status status() const;
  [[nodiscard]] std::uint64_t size_bytes() const { return flushed_ + buffer_.size(); }

  // Flush, fsync, rename. Nothing may be written afterwards.
  Status commit();

 private:
  PartFile(int descriptor, std::filesystem::path path);
  void write_through(std::span<const std::byte> bytes, std::uint64_t offset);
  [[nodiscard]] std::filesystem::path part_path() const;

  int descriptor_ = -1;
  int cause_ = 0;  // errno of the first failure
  std::uint64_t flushed_ = 0;
  std::filesystem::path path_;
  std::vector<std::byte> buffer_;
};

}  // namespace lxd
