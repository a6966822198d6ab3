// SPDX-License-Identifier: Apache-2.0
#include "board/earlier_map.hpp"

#include <utility>

#include <fmt/format.h>

#include "board/run_folder.hpp"

namespace lxd {
namespace {

namespace fs = std::filesystem;

bool same_folder(const fs::path& a, const fs::path& b) {
  std::error_code cause;
  return fs::equivalent(a.empty() ? "." : a, b.empty() ? "." : b, cause) && !cause;
}

}  // namespace

Result<std::optional<EarlierMap>> open_earlier_map(const EarlierMapRequest& request, const fs::path& out) {
  if (!request.file) {
    if (request.localise) return Error{"--localise: found no --map, wanted the map to find the way in"};
    return std::optional<EarlierMap>();
  }
  std::error_code ignored;
  const fs::path file = fs::is_directory(*request.file, ignored) ? *request.file / run_files::kArchive : *request.file;
  if (same_folder(file.parent_path(), out))
    return Error{fmt::format("{}: found the folder of the earlier map, wanted another one for this run", out.string())};
  auto archive = Archive::open(file);
  if (!archive) return archive.error();
  if (archive->totals().submeshes == 0)
    return Error{fmt::format("{}: found no sub-mesh in it, wanted a map", file.string())};
  return std::optional(EarlierMap{file, request.localise, std::make_shared<const Archive>(std::move(*archive))});
}

}  // namespace lxd
