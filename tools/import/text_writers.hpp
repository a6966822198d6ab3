// SPDX-License-Identifier: Apache-2.0
// Messages into the texts of a generic folder: imu.csv, gnss.nmea, truth.tum.
#pragma once

#include "tools/import/message_writer.hpp"

namespace lxd {

using MadeWriter = Result<std::unique_ptr<MessageWriter>>;

MadeWriter make_inertial_writer(const std::filesystem::path& folder);
MadeWriter make_gnss_writer(const TopicChoice& choice, const std::filesystem::path& folder);
MadeWriter make_truth_writer(const TopicChoice& choice, const std::filesystem::path& folder);

}  // namespace lxd
