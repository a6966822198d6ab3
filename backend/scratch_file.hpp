// SPDX-License-Identifier: Apache-2.0
// A file for what is too much to be held in memory: it has no name, so that nothing of it is left behind however the
// process ends.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

#include "rt/result.hpp"

namespace lxd {

class ScratchFile {
 public:
  // On the folder's disk. Error: folder and the system's cause.
  static Result<ScratchFile> create(const std::filesystem::path& folder);
  ScratchFile(ScratchFile&& other) noexcept;
  ScratchFile& operator=(ScratchFile&&) = delete;
  ~ScratchFile();

  Status write(std::uint64_t offset, std::span<const std::byte> bytes);
  // Error: also where it ends before.
  Status read(std::uint64_t offset, std::span<std::byte> bytes) const;

 private:
  ScratchFile(int descriptor, std::filesystem::path folder) : descriptor_(descriptor), folder_(std::move(folder)) {}

  int descriptor_ = -1;
  std::filesystem::path folder_;
};

}  // namespace lxd
