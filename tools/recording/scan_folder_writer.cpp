// SPDX-License-Identifier: Apache-2.0
#include "tools/recording/scan_folder_writer.hpp"

#include <fmt/format.h>

#include "backend/trajectory_writer.hpp"
#include "tools/recording/whole_file.hpp"

namespace lxd {

Result<ScanFolderWriter> ScanFolderWriter::create(const std::filesystem::path& folder) {
  std::error_code cause;
  std::filesystem::create_directories(folder, cause);
  if (cause) return Error{fmt::format("{}: cannot be made: {}", folder.string(), cause.message())};
  return ScanFolderWriter(folder);
}

Status ScanFolderWriter::write(const WrittenScan& scan) {
  times_ += seconds_text(scan.begin) + "\n";
  return write_whole_file(folder_ / fmt::format("{:06}.bin", scans_++), std::as_bytes(std::span(scan.values)));
}

Status ScanFolderWriter::close() {
  return write_whole_file(folder_ / "times.txt", std::as_bytes(std::span(times_.data(), times_.size())));
}

}  // namespace lxd
