// SPDX-License-Identifier: Apache-2.0
// What a live run makes of a camera's frames and triggers is what a replay of their recording makes of them: the same
// images, byte for byte, of the same instants.
#include <numeric>

#include <gtest/gtest.h>

#include "board/camera_stream.hpp"
#include "board/live_images.hpp"
#include "board/recording_stream.hpp"
#include "board/rig_file.hpp"
#include "drivers/sync/gpio_edges.hpp"
#include "tests/support/made_jpeg.hpp"
#include "tests/support/temporary_folder.hpp"

namespace lxd::board_recorded_camera_test {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;

constexpr std::uint32_t kWidth = 32, kHeight = 8;
constexpr int kFrames = 40;
constexpr std::int64_t kMillisecond_ns = 1'000'000;
const RigTime kStart = RigTime::from_ns(1'700'000'000'000'000'123);

RigTime after(RigTime t, std::int64_t ms) { return t + Duration::from_ns(ms * kMillisecond_ns); }

struct SeenImage {
  RigTime instant;
  Bytes pixels;
  bool operator==(const SeenImage&) const = default;
};

struct Camera {
  const char* format;
  const char* stamp;
  bool at_start;  // as its driver says
};

class RecordedCamera : public testing::TestWithParam<Camera> {
 protected:
  static Rig rig() {
    const std::string yaml = fmt::format(
        "lidar0: {{}}\ncamera0: {{resolution: [{}, {}], intrinsics: [30, 30, 16, 4], device: /dev/video0, "
        "pixel_format: {}, stamp: {}, exposure_s: 0.004, readout_s: 0.003}}\n"
        "triggers: {{chip: gpiochip0, camera0: 5, edge: falling, to_exposure_s: 0.0005}}\n",
        kWidth, kHeight, GetParam().format, GetParam().stamp);
    const RigFile file = parse_rig(yaml, "rig.yaml");
    EXPECT_TRUE(file.ok()) << text_of(file.problems);
    return file.rig;
  }

  // Lines with gaps, but for mjpeg; each frame another image.
  static Bytes frame(int i) {
    if (std::string(GetParam().format) == "mjpeg") {
      Bytes jpeg = test::made_jpeg(kWidth, kHeight);
      if (i == kBroken) jpeg.resize(jpeg.size() / 2);
      return jpeg;
    }
    Bytes bytes(std::size_t{bytes_per_line()} * kHeight);
    std::iota(bytes.begin(), bytes.end(), static_cast<std::uint8_t>(7 * i));
    return bytes;
  }
  static std::uint32_t bytes_per_line() {
    const std::string format = GetParam().format;
    if (format == "mjpeg") return 0;
    return kWidth * (format == "rgb" ? 3 : format == "yuyv" ? 2 : 1) + 16;
  }

  void start() {
    camera_ = stream(LiveChannel::camera0);
    triggers_ = stream(LiveChannel::triggers);
    live_.emplace(rig_);
  }
  std::unique_ptr<RecordingStream> stream(LiveChannel channel) {
    auto file = create_chunk_file(channel, rig_, folder_.path());
    EXPECT_TRUE(file) << file.error().message;
    return std::make_unique<RecordingStream>(channel, std::move(*file));
  }

  void edge(RigTime t, GpioEdge edge) {
    const Bytes byte{static_cast<std::uint8_t>(edge)};
    record(*triggers_, {t, {}, 0, byte});
    if (edge == GpioEdge::falling) live_->add_trigger(t);
  }
  void take(RigTime stamp, std::uint32_t sequence, const Bytes& bytes) {
    Chunk chunk{stamp, {}, 0, bytes};
    chunk.origin.frame = {sequence, bytes_per_line(), GetParam().at_start};
    record(*camera_, chunk);
    live_->take(chunk);
  }
  static void record(RecordingStream& stream, const Chunk& chunk) {
    stream.put(chunk);
    EXPECT_TRUE(stream.write());
  }
  void look(RigTime now) {
    while (const CameraImage* const image = live_->front(now)) {
      seen_.push_back({image->instant, image->pixels.data});
      live_->drop_front();
    }
  }

  // 20 Hz; the stamp comes 9 ms after the edge, and a fraction that varies. An edge is lost, a frame is lost, and one
  // edge is read after its frame.
  void play() {
    for (int i = 0; i < kFrames; ++i) {
      const RigTime begin = after(kStart, 50 * i);
      const RigTime stamp = after(begin, 9) + Duration::from_ns(i % 3 * 100'000);
      const bool lost = i == kLostEdge, late = i == kLateEdge;
      if (!lost && !late) edge(begin, GpioEdge::falling);
      if (i != kLostFrame) take(stamp, static_cast<std::uint32_t>(i), frame(i));
      look(after(stamp, 1));
      if (late) edge(begin, GpioEdge::falling);
      edge(after(begin, 2), GpioEdge::rising);
      look(after(stamp, 20));
    }
    look(after(kStart, 60'000));
    camera_->close();
    triggers_->close();
    EXPECT_FALSE(camera_->ended()) << camera_->failure();
    EXPECT_FALSE(triggers_->ended()) << triggers_->failure();
  }

  [[nodiscard]] std::vector<SeenImage> replayed() const {
    std::vector<SeenImage> all;
    auto folder = open_timed_camera(folder_.path(), rig_);
    EXPECT_TRUE(folder) << folder.error().message;
    CameraImage image;
    while (folder && folder->next(image)) all.push_back({image.instant, image.pixels.data});
    return all;
  }

  static constexpr int kBroken = 11, kLostEdge = 15, kLostFrame = 20, kLateEdge = 30;

  test::TemporaryFolder folder_;
  Rig rig_ = rig();
  std::unique_ptr<RecordingStream> camera_, triggers_;
  std::optional<LiveImages> live_;
  std::vector<SeenImage> seen_;
};

TEST_P(RecordedCamera, ReplaysTheImagesThatTheLiveRunSaw) {
  start();
  play();
  const bool jpeg = std::string(GetParam().format) == "mjpeg";
  ASSERT_EQ(seen_.size(), static_cast<std::size_t>(kFrames - 1 - (jpeg ? 1 : 0)));
  const auto found = replayed();
  ASSERT_EQ(found.size(), seen_.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].instant, seen_[i].instant) << i;
    EXPECT_TRUE(found[i].pixels == seen_[i].pixels) << i;
  }
  EXPECT_EQ(camera_->counts().refused, 0U);
}

// Five a second at most, in the file that the image names.
TEST_P(RecordedCamera, KeepsTheColoursThatTheDeviceGives) {
  start();
  play();
  auto folder = open_timed_camera(folder_.path(), rig_);
  ASSERT_TRUE(folder) << folder.error().message;
  CameraImage image;
  ASSERT_TRUE(folder->next(image));
  ColourPixels found;
  ASSERT_TRUE(read_image(image.colours, found)) << image.colours;
  const std::string format = GetParam().format;
  auto converter =
      PixelConverter::create({*find_pixel_format(*fourcc_of_format(format)), kWidth, kHeight, bytes_per_line()});
  Bytes wanted(converter->bgr_bytes());
  ASSERT_TRUE(converter->to_bgr(frame(0), wanted));
  EXPECT_EQ(found.data, wanted);
  std::size_t coloured = 1;
  while (folder->next(image)) coloured += !image.colours.empty();
  EXPECT_EQ(coloured, format == "yuyv" ? 10U : seen_.size()) << "of two seconds";
}

INSTANTIATE_TEST_SUITE_P(Each, RecordedCamera,
                         testing::Values(Camera{"grey", "trigger", false}, Camera{"yuyv", "driver", false},
                                         Camera{"yuyv", "trigger", true}, Camera{"rgb", "exposure_start", false},
                                         Camera{"mjpeg", "trigger", true}, Camera{"mjpeg", "frame_end", true}));

// Of which instant an image is: the stamp of its trigger, its start or its end, carried to the exposure's middle.
class ImageInstant : public RecordedCamera {};

TEST_P(ImageInstant, IsTheMiddleOfTheExposure) {
  start();
  play();
  const std::string stamp = GetParam().stamp;
  const RigTime begin = after(kStart, 0);
  const Duration half = Duration::from_ns(2 * kMillisecond_ns);
  RigTime wanted = after(begin, 9) + half;                                         // at its start
  if (stamp == "trigger") wanted = begin + Duration::from_ns(500'000) + half;      // behind its edge
  if (stamp == "driver" || stamp == "frame_end") wanted = after(begin, 2) + half;  // 4 ms exposure, 3 ms read-out
  EXPECT_EQ(seen_.front().instant, wanted);
}

INSTANTIATE_TEST_SUITE_P(Each, ImageInstant,
                         testing::Values(Camera{"grey", "trigger", false}, Camera{"grey", "driver", false},
                                         Camera{"grey", "exposure_start", false}, Camera{"grey", "frame_end", true}));

class GreyCamera : public RecordedCamera {};

// Given a frame that is shorter than its image, then it is counted, and neither the recording nor the run has it.
TEST_P(GreyCamera, LeavesOutAndCountsAFrameThatIsTooShort) {
  start();
  take(kStart, 0, Bytes(10));
  take(after(kStart, 50), 1, frame(1));
  look(after(kStart, 60));
  camera_->close();
  EXPECT_EQ(camera_->counts().refused, 1U);
  EXPECT_EQ(live_->rejected().at("broken_image"), 1U);
  EXPECT_EQ(seen_.size(), 1U);
  EXPECT_EQ(replayed(), seen_);
}

// Given a disk that is full when the fourth image comes, then three are there whole and listed, and the rest is
// counted.
TEST_P(GreyCamera, EndsBehindTheLastWholeImageWhenTheDiskIsFull) {
  start();
  fs::create_symlink("/dev/full", folder_.path() / "camera0" / "000003.pgm");
  for (int i = 0; i < 10; ++i) take(after(kStart, 50 * i), static_cast<std::uint32_t>(i), frame(i));
  camera_->close();
  EXPECT_NE(camera_->failure().find("000003.pgm: cannot be written: No space left on device"), std::string::npos)
      << camera_->failure();
  EXPECT_EQ(replayed().size(), 3U);
  EXPECT_EQ(camera_->counts().chunks, 10U);
  EXPECT_EQ(camera_->counts().not_written, 7U);
  EXPECT_FALSE(fs::exists(folder_.path() / "camera0" / "000003.pgm"));
}

// Given a run that cannot take its images in time, then the newest win, and those left out are counted.
TEST_P(GreyCamera, KeepsTheNewestImagesWhenNobodyTakesThem) {
  start();
  for (int i = 0; i < 9; ++i) take(after(kStart, 50 * i), static_cast<std::uint32_t>(i), frame(i));
  look(after(kStart, 1000));
  EXPECT_EQ(seen_.size(), 4U);
  EXPECT_EQ(live_->rejected().at("late"), 5U);
  EXPECT_EQ(seen_.back().instant, after(kStart, 50 * 8 - 7) + Duration::from_ns(2 * kMillisecond_ns));
}

INSTANTIATE_TEST_SUITE_P(Driver, GreyCamera, testing::Values(Camera{"grey", "driver", false}));

}  // namespace
}  // namespace lxd::board_recorded_camera_test
