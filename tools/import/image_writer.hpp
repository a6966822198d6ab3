// SPDX-License-Identifier: Apache-2.0
// A camera's messages into camera0/: PNG files, or compressed images as they came, with times.txt.
#pragma once

#include "tools/import/message_writer.hpp"

namespace lxd {

Result<std::unique_ptr<MessageWriter>> make_image_writer(const TopicChoice& choice,
                                                         const std::filesystem::path& folder);

}  // namespace lxd
