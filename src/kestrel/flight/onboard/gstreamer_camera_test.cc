// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/gstreamer_camera.h"

#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr char kTestCamera[] =
    "videotestsrc is-live=true pattern=white ! video/x-raw,width=64,height=48,framerate=50/1";

CameraIntrinsics Small() {
  return {.width_px = 64,
          .height_px = 48,
          .fx_px = 60,
          .fy_px = 60,
          .cx_px = 32,
          .cy_px = 24,
          .distortion = {}};
}

GstreamerCamera Camera(const std::string& pipeline, const GstreamerCameraOptions& options = {},
                       PixelFormat format = PixelFormat::kGray) {
  return GstreamerCamera(pipeline, Small(), format, options);
}

// Returns the next frame; an empty one when none comes within 20 s.
Frame NextFrame(GstreamerCamera* camera) {
  const Time deadline = Now() + seconds(20);
  while (Now() < deadline) {
    const std::optional<Event> event = camera->Next(milliseconds(50));
    if (event && std::holds_alternative<Frame>(*event)) return std::get<Frame>(*event);
  }
  ADD_FAILURE() << "no frame: " << camera->error();
  return {};
}

std::string ErrorOf(const std::string& pipeline, const GstreamerCameraOptions& options = {}) {
  try {
    Camera(pipeline, options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(GstreamerCamera, StampsFramesWithCaptureTimeOnLocalClock) {
  const Time start = Now();
  GstreamerCamera camera = Camera(kTestCamera);
  Time last = start;
  for (int i = 0; i < 10; ++i) {
    const Frame frame = NextFrame(&camera);
    ASSERT_EQ(frame.image.size(), cv::Size(64, 48));
    ASSERT_EQ(frame.image.type(), CV_8UC1);
    EXPECT_GT(cv::mean(frame.image)[0], 200);
    EXPECT_GT(frame.time, last);
    EXPECT_LE(frame.time, Now());
    last = frame.time;
  }
  const CaptureCounters counters = camera.counters();
  EXPECT_EQ(counters.captured, 10u);
  EXPECT_EQ(counters.untimed, 0u);
}

TEST(GstreamerCamera, SubtractsExposureAndReadOutFromTime) {
  GstreamerCamera plain = Camera(kTestCamera);
  GstreamerCamera delayed = Camera(kTestCamera, {.readout_s = 0.9, .exposure_s = 0.2});
  NextFrame(&plain);
  NextFrame(&delayed);
  EXPECT_LT(NextFrame(&delayed).time, NextFrame(&plain).time - milliseconds(500));
}

TEST(GstreamerCamera, DeliversNewestFrameAndCountsDroppedOnes) {
  GstreamerCamera camera = Camera(kTestCamera);
  NextFrame(&camera);
  std::this_thread::sleep_for(milliseconds(400));  // a reader that is late
  NextFrame(&camera);                              // it was already waiting
  const Time now = Now();
  EXPECT_GT(NextFrame(&camera).time, now - milliseconds(300));
  EXPECT_GE(camera.counters().missed, 5u);
}

TEST(GstreamerCamera, DeliversColour) {
  GstreamerCamera camera =
      Camera("videotestsrc is-live=true pattern=red ! video/x-raw,width=64,height=48", {},
             PixelFormat::kBgr);
  const Frame frame = NextFrame(&camera);
  ASSERT_EQ(frame.image.type(), CV_8UC3);
  const cv::Scalar mean = cv::mean(frame.image);
  EXPECT_LT(mean[0], 50);
  EXPECT_GT(mean[2], 200);
}

TEST(GstreamerCamera, AcceptsPipelineWithAppsink) {
  GstreamerCamera camera = Camera(std::string(kTestCamera) + " ! videoconvert ! appsink");
  EXPECT_FALSE(NextFrame(&camera).image.empty());
}

TEST(GstreamerCamera, PlaysNonLiveSourceInRealTimeToItsEnd) {
  const Time start = Now();
  GstreamerCamera camera =
      Camera("videotestsrc num-buffers=10 ! video/x-raw,width=64,height=48,framerate=50/1");
  const Time deadline = start + seconds(20);
  bool has_ended = false;
  while (!has_ended && Now() < deadline) {
    const auto event = camera.Next(milliseconds(50));
    has_ended = event && std::holds_alternative<EndOfStream>(*event);
  }
  EXPECT_TRUE(has_ended);
  EXPECT_GE(Now() - start, milliseconds(180));
  EXPECT_TRUE(std::holds_alternative<EndOfStream>(*camera.Next(milliseconds(1))));
}

TEST(GstreamerCamera, ReportsLostCameraAndReopensIt) {
  GstreamerCamera camera = Camera(
      "videotestsrc is-live=true num-buffers=3 ! video/x-raw,width=64,height=48,framerate=50/1",
      {.reopen_s = 0.05});
  std::string reported;
  const Time deadline = Now() + seconds(20);
  while (camera.counters().reopened < 2 && Now() < deadline) {
    camera.Next(milliseconds(20));
    if (!camera.error().empty()) reported = camera.error();
  }
  EXPECT_THAT(reported, HasSubstr("the camera has stopped"));
  EXPECT_GE(camera.counters().reopened, 2u);
  EXPECT_GT(NextFrame(&camera).time, Time());
}

TEST(GstreamerCamera, ReportsFaultsInOneLine) {
  for (const std::string& error :
       {ErrorOf("/dev/video987"), ErrorOf("nosuchelement ! videoconvert"),
        ErrorOf("videotestsrc is-live=true ! video/x-raw,width=32,height=48"),
        ErrorOf("videotestsrc ! fakesink name=appsink_is_missing"),
        ErrorOf(kTestCamera, {.exposure_property = "camera.exposure"}),
        ErrorOf(kTestCamera, {.exposure_property = "videotestsrc0.exposure"}),
        ErrorOf(kTestCamera, {.stall_s = -1})}) {
    EXPECT_NE(error, "");
    EXPECT_THAT(error, Not(HasSubstr("\n")));
  }
  EXPECT_THAT(ErrorOf("/dev/video987"), HasSubstr("/dev/video987"));
  EXPECT_THAT(ErrorOf("nosuchelement ! videoconvert"), HasSubstr("nosuchelement"));
  EXPECT_THAT(ErrorOf("videotestsrc is-live=true ! video/x-raw,width=32,height=48"),
              HasSubstr("the image is 32x48 px, expected 64x48 px as in the calibration"));
}

TEST(GstreamerCamera, SetsExposureByElementProperty) {
  GstreamerCamera camera = Camera(
      "videotestsrc is-live=true pattern=smpte75 ! video/x-raw,width=64,height=48,format=I420 ! "
      "videobalance name=light contrast=0",
      {.exposure_property = "light.contrast", .exposure_unit_s = 1e-3});
  const auto spread = [&] {
    cv::Scalar mean;
    cv::Scalar deviation;
    cv::meanStdDev(NextFrame(&camera).image, mean, deviation);
    return deviation[0];
  };
  EXPECT_LT(spread(), 5);
  EXPECT_TRUE(camera.SetExposure(1e-3));
  for (int i = 0; i < 100 && spread() < 5; ++i) {
  }
  EXPECT_GT(spread(), 20);
  GstreamerCamera without = Camera(kTestCamera);
  EXPECT_FALSE(without.SetExposure(1e-3));
}

}  // namespace
}  // namespace kestrel
