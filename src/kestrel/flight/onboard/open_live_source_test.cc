// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/open_live_source.h"

#include <cstddef>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/core/base/test_folder.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

LiveSourceChoice Choice(const std::string& uri) { return {.recording = {.sources = {uri}}}; }

TEST(OpenLiveSourceTest, SchemeOpensMatchingUris) {
  std::string requested;
  const SourceScheme scheme{"mine:", [&](const LiveSourceChoice& choice) {
                              requested = choice.uri();
                              OpenedLiveSource opened;
                              opened.rate_hz = 12;
                              return opened;
                            }};
  EXPECT_EQ(OpenLiveSource(Choice("mine:left"), {}, {scheme}).rate_hz, 12);
  EXPECT_EQ(requested, "mine:left");
  EXPECT_THROW(OpenLiveSource(Choice("/nowhere/mine:left"), {}, {scheme}), InputError);
}

TEST(OpenLiveSourceTest, CameraRequiresCalibration) {
  EXPECT_THAT(InputErrorOf([] { OpenLiveSource(Choice("/dev/video0"), {}); }),
              HasSubstr("give it by --camera FILE"));
}

// A pipeline of test images and a calibration of their size.
class LiveCamerasTest : public ::testing::Test {
 protected:
  static constexpr char kImages[] =
      "videotestsrc is-live=true ! video/x-raw,width=64,height=48,framerate=50/1";

  std::string CameraFile() {
    folder_.Write("camera.yaml",
                  "camera_model: pinhole\nresolution: [64, 48]\nintrinsics: [60, 60, 32, 24]\n"
                  "distortion_model: radial-tangential\n"
                  "distortion_coefficients: [0, 0, 0, 0]\n");
    return folder_ / "camera.yaml";
  }
  RecordingChoice Camera(const std::string& uri, const std::string& file) {
    RecordingChoice choice;
    choice.sources = {uri};
    choice.camera = file;
    return choice;
  }
  OpenedLiveSource Open(const std::vector<RecordingChoice>& cameras) {
    return OpenLiveCameras(cameras, {}, [this](const std::string& text) { reported_ = text; });
  }

  TestFolder folder_;
  std::string reported_;
};

TEST_F(LiveCamerasTest, OneThatCannotBeOpenedIsLeftOut) {
  const std::string file = CameraFile();
  folder_.Write("second.yaml", ReadFile(file));
  const OpenedLiveSource opened =
      Open({Camera("/dev/video99", file), Camera(kImages, folder_ / "second.yaml")});
  EXPECT_THAT(reported_, HasSubstr("cam0: there is no /dev/video99"));
  EXPECT_EQ(opened.calibration.name, "cam1");
  EXPECT_TRUE(opened.further.empty());
}

TEST_F(LiveCamerasTest, DelayOfEachIsMeasured) {
  const std::string mounted = ReadFile(CameraFile()) +
                              "T_BS: [[0, -1, 0, 0], [-1, 0, 0, 0], [0, 0, -1, 0], [0, 0, 0, 1]]\n";
  folder_.Write("first.yaml", mounted);
  folder_.Write("second.yaml", mounted);
  GstreamerCameraOptions options;
  options.measures_delay = true;
  const OpenedLiveSource opened =
      OpenLiveCameras({Camera(kImages, folder_ / "first.yaml"),
                       Camera(std::string(kImages) + " ! identity", folder_ / "second.yaml")},
                      options, {});
  ASSERT_EQ(opened.late.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(opened.late[i].camera, i);
    EXPECT_EQ(opened.late[i].name, "cam" + std::to_string(i));
    EXPECT_THAT(opened.late[i].video->InWords(), HasSubstr("not known yet"));
  }
}

TEST_F(LiveCamerasTest, WrongChoicesAreNamed) {
  const std::string file = CameraFile();
  EXPECT_THAT(InputErrorOf([&] {
                Open({Camera(kImages, file), Camera(kImages, file)});
              }),
              HasSubstr("is given twice"));
  EXPECT_THAT(InputErrorOf([&] {
                Open({Camera(kImages, file), Camera("sim:calm", file)});
              }),
              HasSubstr("sim:calm: expected a camera"));
  const std::string other = std::string(kImages) + " ! identity";
  EXPECT_THAT(InputErrorOf([&] {
                Open({Camera(kImages, file), Camera(other, file)});
              }),
              HasSubstr("is of one camera, expected a --camera FILE for each"));
}

}  // namespace
}  // namespace kestrel
