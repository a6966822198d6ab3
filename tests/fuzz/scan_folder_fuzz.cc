// SPDX-License-Identifier: Apache-2.0
// Any bytes as times.txt and scan files of a generic folder. The text up to the first NUL is times.txt; the rest is
// 000000.bin, and once more 000001.bin.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "drivers/replay/open.hpp"

namespace {

namespace fs = std::filesystem;

const fs::path& folder() {
  static const fs::path path = [] {
    std::string name = (fs::temp_directory_path() / "lxd_fuzz_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) std::abort();
    fs::create_directories(fs::path(name) / "lidar0");
    std::atexit([] { fs::remove_all(folder()); });
    return fs::path(name);
  }();
  return path;
}

void write(const char* name, const std::uint8_t* begin, const std::uint8_t* end) {
  std::ofstream(folder() / "lidar0" / name, std::ios::binary)
      .write(reinterpret_cast<const char*>(begin), static_cast<std::streamsize>(end - begin));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lxd;
  const std::uint8_t* const end = data + size;
  const std::uint8_t* const nul = std::find(data, end, std::uint8_t{0});
  const std::uint8_t* const scan = nul == end ? end : nul + 1;
  write("times.txt", data, nul);
  write("000000.bin", scan, end);
  write("000001.bin", scan, end);
  auto source = open_recording(folder(), {});
  if (!source) return 0;
  std::vector<LidarPoint> storage(64);
  Sweep sweep;
  sweep.storage = storage;
  for (;;) {
    const auto more = (*source)->next(sweep);
    if (!more.ok()) std::abort();
    if (!*more) return 0;
    for (const LidarPoint& p : sweep.points()) {
      if (!std::isfinite(p.x_m + p.y_m + p.z_m) || sweep.begin + Duration::from_ns(p.offset_ns) > sweep.end)
        std::abort();
    }
  }
}
