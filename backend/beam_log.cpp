// SPDX-License-Identifier: Apache-2.0
#include "backend/beam_log.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace lxd {
namespace {

constexpr float kStep_m = 0.004F, kShare = 1.0F / UINT16_MAX;

// As they lie in the file: the head of a sweep, then its beams.
struct SweepHead {
  std::array<double, 3> lidar_m;
  std::array<float, 3> way_m;  // during the span
  std::uint32_t count;
};
struct PackedBeam {
  std::array<std::int16_t, 3> steps;  // from the LiDAR's place at the sweep's end
  std::uint16_t to_come;
};

PackedBeam packed(const Eigen::Vector3f& beam_m, float to_come) {
  const auto steps = [](float m) { return static_cast<std::int16_t>(std::lround(m / kStep_m)); };
  const auto share = static_cast<std::uint16_t>(std::lround(std::clamp(to_come, 0.0F, 1.0F) / kShare));
  return {{steps(beam_m.x()), steps(beam_m.y()), steps(beam_m.z())}, share};
}

template <typename T>
void put(std::vector<std::byte>& bytes, const T& value) {
  const auto* const begin = reinterpret_cast<const std::byte*>(&value);
  bytes.insert(bytes.end(), begin, begin + sizeof(T));
}

}  // namespace

Result<BeamLog> BeamLog::create(const std::filesystem::path& folder) {
  auto file = ScratchFile::create(folder);
  if (!file) return file.error();
  return BeamLog(std::move(*file));
}

void BeamLog::clear() {
  end_ = count_ = passed_ = 0;
  stride_ = 1;
}

Status BeamLog::add(const BeamSweep& sweep) {
  if (++passed_ < stride_) return success();
  passed_ = 0;
  SweepHead head{};
  Eigen::Map<Eigen::Vector3d>(head.lidar_m.data()) = sweep.lidar_m;
  Eigen::Map<Eigen::Vector3f>(head.way_m.data()) = (sweep.lidar_m - sweep.lidar_then_m).cast<float>();
  record_.resize(sizeof head);
  for (const BeamSweep::Return& seen : sweep.returns) {
    const Eigen::Vector3f beam_m = (seen.p_m - sweep.lidar_m).cast<float>();
    if (!(beam_m.lpNorm<Eigen::Infinity>() < kReach_m)) continue;
    put(record_, packed(beam_m, seen.to_come));
    ++head.count;
  }
  std::memcpy(record_.data(), &head, sizeof head);
  Status written = file_.write(end_, record_);
  if (!written) return written;
  end_ += record_.size();
  count_ += head.count;
  stride_ = std::uint64_t{1} << std::min<std::uint64_t>(count_ / kBeamsAStride, 32);
  return success();
}

std::span<const Beam> BeamReader::next() {
  beams_.clear();
  SweepHead head{};
  while (status_ && beams_.empty() && at_ < log_->end_) {
    status_ = log_->file_.read(at_, std::as_writable_bytes(std::span(&head, 1)));
    if (!status_) break;
    record_.resize(head.count * sizeof(PackedBeam));
    status_ = log_->file_.read(at_ + sizeof head, record_);
    if (!status_) break;
    at_ += sizeof head + record_.size();
    const Eigen::Map<const Eigen::Vector3d> lidar_m(head.lidar_m.data());
    const Eigen::Map<const Eigen::Vector3f> way_m(head.way_m.data());
    for (std::uint32_t i = 0; i < head.count; ++i) {
      PackedBeam beam{};
      std::memcpy(&beam, &record_[i * sizeof beam], sizeof beam);
      const Eigen::Vector3f end_m(beam.steps[0], beam.steps[1], beam.steps[2]);
      beams_.push_back(
          {lidar_m - (beam.to_come * kShare * way_m).cast<double>(), lidar_m + (kStep_m * end_m).cast<double>()});
    }
  }
  return beams_;
}

}  // namespace lxd
