// SPDX-License-Identifier: Apache-2.0
// Any text as sensor metadata: refused with a message, or good enough to build every table from.
#include <cstdlib>

#include "drivers/ouster/sweep_builder.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lxd;
  const auto metadata = parse_ouster_metadata({reinterpret_cast<const char*>(data), size}, "fuzz.json");
  if (!metadata) {
    if (metadata.error().message.empty()) std::abort();
    return 0;
  }
  const OusterXyzTable table(*metadata);
  const std::size_t pixels = std::size_t{metadata->columns_per_frame} * metadata->format.pixels_per_column;
  if (pixels == 0 || !table.point(pixels - 1, 1000).allFinite()) std::abort();
  return 0;
}
