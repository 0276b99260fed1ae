// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/bags/open_recording.h"

#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/write_file.h"
#include "kestrel/io/recording/test_files.h"

namespace kestrel {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// A recording with the two cameras cam0, of 8 x 6 px, and cam1, of 12 x 6 px.
class TwoCameraRecording : public ::testing::Test {
 protected:
  TwoCameraRecording() {
    WriteCamera("cam0", 8, {100, 200, 300});
    WriteCamera("cam1", 12, {90, 150, 250, 350});
    WriteCalibration("cam0", 8, 0);
    WriteCalibration("cam1", 12, 1e-7);  // 100 ns
  }

  std::string Path(const std::string& name) const { return folder_ / ("flight/mav0/" + name); }
  void WriteText(const std::string& name, const std::string& text) const {
    const std::filesystem::path path = Path(name);
    std::filesystem::create_directories(path.parent_path());
    WriteFile(path, text);
  }
  void WriteCamera(const std::string& camera, int width_px, const std::vector<int>& times) const {
    std::string rows = "#timestamp [ns],filename\n";
    for (const int time : times) {
      rows += fmt::format("{0},{0}.png\n", time);
      WriteTestImage(folder_, fmt::format("flight/mav0/{}/data/{}.png", camera, time),
                     NoiseImage(width_px, 6, CV_8UC1, time));
    }
    WriteText(camera + "/data.csv", rows);
  }
  static std::string CalibrationText(int width_px, double time_offset_s) {
    return fmt::format(
        "camera_model: pinhole\nintrinsics: [10, 10, 3.5, 2.5]\nresolution: [{}, 6]\n"
        "distortion_model: none\ndistortion_coefficients: [0, 0, 0, 0]\ntime_offset_s: {}\n",
        width_px, time_offset_s);
  }
  void WriteCalibration(const std::string& camera, int width_px, double time_offset_s) const {
    WriteText(camera + "/sensor.yaml", CalibrationText(width_px, time_offset_s));
  }
  RecordingChoice Choice() {
    RecordingChoice choice{.sources = {folder_ / "flight"}, .all_cameras = true};
    choice.bag.notify = [this](const std::string& text) { notes_.push_back(text); };
    return choice;
  }
  static std::vector<std::string> NamesOf(const OpenedSource& opened) {
    std::vector<std::string> names;
    for (Frame frame; opened.source->Next(&frame);) {
      opened.RequireSize(frame);
      names.push_back(fmt::format("{} {}", frame.camera, frame.name));
    }
    return names;
  }
  std::string Error(const RecordingChoice& choice) const {
    return InputErrorOf([&] { NamesOf(OpenRecording(choice)); });
  }

  TestFolder folder_;
  std::vector<std::string> notes_;
};

// In order of time on the clock of the navigation: images of cam1 are 100 ns later than they say.
TEST_F(TwoCameraRecording, GivesFramesOfBothInOrderOfTime) {
  const OpenedSource opened = OpenRecording(Choice());
  ASSERT_EQ(opened.further.size(), 1u);
  EXPECT_EQ(opened.calibration.name, "cam0");
  EXPECT_EQ(opened.further[0].name, "cam1");
  EXPECT_EQ(opened.further[0].clock_offset, Duration(100));
  EXPECT_EQ(opened.source->frame_count(), 7u);
  EXPECT_THAT(NamesOf(opened), ElementsAre("0 mav0/cam0/data/100.png", "1 mav0/cam1/data/90.png",
                                           "0 mav0/cam0/data/200.png", "1 mav0/cam1/data/150.png",
                                           "0 mav0/cam0/data/300.png", "1 mav0/cam1/data/250.png",
                                           "1 mav0/cam1/data/350.png"));
  EXPECT_THAT(notes_, IsEmpty());
}

TEST_F(TwoCameraRecording, OneCameraIsUsedWhereOneIsTaken) {
  RecordingChoice choice = Choice();
  choice.all_cameras = false;
  EXPECT_EQ(NamesOf(OpenRecording(choice)).size(), 3u);
  EXPECT_THAT(notes_, ElementsAre(HasSubstr("has 2 cameras: cam0 is used")));
}

TEST_F(TwoCameraRecording, FolderOfACameraIsThatCamera) {
  RecordingChoice choice = Choice();
  choice.sources = {Path("cam1")};
  const OpenedSource opened = OpenRecording(choice);
  EXPECT_THAT(opened.further, IsEmpty());
  EXPECT_EQ(opened.calibration.intrinsics.width_px, 12);
  EXPECT_EQ(NamesOf(opened).front(), "0 data/90.png");
}

TEST_F(TwoCameraRecording, CameraWithoutCalibrationIsLeftOut) {
  std::filesystem::remove(Path("cam1/sensor.yaml"));
  EXPECT_EQ(NamesOf(OpenRecording(Choice())).size(), 3u);
  EXPECT_THAT(notes_, ElementsAre("cam1 has no calibration (sensor.yaml): left out"));
  std::filesystem::remove(Path("cam0/sensor.yaml"));
  WriteCalibration("cam1", 12, 0);
  EXPECT_EQ(NamesOf(OpenRecording(Choice())).size(), 4u);
}

TEST_F(TwoCameraRecording, FileWithAnEntryForEachCalibratesBoth) {
  const auto entry = [](const char* name, int width_px) {
    std::string text = std::string(name) + ":\n";
    const std::string lines = CalibrationText(width_px, 0);
    for (std::size_t at = 0; at < lines.size();) {
      const std::size_t end = lines.find('\n', at) + 1;
      text += "  " + lines.substr(at, end - at);
      at = end;
    }
    return text;
  };
  std::filesystem::remove(Path("cam1/sensor.yaml"));
  RecordingChoice choice = Choice();
  choice.camera = folder_ / "chain.yaml";
  WriteFile(choice.camera, entry("cam0", 8) + entry("cam1", 12));
  EXPECT_EQ(NamesOf(OpenRecording(choice)).size(), 7u);
  choice.sources = {Path("cam1")};
  EXPECT_EQ(NamesOf(OpenRecording(choice)).size(), 4u);
  choice.sources = {folder_ / "flight"};
  WriteFile(choice.camera, entry("cam0", 8));
  EXPECT_THAT(Error(choice), HasSubstr("has no camera 'cam1', expected one of cam0"));
  WriteFile(choice.camera, entry("cam0", 8) + entry("cam0", 12));
  EXPECT_THAT(Error(choice), HasSubstr("chain.yaml"));
}

TEST_F(TwoCameraRecording, BadInputIsRefusedInOneLine) {
  RecordingChoice choice = Choice();
  choice.camera = Path("cam1/sensor.yaml");
  EXPECT_THAT(Error(choice), HasSubstr("sensor.yaml: is of one camera, expected a file with one "
                                       "entry for each"));
  choice = Choice();
  choice.clock_offset = Duration(5);
  EXPECT_THAT(Error(choice), HasSubstr("--clock-offset is of one camera"));
  WriteCalibration("cam1", 8, 0);  // that of cam0
  EXPECT_THAT(Error(Choice()), HasSubstr("mav0/cam1/data/90.png"));
  WriteText("cam1/data.csv", "#timestamp [ns],filename\n");
  EXPECT_THAT(Error(Choice()), HasSubstr("mav0/cam1/data.csv: no rows"));
  std::filesystem::remove(Path("cam1/data.csv"));
  EXPECT_THAT(Error(Choice()), HasSubstr("mav0/cam1/data.csv"));
}

}  // namespace
}  // namespace kestrel
