// SPDX-License-Identifier: Apache-2.0
#include "tools/import/message_writer.hpp"

#include "tools/import/image_writer.hpp"
#include "tools/import/scan_writer.hpp"
#include "tools/import/text_writers.hpp"

namespace lxd {

Result<std::unique_ptr<MessageWriter>> MessageWriter::create(const TopicChoice& choice,
                                                             const std::filesystem::path& folder) {
  switch (choice.kind) {
    case MessageKind::point_cloud:
    case MessageKind::livox_points:
      return make_scan_writer(choice, folder);
    case MessageKind::picture:
    case MessageKind::compressed_picture:
      return make_image_writer(choice, folder);
    case MessageKind::inertial:
      return make_inertial_writer(folder);
    case MessageKind::satellite_fix:
    case MessageKind::sentence:
      return make_gnss_writer(choice, folder);
    case MessageKind::pose:
    case MessageKind::transform:
    case MessageKind::odometry:
      return make_truth_writer(choice, folder);
  }
  return Error{choice.topic};  // all kinds are above
}

Status MessageWriter::take(Ros1Reader::Bytes message, RigTime received) {
  ++counts_.messages;
  const Result<Ros1Fault> fault = write(message, received);
  if (!fault) return fault.error();
  if (*fault == Ros1Fault::none) ++counts_.written;
  if (*fault != Ros1Fault::none) count_rejected(counts_.rejected, name_of(*fault));
  return success();
}

RigTime MessageWriter::time_of(const Ros1Header& header, RigTime received) {
  if (header.is_stamped()) return header.stamp;
  ++counts_.unstamped;
  return received;
}

}  // namespace lxd
