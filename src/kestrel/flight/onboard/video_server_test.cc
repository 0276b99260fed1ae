// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/video_server.h"

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/test_folder.h"
#include "kestrel/flight/onboard/gstreamer_pipeline.h"
#include "kestrel/flight/onboard/video_sink.h"

namespace kestrel {
namespace {

using std::chrono::milliseconds;
using ::testing::HasSubstr;

const cv::Size kSize(320, 240);

// Plays the video; its pictures are BGR.
std::unique_ptr<GstreamerPipeline> Play(const std::string& address) {
  auto player = std::make_unique<GstreamerPipeline>(
      fmt::format("rtspsrc location={} latency=0 ! rtph264depay ! avdec_h264 ! videoconvert ! "
                  "video/x-raw,format=BGR ! appsink name=sink",
                  address),
      "player", PixelFormat::kBgr);
  player->Start();
  return player;
}

// Calls 'show' every 40 ms until it is destroyed.
class SteadyCamera {
 public:
  explicit SteadyCamera(std::function<void()> show)
      : thread_([this, show = std::move(show)] {
          while (!is_over_) {
            show();
            std::this_thread::sleep_for(milliseconds(40));
          }
        }) {}
  ~SteadyCamera() {
    is_over_ = true;
    thread_.join();
  }

 private:
  std::atomic<bool> is_over_{false};
  std::thread thread_;
};

// Returns the next picture; empty when none comes within 10 s.
cv::Mat PictureOf(GstreamerPipeline& player) {
  for (int i = 0; i < 100; ++i) {
    const GstSamplePointer sample = player.Pull(milliseconds(100));
    if (!sample) continue;
    GstVideoInfo info;
    gst_video_info_from_caps(&info, gst_sample_get_caps(sample.get()));
    cv::Mat picture(info.height, info.width, CV_8UC3);
    return CopyPixels(sample.get(), info, &picture) ? picture : cv::Mat();
  }
  return {};
}

std::string AddressOf(const VideoServer& server, const std::string& user = "") {
  return fmt::format("rtsp://{}127.0.0.1:{}/kestrel", user, server.port());
}

TEST(VideoServerTest, ClientGetsPicturesOfTheRightSizeAndColour) {
  VideoServer server({.port = 0});
  EXPECT_FALSE(server.IsWatched());
  const cv::Mat image(kSize, CV_8UC3, cv::Scalar(200, 60, 30));
  const SteadyCamera camera([&] { server.Show(image, Now() - milliseconds(30)); });
  const auto player = Play(AddressOf(server));
  const cv::Mat picture = PictureOf(*player);
  ASSERT_EQ(picture.size(), kSize);
  EXPECT_TRUE(server.IsWatched());
  const cv::Scalar mean = cv::mean(picture);
  EXPECT_NEAR(mean[0], 200, 12);
  EXPECT_NEAR(mean[1], 60, 12);
  EXPECT_NEAR(mean[2], 30, 12);
  EXPECT_GE(server.delay(), milliseconds(30)) << "from the capture on";
  EXPECT_LT(server.delay(), std::chrono::seconds(2));
}

TEST(VideoServerTest, OddImageLosesItsEdge) {
  VideoServer server({.port = 0});
  const cv::Mat image(241, 321, CV_8UC3, cv::Scalar::all(90));
  const SteadyCamera camera([&] { server.Show(image, Now()); });
  EXPECT_EQ(PictureOf(*Play(AddressOf(server))).size(), kSize);
}

TEST(VideoServerTest, PasswordIsNeeded) {
  VideoServer server({.port = 0, .password = "0123456789abcdef"});
  const cv::Mat image(kSize, CV_8UC3, cv::Scalar::all(90));
  const SteadyCamera camera([&] { server.Show(image, Now()); });
  const auto stranger = Play(AddressOf(server));
  for (int i = 0; i < 100 && stranger->Fault().empty(); ++i) stranger->Pull(milliseconds(100));
  EXPECT_FALSE(stranger->Fault().empty());
  EXPECT_FALSE(server.IsWatched());
  EXPECT_EQ(PictureOf(*Play(AddressOf(server, "kestrel:0123456789abcdef@"))).size(), kSize);
}

TEST(VideoServerTest, TakenPortIsAnError) {
  const VideoServer server({.port = 0});
  EXPECT_THAT(InputErrorOf([&] { VideoServer other({.port = server.port()}); }),
              HasSubstr(fmt::format("cannot listen at 127.0.0.1 port {}", server.port())));
}

// The sink is given the images of a gray camera 25 times a second.
TEST(VideoSinkTest, DrawsResultsAndAge) {
  VideoServer server({.port = 0});
  const auto paint = [](const Observation& observation) {
    cv::Mat drawn = observation.frame.image.clone();
    drawn(cv::Rect(0, 0, 320, 60)).setTo(255);
    return drawn;
  };
  const auto sink = MakeVideoSink(&server, paint, [](const std::string&) {});
  EXPECT_FALSE(sink->IsWanted()) << "nobody looks";
  const cv::Mat image(kSize, CV_8UC1, cv::Scalar(90));
  cv::Mat picture;
  {
    const SteadyCamera camera([&] {
      if (sink->IsWanted()) sink->Take(Observation{{"", Now(), image}, LandingObservation()});
    });
    picture = PictureOf(*Play(AddressOf(server)));
  }
  sink->Finish();
  ASSERT_EQ(picture.size(), kSize);
  EXPECT_GT(cv::mean(picture(cv::Rect(0, 0, 320, 50)))[0], 230) << "painted";
  EXPECT_NEAR(cv::mean(picture(cv::Rect(20, 100, 200, 80)))[0], 90, 12);
  double brightest = 0;
  cv::minMaxLoc(picture(cv::Rect(220, 210, 100, 30)).reshape(1), nullptr, &brightest);
  EXPECT_GT(brightest, 180) << "its age";
}

}  // namespace
}  // namespace kestrel
