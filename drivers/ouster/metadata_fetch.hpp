// SPDX-License-Identifier: Apache-2.0
// An Ouster's metadata from the sensor itself, by HTTP: firmware 2.0 and later. While loading; not for the real-time
// path.
#pragma once

#include <string>

#include "drivers/device/http_get.hpp"
#include "drivers/ouster/metadata.hpp"

namespace lxd {

struct FetchedMetadata {
  std::string json;  // to be kept with a recording
  OusterMetadata metadata;
};

// `deadline` is for each request; old firmware takes eight of them. Errors: what http_get() and parse_ouster_metadata()
// say, or the status that the sensor answers with (503: it is still starting).
Result<FetchedMetadata> fetch_ouster_metadata(const HttpTarget& sensor, Duration deadline);

}  // namespace lxd
