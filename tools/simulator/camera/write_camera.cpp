// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/camera/write_camera.hpp"

#include <atomic>
#include <span>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "tools/recording/png_writer.hpp"
#include "tools/recording/whole_file.hpp"
#include "tools/simulator/camera/camera_faults.hpp"
#include "tools/simulator/camera/renderer.hpp"

namespace lxd::sim {
namespace {

std::string image_name(std::size_t number) { return fmt::format("{:06d}.png", number); }

std::string seconds(std::int64_t ns) { return fmt::format("{}.{:09d}", ns / kNanosPerSecond, ns % kNanosPerSecond); }

Status write_lists(const std::vector<Frame>& frames, const std::filesystem::path& folder) {
  std::string times, list = "image,sequence,exposure_begin_s,exposure_s,gain,received_s,corrupt\n";
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Frame& frame = frames[i];
    times += seconds(frame.stamp_ns) + "\n";
    list += fmt::format("{},{},{},{:.9f},{:.4f},{},{}\n", image_name(i), frame.sequence, seconds(frame.stamp_ns),
                        frame.exposure.duration_s, frame.exposure.gain, seconds(frame.received.ns()),
                        frame.corrupt ? 1 : 0);
  }
  const Status status = write_whole_file(folder / "times.txt", std::as_bytes(std::span(times)));
  return status ? write_whole_file(folder / "frames.csv", std::as_bytes(std::span(list))) : status;
}

// The threads take frames in turn, and stop at the first error.
class Studio {
 public:
  Studio(const Context& context, const CameraConfig& config, const std::vector<Frame>& frames,
         const std::filesystem::path& folder)
      : context_(context), config_(config), frames_(frames), folder_(folder), table_(config), response_(config) {}

  Status run(const CameraOutput& output) {
    std::vector<Status> ends(std::max(1U, output.threads), success());
    {
      std::vector<std::jthread> workers;
      const auto silent = [](double) {};
      for (std::size_t i = 1; i < ends.size(); ++i)
        workers.emplace_back([&, i] { ends[i] = work(output.stop, silent); });
      ends[0] = work(output.stop, output.progress ? output.progress : silent);
    }
    for (const Status& end : ends) {
      if (!end) return end;
    }
    return success();
  }

 private:
  Status work(const std::atomic<bool>* stop, const std::function<void(double)>& progress) {
    Renderer renderer(context_.scene, config_, table_);
    RadianceImage light;
    PixelImage image;
    for (std::size_t i = next_++; i < frames_.size() && !failed_; i = next_++) {
      if (stop != nullptr && stop->load()) return Error{"stopped"};
      const Frame& frame = frames_[i];
      renderer.render(context_.motion, frame.begin_s, frame.exposure.duration_s, light);
      response_.apply(light, frame.exposure, Random(context_.seed, config_.name, frame.trigger), image);
      if (frame.corrupt) corrupt(image, Random(context_.seed, config_.name + " corrupt", frame.trigger));
      if (Status status = write_png(folder_ / image_name(i), image); !status) {
        failed_ = true;
        return status;
      }
      progress(static_cast<double>(i + 1) / static_cast<double>(frames_.size()));
    }
    return success();
  }

  const Context& context_;
  const CameraConfig& config_;
  const std::vector<Frame>& frames_;
  const std::filesystem::path& folder_;
  RayTable table_;
  SensorResponse response_;
  std::atomic<std::size_t> next_ = 0;
  std::atomic<bool> failed_ = false;
};

}  // namespace

Result<CameraLog> write_camera(const Context& context, const CameraConfig& config, const std::filesystem::path& folder,
                               const CameraOutput& output) {
  const std::filesystem::path images = folder / config.name;
  std::error_code code;
  std::filesystem::create_directories(images, code);
  if (code) return Error{fmt::format("{}: cannot be made: {}", images.string(), code.message())};
  const auto plan = plan_frames(context, config);
  if (!plan) return plan.error();
  if (Status status = Studio(context, config, plan->frames, images).run(output); !status) return status.error();
  if (Status status = write_lists(plan->frames, images); !status) return status.error();
  return plan->log;
}

}  // namespace lxd::sim
