// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/lidar/scan_files.hpp"

#include <fmt/format.h>

#include "tools/simulator/whole_file.hpp"

namespace lxd::sim {

Result<ScanFolder> ScanFolder::create(const std::filesystem::path& folder) {
  std::error_code cause;
  std::filesystem::create_directories(folder, cause);
  if (cause) return Error{fmt::format("{}: cannot be made: {}", folder.string(), cause.message())};
  return ScanFolder(folder);
}

Status ScanFolder::write(const ScanFile& scan) {
  times_ += fmt::format("{}.{:09}\n", scan.begin.ns() / kNanosPerSecond, scan.begin.ns() % kNanosPerSecond);
  return write_whole_file(folder_ / fmt::format("{:06}.bin", scans_++), std::as_bytes(std::span(scan.values)));
}

Status ScanFolder::close() {
  return write_whole_file(folder_ / "times.txt", std::as_bytes(std::span(times_.data(), times_.size())));
}

}  // namespace lxd::sim
