// SPDX-License-Identifier: Apache-2.0
// Rig files with the mistakes that people make: each is found, placed and explained, and all of them at once.
#include "board/rig_file.hpp"

#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace lxd::rig_file_test {
namespace {

RigFile parse(std::string_view text) { return parse_rig(std::string(text), "rig.yaml"); }

struct Mistake {
  std::string name;
  std::string text;
  std::vector<std::string> said;  // parts of the one message
};

class RigMistake : public testing::TestWithParam<Mistake> {};

// Given a file with one mistake, when it is read, then there is one problem and it says where, what and what instead.
TEST_P(RigMistake, IsTheOneProblemAndIsExplained) {
  const RigFile file = parse(GetParam().text);
  ASSERT_EQ(file.problems.size(), 1U) << text_of(file.problems);
  const std::string message = file.problems[0].text();
  for (const std::string& part : GetParam().said) EXPECT_NE(message.find(part), std::string::npos) << message;
}

std::string lidar(const std::string& keys) { return fmt::format("reference: lidar0\nlidar0: {{{}}}\n", keys); }

std::string extrinsic(const std::string& matrix) {
  return fmt::format("reference: imu\nimu: {{}}\nlidar0:\n  T_reference_sensor: {}\n", matrix);
}

const Mistake kMistakes[] = {
    {"UnknownKey", lidar("beems: 32"), {"rig.yaml:2: lidar0.beems: unknown key", "did you mean beams?"}},
    {"UnknownSection", "reference: lidar0\nlidar0: {}\nlidar: {}\n", {"rig.yaml:3: lidar: unknown key", "lidar0"}},
    {"UnknownKeyFarFromAll", lidar("colour: red"), {"lidar0.colour: unknown key", "wanted one of", "rate_hz"}},
    {"NoLidar", "reference: imu\nimu: {}\n", {"lidar0: found nothing", "primary LiDAR"}},
    {"KeyTwice",
     "reference: lidar0\nlidar0:\n  beams: 16\n  beams: 32\n",
     {"rig.yaml:4: lidar0.beams", "twice", "line 3"}},
    {"SectionIsANumber", "reference: lidar0\nlidar0: 5\n", {"rig.yaml:2: lidar0: found '5', wanted keys"}},
    {"SectionIsEmpty", "reference: lidar0\nlidar0:\n", {"lidar0: found nothing, wanted keys"}},
    {"NumberIsText", lidar("rate_hz: 10 Hz"), {"lidar0.rate_hz: found '10 Hz', wanted a number in 1 .. 100 Hz"}},
    {"NumberIsAList", lidar("rate_hz: [10]"), {"lidar0.rate_hz: found a list of 1, wanted a number"}},
    {"NotANumber", lidar("rate_hz: .nan"), {"lidar0.rate_hz", "nan", "finite"}},
    {"Infinite", lidar("rate_hz: .inf"), {"lidar0.rate_hz", "inf", "finite"}},
    {"AbsurdRate", lidar("rate_hz: 1310720"), {"lidar0.rate_hz: found 1310720", "1 .. 100 Hz"}},
    {"RateZero", lidar("rate_hz: 0"), {"lidar0.rate_hz: found 0"}},
    {"HalfABeam", lidar("beams: 16.5"), {"lidar0.beams: found 16.5, wanted a whole number"}},
    {"UnknownModel", lidar("model: flash"), {"lidar0.model: found 'flash', wanted spinning or livox"}},
    {"FieldBeyondHalfATurn", lidar("fov_deg: [-22.5, 225]"), {"lidar0.fov_deg[1]: found 225", "-180 .. 180 degrees"}},
    {"FieldInRadians", lidar("fov_deg: [-0.39, 0.39]"), {"lidar0.fov_deg", "looks like radians"}},
    {"FieldUpsideDown", lidar("fov_deg: [22, -22]"), {"lidar0.fov_deg: found [22, -22]", "lower number first"}},
    {"FieldOfThree", lidar("fov_deg: [1, 2, 3]"), {"lidar0.fov_deg: found a list of 3, wanted 2 numbers"}},
    {"RangeInMillimetres", lidar("range_m: [500, 80000]"), {"lidar0.range_m[1]: found 80000", "millimetres"}},
    {"SigmaInMillimetres", lidar("range_sigma_m: 20"), {"lidar0.range_sigma_m: found 20", "millimetres"}},
    {"SweepAboveCapacity", lidar("beams: 128, columns: 4096"), {"524288 points a sweep", "at most 262144"}},
    {"MatrixInDegrees",
     extrinsic("[[0, 90, 0, 0], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]"),
     {"rig.yaml:4: lidar0.T_reference_sensor", "no rotation", "degrees"}},
    {"MatrixTransposed",
     extrinsic("[[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0.1, 0.2, 0.3, 1]]"),
     {"last row 0.1 0.2 0.3 1, wanted 0 0 0 1", "transposed"}},
    {"MatrixScaled", extrinsic("[[2, 0, 0, 0], [0, 2, 0, 0], [0, 0, 2, 0], [0, 0, 0, 1]]"), {"scaled by 2"}},
    {"MatrixMirrored", extrinsic("[[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, -1, 0], [0, 0, 0, 1]]"), {"mirror"}},
    {"MatrixRounded",
     extrinsic("[[0.995, -0.1, 0, 0], [0.1, 0.995, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]"),
     {"rounded", "digits"}},
    {"MatrixSkewed", extrinsic("[[1, 0.5, 0, 0], [0, 0.8, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]"), {"not orthonormal"}},
    {"MatrixWithoutANumber", extrinsic("[[.nan, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]"), {"not finite"}},
    {"MatrixOfThreeRows",
     extrinsic("[[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]"),
     {"found a list of 3, wanted four rows"}},
    {"MatrixOfRowsOfThree", extrinsic("[[1, 0, 0], [0, 1, 0], [0, 0, 1]]"), {"wanted four rows of four"}},
    {"MatrixIsADeepList", extrinsic("[[[[1, 2, 3, 4]]]]"), {"wanted four rows of four"}},
    {"MatrixWithAWord",
     extrinsic("[[one, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]"),
     {"'one'", "row 0, column 0"}},
    {"MatrixIsAWord", extrinsic("identity"), {"found 'identity', wanted four rows"}},
    {"TranslationInMillimetres",
     extrinsic("[[1, 0, 0, 120], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]"),
     {"millimetres"}},
    {"ReferenceMoved",
     "reference: imu\nimu: {T_reference_sensor: [[1,0,0,1],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}\n"
     "lidar0: {T_reference_sensor: [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}\n",
     {"rig.yaml:2: imu.T_reference_sensor", "identity", "itself the reference"}},
    {"ReferenceMistyped",
     "reference: lidar\nlidar0: {}\n",
     {"lidar0.T_reference_sensor", "'lidar' is no sensor of this file", "did you mean lidar0"}},
    {"ReferenceIsAList", "reference: [imu]\nlidar0: {}\n", {"rig.yaml:1: reference: found a list of 1"}},
    {"KalibrTransform", lidar("T_cam_imu: 1"), {"lidar0.T_cam_imu: unknown key", "T_reference_sensor", "inverse"}},
    {"CameraWithoutIntrinsics",
     "reference: lidar0\nlidar0: {}\ncamera0: {resolution: [640, 480]}\n",
     {"camera0.intrinsics: found nothing"}},
    {"FisheyeByAnotherName",
     "reference: lidar0\nlidar0: {}\ncamera0: {resolution: [640, 480], intrinsics: [1, 1, 1, 1], distortion_model: "
     "fisheye}\n",
     {"camera0.distortion_model: found 'fisheye', wanted radtan or equidistant or none"}},
    {"GyroscopeInDegrees",
     "reference: lidar0\nlidar0: {}\nimu: {gyroscope_noise_density: 3.8}\n",
     {"imu.gyroscope_noise_density: found 3.8", "degrees"}},
    {"AntennaInMillimetres",
     "reference: lidar0\nlidar0: {}\ngnss: {antenna_in_reference_m: [0, 0, 1200]}\n",
     {"gnss.antenna_in_reference_m[2]: found 1200", "millimetres"}},
    {"SettingUnknown",
     lidar("") + "settings: {mapping.cell_size: 1}\n",
     {"rig.yaml:3: settings: mapping.cell_size: unknown setting", "mapping.cell_size_m"}},
    {"SettingOutOfRange",
     lidar("") + "settings: {mapping.cell_size_m: 100}\n",
     {"mapping.cell_size_m: found '100', wanted a number in 0.1 .. 10 m"}},
    {"SettingsAList", lidar("") + "settings: [1]\n", {"settings: found a list of 1, wanted keys"}},
    {"NoYaml", "reference: [lidar0\nlidar0: {}}\n", {"rig.yaml:", "no sound YAML"}},
    {"Tab", "lidar0:\n\tbeams: 5\n", {"rig.yaml:2", "no sound YAML"}},
    {"Empty", "", {"rig.yaml:", "found nothing, wanted"}},
    {"AList", "- lidar0\n", {"found a list of 1, wanted keys"}},
};

INSTANTIATE_TEST_SUITE_P(Rig, RigMistake, testing::ValuesIn(kMistakes),
                         [](const auto& mistake) { return mistake.param.name; });

TEST(RigFault, ListsAllProblemsAtOnceInTheOrderOfTheFile) {
  const RigFile file = parse(R"(reference: imu
imu: {update_rate: -5, gyro_noise_density: 1}
lidar0:
  model: spining
  fov_deg: [-0.4, 0.4]
  range_m: [300, 80000]
  T_reference_sensor: [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 2, 0], [0, 0, 0, 1]]
wheels: {rate_hz: 50}
settings: {nothing: 1}
)");
  const std::vector<std::string> places = {
      "imu.gyro_noise_density", "imu.update_rate",           "lidar0.model", "lidar0.fov_deg",
      "lidar0.range_m[1]",      "lidar0.T_reference_sensor", "wheels",       "settings"};
  std::vector<std::string> found;
  for (const Problem& problem : file.problems) found.push_back(problem.key);
  EXPECT_TRUE(std::is_permutation(found.begin(), found.end(), places.begin(), places.end())) << text_of(file.problems);
  EXPECT_TRUE(std::ranges::is_sorted(file.problems, {}, &Problem::place)) << text_of(file.problems);
}

TEST(RigFault, AFileThatIsNotThereIsOneProblemWithItsName) {
  const RigFile file = load_rig("/nowhere/at/all.yaml");
  ASSERT_EQ(file.problems.size(), 1U);
  EXPECT_NE(file.problems[0].text().find("/nowhere/at/all.yaml"), std::string::npos);
}

TEST(RigFault, AFolderInThePlaceOfAFileIsAProblem) { EXPECT_FALSE(load_rig("/").ok()); }

// Whatever is cut off or replaced, the loader answers and never throws.
TEST(RigFault, EveryTruncationOfAFileIsAnswered) {
  const std::string whole = R"(reference: imu
imu: {update_rate: 200}
lidar0: {model: spinning, fov_deg: [-25, 15], T_reference_sensor: [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}
camera0: {resolution: [640, 480], intrinsics: [1, 1, 1, 1]}
settings: {threads: 1}
)";
  for (std::size_t size = 0; size <= whole.size(); ++size) EXPECT_NO_THROW((void)parse(whole.substr(0, size))) << size;
  for (std::size_t at = 0; at < whole.size(); ++at) {
    std::string broken = whole;
    for (const char c : {'\0', '\t', '[', '}', ':', '&', '*', '\x80'}) {
      broken[at] = c;
      EXPECT_NO_THROW((void)parse(broken)) << "byte " << at;
    }
  }
}

}  // namespace
}  // namespace lxd::rig_file_test
