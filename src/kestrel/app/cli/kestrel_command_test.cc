// SPDX-License-Identifier: BSD-3-Clause
// Runs the binary `kestrel` as a user does, and tests its files, its output and its exit status.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <string>
#include <sys/wait.h>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/app/cli/test_command.h"
#include "kestrel/app/foxglove/test_protobuf.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/core/codec/image_codec.h"
#include "kestrel/io/recording/test_files.h"
#include "kestrel/vision/pipeline/test_pattern.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

constexpr char kSensor[] = R"(sensor_type: camera
T_BS:
  cols: 4
  rows: 4
  data: [0, -1, 0, 0, -1, 0, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1]
rate_hz: 10
resolution: [640, 480]
camera_model: pinhole
intrinsics: [400, 400, 319.5, 239.5]
distortion_model: none
distortion_coefficients: []
)";
constexpr char kPoses[] =
    "#timestamp [ns],p_WB_W_x [m],p_WB_W_y [m],p_WB_W_z [m],q_WB_w [],q_WB_x [],q_WB_y [],q_WB_z "
    "[]\n"
    "100000000,5,6,3,1,0,0,0\n200000000,5,6,3,1,0,0,0\n";

class KestrelCommandTest : public CommandTest {
 protected:
  // Writes two frames with poses. The pattern is 1 m in diameter, 3 m below the camera. 'channels':
  // 1 or 3.
  std::string WriteRecording(int channels = 1) const {
    const RigidTransform camera_from_target = {
        Eigen::Quaterniond(Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX())),
        {0.3, 0.2, 3}};
    const CameraModel camera({640, 480, 400, 400, 319.5, 239.5, DistortionModel::kNone, {}});
    const cv::Mat image = DrawPattern(camera, LandingPattern(), camera_from_target);
    const auto write = [&](const std::string& name, const cv::Mat& gray) {
      cv::Mat shown;
      cv::merge(std::vector<cv::Mat>(static_cast<std::size_t>(channels), gray), shown);
      if (channels == 3) shown.row(0).setTo(cv::Scalar(0, 0, 200));  // else it is as good as gray
      WriteTestImage(folder_, "flight/mav0/cam0/data/" + name, shown);
    };
    write("100000000.png", image);
    write("200000000.png", cv::Mat(480, 640, CV_8UC1, 90));
    folder_.Write("flight/mav0/cam0/data.csv",
                  "#timestamp [ns],filename\n100000000,100000000.png\n200000000,200000000.png\n");
    folder_.Write("flight/mav0/cam0/sensor.yaml", kSensor);
    folder_.Write("flight/mav0/nav0/data.csv", kPoses);
    return folder_ / "flight";
  }
};

// The libraries that OpenCV's codecs need (GDAL, FFmpeg and others) take longer to load than a
// short command runs.
TEST_F(KestrelCommandTest, DoesNotLinkOpenCvCodecs) {
  const std::string list = folder_ / "libraries.txt";
  ASSERT_EQ(std::system(fmt::format("ldd '{}' > '{}'", KESTREL_COMMAND, list).c_str()), 0);
  const std::string libraries = ReadFile(list);
  EXPECT_THAT(libraries, HasSubstr("libopencv_core"));
  for (const char* name : {"imgcodecs", "videoio", "highgui", "gdal", "avcodec"}) {
    EXPECT_THAT(libraries, Not(HasSubstr(name)));
  }
}

TEST_F(KestrelCommandTest, LandWarnsOnceOfWrongAltitude) {
  WriteRecording();
  const cv::Mat image = ReadImage(folder_ / "flight/mav0/cam0/data/100000000.png");
  for (int i = 0; i < 12; ++i) WriteTestImage(folder_, fmt::format("images/{:02}.png", i), image);
  const std::string land = fmt::format("land {} --camera {} --altitude ", folder_ / "images",
                                       folder_ / "flight/mav0/cam0/sensor.yaml");
  const std::string wrong = Run(land + "20").err;
  EXPECT_THAT(wrong, HasSubstr("pattern found in 12"));
  const std::size_t first = wrong.find("set --altitude 3.0");
  EXPECT_NE(first, std::string::npos) << wrong;
  EXPECT_EQ(wrong.find("set --altitude", first + 1), std::string::npos) << "said twice";
  EXPECT_THAT(Run(land + "3").err, Not(HasSubstr("given altitude")));
}

TEST_F(KestrelCommandTest, PrintsHelpAndVersion) {
  for (const char* arguments : {"help", "--help"}) {
    const Outcome outcome = Succeed(arguments);
    EXPECT_THAT(outcome.out, HasSubstr("Run the landing pipeline"));
  }
  for (const char* arguments : {"help land", "land --help"}) {
    const Outcome outcome = Succeed(arguments);
    EXPECT_THAT(outcome.out, HasSubstr("--altitude"));
  }
  const Outcome version = Succeed("--version");
  EXPECT_THAT(version.out, StartsWith("kestrel 0."));
}

TEST_F(KestrelCommandTest, ExitsWithStatusTwoOnWrongUsage) {
  for (const char* arguments :
       {"", "swim", "help swim", "land", "land a.png --altitude nan", "land a.png --altitude -1",
        "land a.png --clock-offset inf", "land a.png --annotate", "land a.png --colour",
        "land a.png --output o --annotate=gif", "land a.png --predict 1", "calibrate",
        "land a.png --output o --predict 0.5,-1", "hunt a.png --origin 50",
        "hunt a.png --origin 50,14,3", "hunt a.png --origin 95,14", "land a.png --mcap out.txt",
        "simulate landing --seed x"}) {
    const Outcome outcome = Run(arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_THAT(outcome.err, StartsWith("kestrel")) << arguments;
    EXPECT_EQ(Lines(outcome.err), 1) << outcome.err;
    EXPECT_THAT(outcome.out, IsEmpty()) << arguments;
  }
}

TEST_F(KestrelCommandTest, ReportsWrongUsage) {
  for (const auto& [arguments, message] :
       {std::pair("lnd a.png", "kestrel: there is no command 'lnd'; did you mean 'land'?"),
        std::pair("simulate landng", "there is no command 'landng'; did you mean 'landing'?"),
        std::pair("land a.png --outpt x", "there is no option '--outpt'; did you mean '--output'?"),
        std::pair("land a.png --zzz", "there is no option '--zzz'; kestrel land --help"),
        std::pair("--output x land a.png", "--output has to stand behind the command"),
        std::pair("land a.png --altitude 3 --altitude 4", "--altitude is given 2 times"),
        std::pair("land a.png --altitude 1500", "--altitude: it is 1500, expected metres: 1.5?"),
        std::pair("land a.png --output", "--output: expected DIR"),
        std::pair("simulate landing --seed x", "--seed: got 'x', expected a number"),
        std::pair("land a.png --output x --annotate=Video",
                  "--annotate: got 'Video', expected one of video,images")}) {
    EXPECT_THAT(Run(arguments).err, HasSubstr(message));
  }
  ExpectInputError("land a.png --set landing=5", "landing is a group of options");
}

TEST_F(KestrelCommandTest, ConfigRoundTrips) {
  const Outcome first = Succeed("config --set landing.detector.min_ring_px=9.5");
  const Outcome again = Run("config --config " + folder_.Write("c.yaml", first.out));
  EXPECT_EQ(again.out, first.out);
  EXPECT_THAT(again.out, HasSubstr("min_ring_px: 9.5 "));
}

TEST_F(KestrelCommandTest, ConfigPrintsSimulatorOptionsSeparately) {
  const std::string users = Succeed("config").out;
  EXPECT_THAT(users, HasSubstr("min_ring_px:"));
  EXPECT_THAT(users, Not(HasSubstr("sim_")));
  EXPECT_LE(std::ranges::count(users, '#'), 200);
  EXPECT_THAT(Succeed("config --set fly.sim_seed=7").out, HasSubstr("sim_seed: 7 "));
  const std::string simulators = Succeed("config --simulation").out;
  EXPECT_THAT(simulators, HasSubstr("sim_camera:"));
  EXPECT_THAT(simulators, Not(HasSubstr("min_ring_px:")));
}

TEST_F(KestrelCommandTest, LandsOnRecording) {
  const std::string output = folder_ / "out";
  const Outcome outcome =
      Succeed("land " + WriteRecording() + " --output " + output + " --annotate=images");
  EXPECT_THAT(outcome.out, IsEmpty());
  EXPECT_THAT(outcome.err, HasSubstr("2 frames, pattern found in 1, detect_ms median"));
  const std::string csv = ReadFile(output + "/landing_detections.csv");
  EXPECT_EQ(Lines(csv), 3);
  EXPECT_THAT(csv, HasSubstr("\nmav0/cam0/data/100000000.png,100000000,1,"));
  EXPECT_THAT(csv, HasSubstr("\nmav0/cam0/data/200000000.png,200000000,0,,,"));
  for (const char* name : {"100000000", "200000000"}) {
    const std::string image = output + "/annotated/mav0/cam0/data/" + name + ".png";
    EXPECT_EQ(ReadImage(image).size(), cv::Size(640, 480));
  }
}

TEST_F(KestrelCommandTest, ReportsUnusedKeysOfRecordingCalibration) {
  const std::string recording = WriteRecording();
  folder_.Write("flight/mav0/cam0/sensor.yaml", std::string(kSensor) + "lens_shift: 3\n");
  const std::string err = Succeed("land " + recording).err;
  const std::string warning = "sensor.yaml: not used, as not known here: 'lens_shift'";
  const std::size_t first = err.find(warning);
  EXPECT_NE(first, std::string::npos) << err;
  EXPECT_EQ(err.find(warning, first + 1), std::string::npos) << err;
}

TEST_F(KestrelCommandTest, PrintsPatternPositionInWorld) {
  const Outcome outcome = Succeed("land --still " + WriteRecording());
  std::string row = outcome.out.substr(outcome.out.find('\n') + 1);
  std::vector<std::string> cells;
  for (std::size_t end = 0; (end = row.find(',')) != std::string::npos; row.erase(0, end + 1)) {
    cells.push_back(row.substr(0, end));
  }
  ASSERT_GE(cells.size(), 14u) << outcome.out;
  EXPECT_NEAR(std::stod(cells[3]), 319.5 + 40, 0.2);             // u_px
  EXPECT_NEAR(std::stod(cells[4]), 239.5 + 400 * 0.2 / 3, 0.2);  // v_px
  EXPECT_NEAR(std::stod(cells[9]), 3, 0.03);                     // p_CP_C_z_m
  EXPECT_NEAR(std::stod(cells[10]), 5 - 0.2, 0.03);              // p_WP_W_x_m
  EXPECT_NEAR(std::stod(cells[11]), 6 - 0.3, 0.03);              // p_WP_W_y_m
  EXPECT_NEAR(std::stod(cells[12]), 0, 0.03);                    // p_WP_W_z_m
}

TEST_F(KestrelCommandTest, PicturesHaveColorsOfSource) {
  const std::string output = folder_ / "out";
  const std::string land = "land " + WriteRecording(3) + " --output " + output;
  Succeed(land + " --annotate=images");
  const cv::Mat picture = ReadImage(output + "/annotated/mav0/cam0/data/100000000.png");
  EXPECT_EQ(picture.at<cv::Vec3b>(0, 600), cv::Vec3b(0, 0, 200));
}

TEST_F(KestrelCommandTest, WritesAnnotatedVideo) {
  const std::string output = folder_ / "out";
  Succeed("land --annotate " + WriteRecording() + " --output " + output);
  EXPECT_NE(std::filesystem::exists(output + "/annotated.mp4"),
            std::filesystem::exists(output + "/annotated.avi"));
}

TEST_F(KestrelCommandTest, ReplacesResultsOnlyWithForce) {
  const std::string arguments = "land " + WriteRecording() + " --output " + (folder_ / "out");
  Succeed(arguments);
  ExpectInputError(arguments, "landing_detections.csv: exists already");
  Succeed(arguments + " --force");
}

TEST_F(KestrelCommandTest, LandAndHuntWriteMcap) {
  const std::string mcap = folder_ / "flight.mcap";
  for (const std::string command : {"land", "hunt"}) {
    const std::string recording = WriteRecording(command == "land" ? 1 : 3);
    Succeed(command + " --force " + recording + " --mcap " + mcap);
    const auto messages = ReadMessages(mcap);
    EXPECT_EQ(messages.at("/camera/image").size(), 2u);
    ASSERT_EQ(messages.at("/result").size(), 2u);
    const StoredMessage& second = messages.at("/result")[1];
    EXPECT_EQ(ToNanoseconds(second.time), 200'000'000);
    EXPECT_EQ(second.fields.time(1), second.time);
    EXPECT_EQ(second.fields.bytes(2), "mav0/cam0/data/200000000.png");
    EXPECT_EQ(messages.at("/result")[0].fields.count(7), command == "land" ? 1u : 0u);
  }
}

TEST_F(KestrelCommandTest, WritesNothingWhenMcapFileExists) {
  const std::string recording = WriteRecording();
  const std::string mcap = folder_.Write("mine.mcap", "mine");
  ExpectInputError("land " + recording + " --mcap " + mcap + " --output " + (folder_ / "out"),
                   "mine.mcap: is there already");
  EXPECT_EQ(ReadFile(mcap), "mine");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
  // The reverse case: no file is left behind.
  Succeed("land " + recording + " --output " + (folder_ / "out"));
  ExpectInputError(
      "land " + recording + " --mcap " + (folder_ / "new.mcap") + " --output " + (folder_ / "out"),
      "landing_detections.csv: exists already");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "new.mcap"));
  const std::string bag = folder_ / "bag.mcap";
  Succeed("convert " + recording + " " + bag);
  const std::string bytes = ReadFile(bag);
  ExpectInputError("land --force " + bag + " --mcap " + bag, "bag.mcap: is the source");
  EXPECT_EQ(ReadFile(bag), bytes);
}

TEST_F(KestrelCommandTest, CtrlCEndsCleanly) {
  const std::string camera = folder_.Write("camera.yaml", kSensor);
  std::string images;
  for (int i = 0; i < 3000; ++i) images += " a.png";
  WriteTestImage(folder_, "a.png", NoiseImage(640, 480, CV_8UC1));
  const std::string script = fmt::format(
      "cd '{}'; {} land --camera camera.yaml{} >rows 2>said & pid=$!; "
      "until [ \"$(wc -l <rows)\" -gt 3 ]; do sleep 0.01; done; kill -INT $pid; wait $pid",
      folder_.path(), KESTREL_COMMAND, images);
  const int status = std::system(script.c_str());
  EXPECT_EQ(WEXITSTATUS(status), 130);
  const std::string rows = ReadFile(folder_ / "rows");
  EXPECT_TRUE(rows.ends_with('\n'));
  EXPECT_LT(Lines(rows), 3001);
  const int frames = static_cast<int>(Lines(rows)) - 1;
  EXPECT_THAT(
      ReadFile(folder_ / "said"),
      AllOf(StartsWith(fmt::format("{} frames, pattern found in", frames)),
            HasSubstr(fmt::format("interrupted after {} of 3000 frames: all that is above and in "
                                  "the files is of this part",
                                  frames))));
}

TEST_F(KestrelCommandTest, ReportsFaultySource) {
  const std::string camera = " --camera " + folder_.Write("camera.yaml", kSensor);
  const std::string image = WriteTestImage(folder_, "a.png", NoiseImage(640, 480, CV_8UC1));
  ExpectInputError("land nowhere.png" + camera, "nowhere.png: no such file");
  ExpectInputError("land " + image + " --mcap " + (folder_ / "a.mcap"), "no calibration");
  EXPECT_THAT(Run("land " + image + camera + " --predict 1 --output " + folder_ / "out").err,
              HasSubstr("no prediction: it needs a source with poses"));
  const std::string deep = WriteTestImage(folder_, "deep.png", cv::Mat(480, 640, CV_16UC1));
  const std::string tiny = WriteTestImage(folder_, "tiny.png", cv::Mat(1, 1, CV_8UC1));
  const std::string wide = WriteTestImage(folder_, "wide.png", cv::Mat(2, 20000, CV_8UC1));
  TestFolder::CutOff(image, 0.5);
  for (const auto& [source, words] :
       {std::pair(deep, "deep.png: is a 16-bit image, expected 8 bits"),
        std::pair(tiny, "is 1x1 px, expected 640x480 px as in the calibration"),
        std::pair(wide, "is 20000x2 px, expected 640x480 px as in the calibration"),
        std::pair(image, "a.png: the image file is cut off")}) {
    const Outcome outcome = Run(fmt::format("land {}{}", source, camera));
    EXPECT_EQ(outcome.status, 1);
    EXPECT_THAT(outcome.err, HasSubstr(words));
  }
}

TEST_F(KestrelCommandTest, ReportsPositionInImageWithoutCalibration) {
  const std::string image = WriteRecording() + "/mav0/cam0/data/100000000.png";
  const Outcome outcome = Succeed("land " + image);
  EXPECT_THAT(outcome.err, HasSubstr("kestrel calibrate lens"));
  EXPECT_THAT(outcome.out, HasSubstr("100000000.png,0,1,359.49"));
  EXPECT_THAT(outcome.out, HasSubstr(",,,,,,,,,,,,")) << "no positions";
  // The lens of the image sees 77.3 degrees, and the pattern is 3 m before it.
  const Outcome guessed = Succeed("land " + image + " --fov 77.3");
  EXPECT_THAT(guessed.err, HasSubstr("as coarse as the 77.3 degrees of --fov"));
  EXPECT_THAT(guessed.out,
              ::testing::ContainsRegex(",0[.](29|30)[0-9]*,0[.](19|20)[0-9]*,(2[.]9|3[.]0)"));
  EXPECT_EQ(Run("land " + image + " --fov 400").status, 2);
  ExpectInputError("fly " + image + " --fov 77", "--fov: a flight needs a calibration");
}

TEST_F(KestrelCommandTest, BrokenImageInFolderGetsRow) {
  const std::string image = WriteRecording() + "/mav0/cam0/data/100000000.png";
  for (const char* name : {"a.png", "c.png"}) {
    WriteTestImage(folder_, std::string("images/") + name, ReadImage(image));
  }
  const std::string broken = folder_.Write("images/b.png", "garbage");
  const std::string camera = " --camera " + folder_.Write("camera.yaml", kSensor);
  const Outcome outcome = Succeed("land " + (folder_ / "images") + camera);
  EXPECT_THAT(outcome.out, HasSubstr("\nb.png,33333333,0,,,,,,,,,,,,,,,unreadable,,,\n"));
  EXPECT_EQ(Lines(outcome.out), 4);
  EXPECT_THAT(outcome.err, HasSubstr("2 frames, pattern found in 2"));
  EXPECT_THAT(outcome.err, HasSubstr("1 of 3 images left out, for example " + broken));
  EXPECT_THAT(Run("convert " + (folder_ / "images") + " " + (folder_ / "x.mcap")).err,
              HasSubstr("b.png: cannot be decoded"))
      << "nothing is lost without a word";
  folder_.Write("images/a.png", "garbage");
  folder_.Write("images/c.png", "garbage");
  ExpectInputError("land " + (folder_ / "images") + camera, "a.png: cannot be decoded");
}

TEST_F(KestrelCommandTest, HuntRefusesGrayImages) {
  ExpectInputError("hunt " + WriteRecording() + " --output " + (folder_ / "o"),
                   "is a gray image, expected images in colour");
}

TEST_F(KestrelCommandTest, DemoReplacesNothing) {
  folder_.Write("demo/mine.txt", "");
  ExpectInputError("demo --output " + (folder_ / "demo"), "demo: exists already; --force");
}

TEST_F(KestrelCommandTest, ReportsTruncatedVideoAfterItsFrames) {
  const std::string camera = " --camera " + folder_.Write("camera.yaml", kSensor);
  const std::string video = folder_ / "flight.avi";
  WriteTestVideo(folder_ / "flight", VideoFormat::kAvi, 20, cv::Size(640, 480));
  TestFolder::CutOff(video, 0.5);
  const Outcome outcome = Run("land " + video + camera);
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err, HasSubstr("flight.avi: the video is cut off after"));
  EXPECT_GT(Lines(outcome.out), 5);
}

TEST_F(KestrelCommandTest, ReportsFaultyRecording) {
  const std::string recording = WriteRecording();
  folder_.Write("flight/mav0/nav0/data.csv", std::string(kPoses) + "150000000,5,6,3,1,0,0,0\n");
  ExpectInputError("land " + recording, "nav0/data.csv: line 4: timestamp 150000000 out of order");
}

TEST_F(KestrelCommandTest, ReportsFaultyCalibration) {
  const std::string recording = WriteRecording();
  std::string sensor = kSensor;
  sensor.replace(sensor.find("[400,"), 5, "[.nan,");
  ExpectInputError("land " + recording + " --camera " + folder_.Write("nan.yaml", sensor),
                   "nan.yaml");
}

TEST_F(KestrelCommandTest, ReportsOutputFolderThatCannotBeCreated) {
  const std::string recording = WriteRecording();
  ExpectInputError("land " + recording + " --output " + folder_.Write("file", "") + "/out",
                   "file/out: cannot be made");
}

TEST_F(KestrelCommandTest, SuggestsNearestNameForMisspeltOption) {
  const std::string recording = WriteRecording();
  const std::string config = folder_.Write("c.yaml", "landing:\n  hint_sigma: 1\n");
  ExpectInputError("land " + recording + " --config " + config,
                   "c.yaml:2: unknown key 'landing.hint_sigma', did you mean "
                   "'landing.hint_sigma_m'?");
  ExpectInputError("land " + recording + " --set landing.hint_sigmam=1", "did you mean");
  EXPECT_THAT(Run("land " + recording + " --set zzz=1").err, Not(HasSubstr("did you mean")));
}

TEST_F(KestrelCommandTest, EvaluateComparesLandingWithTruth) {
  const std::string flight = WriteRecording();
  folder_.Write("flight/mav0/state_groundtruth_estimate0/data.csv",
                "#timestamp [ns],p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],q_RS_w [],q_RS_x [],q_RS_y "
                "[],q_RS_z []\n100000000,5,6,3,1,0,0,0\n200000000,5,6,3,1,0,0,0\n");
  folder_.Write(
      "flight/mav0/landing_pattern0/data.csv",
      "#timestamp [ns],p_WP_W_x [m],p_WP_W_y [m],p_WP_W_z [m],q_WP_w [],q_WP_x [],q_WP_y [],q_WP_z "
      "[],v_WP_W_x [m s^-1],v_WP_W_y [m s^-1],v_WP_W_z [m s^-1],u [px],v [px],altitude "
      "[m],visible_fraction []\n100000000,4.8,5.7,0,1,0,0,0,0,0,0,359.5,266.17,3,1\n");
  const std::string output = folder_ / "o";
  Succeed("land " + flight + " --output " + output);
  const Outcome outcome = Succeed("evaluate " + flight + " " + output);
  EXPECT_THAT(outcome.out, HasSubstr("| all | 2 to 6 | 1 | 1 | 100.0 |"));
  EXPECT_TRUE(std::filesystem::exists(output + "/evaluation/report.md"));
  EXPECT_TRUE(std::filesystem::exists(output + "/evaluation/error.png"));
  ExpectInputError("evaluate " + flight + " " + output, "--force replaces it");
  ExpectInputError("evaluate " + flight + " " + (folder_ / "none"), "no folder");
  ExpectInputError("evaluate " + output + " " + output, "no recording");
}

TEST_F(KestrelCommandTest, LandWritesTrackAndPrediction) {
  const std::string flight = WriteRecording();
  const std::string output = folder_ / "o";
  Succeed("land " + flight + " --output " + output + " --predict 0.5,1.0");
  EXPECT_THAT(ReadFile(output + "/landing_track.csv"), HasSubstr("\n100000000,searching,"));
  EXPECT_THAT(ReadFile(output + "/landing_prediction.csv"), StartsWith("timestamp_ns,horizon_s"));
  const std::string still = folder_ / "still";
  Succeed("land --still " + flight + " --output " + still);
  EXPECT_FALSE(std::filesystem::exists(still + "/landing_track.csv"));
}

TEST_F(KestrelCommandTest, CalibrateReportsMissingData) {
  const std::string flight = WriteRecording();
  ExpectInputError("calibrate mount " + flight, "seen in 0 images with poses around them");
  std::filesystem::remove(flight + "/mav0/nav0/data.csv");
  ExpectInputError("calibrate clock " + flight, "has no poses of the UAV");
}

TEST_F(KestrelCommandTest, BenchmarkPrintsLinePerStepAndOneToShare) {
  const std::string out = Succeed("benchmark").out;
  EXPECT_THAT(out, HasSubstr("| ring, whole image, 752 x 480 | "));
  EXPECT_THAT(out, HasSubstr("| capture to result, 30 images/s for 5 s | "));
  EXPECT_THAT(out, Not(HasSubstr("| - | - | - | - |"))) << "a step was not measured";
  const std::string line = out.substr(out.rfind("kestrel "));
  constexpr int kSteps = 6;
  EXPECT_EQ(std::count(line.begin(), line.end(), '|'), kSteps + 1) << line;
}

}  // namespace
}  // namespace kestrel
