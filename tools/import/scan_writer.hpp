// SPDX-License-Identifier: Apache-2.0
// A LiDAR's messages into lidar0/ or lidar1/: scans with times.txt.
#pragma once

#include "tools/import/message_writer.hpp"

namespace lxd {

Result<std::unique_ptr<MessageWriter>> make_scan_writer(const TopicChoice& choice, const std::filesystem::path& folder);

}  // namespace lxd
