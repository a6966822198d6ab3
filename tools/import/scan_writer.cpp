// SPDX-License-Identifier: Apache-2.0
#include "tools/import/scan_writer.hpp"

#include <utility>

#include "drivers/ros1/livox_points.hpp"
#include "drivers/ros1/point_cloud.hpp"
#include "tools/recording/scan_folder_writer.hpp"

namespace lxd {
namespace {

class ScanWriter final : public MessageWriter {
 public:
  ScanWriter(MessageKind kind, ScanFolderWriter scans) : kind_(kind), scans_(std::move(scans)) {}

  Status close() override { return scans_.close(); }

 private:
  Result<Ros1Fault> write(Ros1Reader::Bytes message, RigTime received) override {
    const Ros1Fault fault = kind_ == MessageKind::livox_points ? read_ros1_livox_points(message, scan_)
                                                               : read_ros1_point_cloud(message, scan_);
    count_rejected(counts_.rejected, "no_return", scan_.no_return);
    count_rejected(counts_.rejected, "non_finite_point", scan_.non_finite);
    if (fault != Ros1Fault::none) return fault;
    if (!scan_.has_times) ++counts_.remarks["points have no times: sweeps will not be deskewed"];
    file_.begin = time_of(scan_.header, received) + scan_.first;
    file_.values.clear();
    for (const Ros1Point& point : scan_.points)
      file_.push(point.x_m, point.y_m, point.z_m, point.intensity, Duration::from_ns(point.offset_ns).seconds());
    const Status written = scans_.write(file_);
    if (!written) return written.error();
    return Ros1Fault::none;
  }

  MessageKind kind_;
  ScanFolderWriter scans_;
  Ros1Scan scan_;
  WrittenScan file_;
};

}  // namespace

Result<std::unique_ptr<MessageWriter>> make_scan_writer(const TopicChoice& choice,
                                                        const std::filesystem::path& folder) {
  auto scans = ScanFolderWriter::create(folder / choice.sensor);
  if (!scans) return scans.error();
  return std::unique_ptr<MessageWriter>(std::make_unique<ScanWriter>(choice.kind, std::move(*scans)));
}

}  // namespace lxd
