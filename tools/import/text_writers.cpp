// SPDX-License-Identifier: Apache-2.0
#include "tools/import/text_writers.hpp"

#include <utility>

#include "backend/part_file.hpp"
#include "backend/trajectory_writer.hpp"
#include "drivers/replay/gnss_source.hpp"
#include "drivers/replay/imu_source.hpp"
#include "drivers/replay/nmea_log_writer.hpp"
#include "drivers/ros1/inertial.hpp"
#include "drivers/ros1/satellite_fix.hpp"
#include "drivers/ros1/truth_pose.hpp"
#include "tools/recording/nmea_encoder.hpp"

namespace lxd {
namespace {

// Lines into a file that appears whole.
class LineWriter : public MessageWriter {
 public:
  explicit LineWriter(PartFile file) : file_(std::move(file)) {}
  Status close() override { return file_.commit(); }

 protected:
  Result<Ros1Fault> append(std::string_view line) {
    file_.write_text(line);
    const Status status = file_.status();
    if (!status) return status.error();
    return Ros1Fault::none;
  }

 private:
  PartFile file_;
};

class InertialWriter final : public LineWriter {
 public:
  using LineWriter::LineWriter;

 private:
  Result<Ros1Fault> write(Ros1Reader::Bytes message, RigTime received) override {
    Ros1Inertial sample;
    const Ros1Fault fault = read_ros1_inertial(message, sample);
    if (fault != Ros1Fault::none) return fault;
    const Eigen::Vector3d& w = sample.gyro_radps;
    const Eigen::Vector3d& a = sample.accel_mps2;
    return append(fmt::format("{},{},{},{},{},{},{}\n", seconds_text(time_of(sample.header, received)), w.x(), w.y(),
                              w.z(), a.x(), a.y(), a.z()));
  }
};

class TruthWriter final : public LineWriter {
 public:
  TruthWriter(MessageKind kind, PartFile file) : LineWriter(std::move(file)), kind_(kind) {}

 private:
  Ros1Fault read(Ros1Reader::Bytes message, Ros1TruthPose& pose) const {
    if (kind_ == MessageKind::pose) return read_ros1_pose(message, pose);
    return kind_ == MessageKind::transform ? read_ros1_transform(message, pose) : read_ros1_odometry(message, pose);
  }

  Result<Ros1Fault> write(Ros1Reader::Bytes message, RigTime received) override {
    Ros1TruthPose pose;
    const Ros1Fault fault = read(message, pose);
    if (fault != Ros1Fault::none) return fault;
    return append(tum_line({time_of(pose.header, received), Pose{pose.q.toRotationMatrix(), pose.p}}));
  }

  MessageKind kind_;
};

class GnssWriter final : public MessageWriter {
 public:
  GnssWriter(MessageKind kind, NmeaLogWriter log) : kind_(kind), log_(std::move(log)) {}
  Status close() override { return log_.close(); }

 private:
  Result<Ros1Fault> write(Ros1Reader::Bytes message, RigTime received) override {
    return kind_ == MessageKind::sentence ? write_sentence(message, received) : write_fix(message, received);
  }

  Result<Ros1Fault> write_sentence(Ros1Reader::Bytes message, RigTime received) {
    Ros1Sentence sentence;
    const Ros1Fault fault = read_ros1_sentence(message, sentence);
    if (fault != Ros1Fault::none) return fault;
    return append(time_of(sentence.header, received), std::string(sentence.text));
  }

  Result<Ros1Fault> write_fix(Ros1Reader::Bytes message, RigTime received) {
    Ros1SatelliteFix fix;
    const Ros1Fault fault = read_ros1_satellite_fix(message, fix);
    if (fault != Ros1Fault::none) return fault;
    const RigTime t = time_of(fix.header, received);
    for (const std::string& sentence : encode_epoch(fix.fix, {t.ns(), false})) {
      const Result<Ros1Fault> written = append(t, sentence);
      if (!written) return written.error();
    }
    return Ros1Fault::none;
  }

  Result<Ros1Fault> append(RigTime t, const std::string& sentence) {
    const std::string line = sentence + "\n";
    const Status written = log_.append(t, {reinterpret_cast<const std::uint8_t*>(line.data()), line.size()});
    if (!written) return written.error();
    return Ros1Fault::none;
  }

  MessageKind kind_;
  NmeaLogWriter log_;
};

}  // namespace

MadeWriter make_inertial_writer(const std::filesystem::path& folder) {
  Result<PartFile> file = PartFile::create(folder / kImuTextFile);
  if (!file) return file.error();
  file->write_text("t,gx,gy,gz,ax,ay,az\n");
  return std::unique_ptr<MessageWriter>(std::make_unique<InertialWriter>(std::move(*file)));
}

MadeWriter make_gnss_writer(const TopicChoice& choice, const std::filesystem::path& folder) {
  auto log = NmeaLogWriter::create(folder / kGnssFile);
  if (!log) return log.error();
  return std::unique_ptr<MessageWriter>(std::make_unique<GnssWriter>(choice.kind, std::move(*log)));
}

MadeWriter make_truth_writer(const TopicChoice& choice, const std::filesystem::path& folder) {
  Result<PartFile> file = PartFile::create(folder / "truth.tum");
  if (!file) return file.error();
  return std::unique_ptr<MessageWriter>(std::make_unique<TruthWriter>(choice.kind, std::move(*file)));
}

}  // namespace lxd
