// SPDX-License-Identifier: BSD-3-Clause
// Cameras that come over RTSP, from GStreamer's server in this process.
#include "kestrel/flight/onboard/late_video.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/test_folder.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/flight/onboard/gstreamer_camera.h"
#include "kestrel/flight/onboard/test_rtsp_server.h"

namespace kestrel {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr Duration kImagePeriod = milliseconds(50);
constexpr int kBits = 8;

CameraCalibration StreamCamera() {
  CameraCalibration camera;
  camera.intrinsics = {.width_px = 320,
                       .height_px = 240,
                       .fx_px = 240,
                       .fy_px = 240,
                       .cx_px = 159.5,
                       .cy_px = 119.5,
                       .distortion = {}};
  camera.body_from_camera.emplace().rotation = Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitX());
  return camera;
}

cv::Mat Texture(int side, std::uint64_t seed) {
  Random random(seed);
  cv::Mat noise(side / 16, side / 16, CV_8UC1);
  for (int i = 0; i < noise.rows * noise.cols; ++i) {
    noise.data[i] = static_cast<std::uint8_t>(random.Integer(40, 210));
  }
  cv::resize(noise, noise, {side, side}, 0, 0, cv::INTER_CUBIC);
  return noise;
}

// Small black and white blocks at the top.
void DrawNumber(int number, cv::Mat* image) {
  for (int bit = 0; bit < kBits; ++bit) {
    (*image)({bit * 16, 0, 16, 16}).setTo((number >> bit & 1) != 0 ? 255 : 0);
  }
}

int NumberIn(const cv::Mat& image) {
  int number = 0;
  for (int bit = 0; bit < kBits; ++bit) {
    if (cv::mean(image({bit * 16 + 4, 4, 8, 8}))[0] > 127) number |= 1 << bit;
  }
  return number;
}

// An image that moves.
cv::Mat Numbered(int number, cv::Size size = {320, 240}) {
  static const cv::Mat texture = Texture(800, 3);
  cv::Mat image =
      texture({100 + 6 * (number % 50), 100 + 3 * (number % 30), size.width, size.height}).clone();
  DrawNumber(number, &image);
  return image;
}

// Serves numbered images until it is destroyed.
class Stream {
 public:
  explicit Stream(const TestVideoLine& line, int port = 0) : server_(line, port) {
    thread_ = std::thread([this] {
      Time due = Now();
      for (int i = 0; !is_over_; ++i, due += kImagePeriod) {
        std::this_thread::sleep_for(due - Now());
        const cv::Size size = is_small_ ? cv::Size(288, 160) : cv::Size(320, 240);
        server_.Push(Numbered(i % (1 << kBits), size), due);
      }
    });
  }
  ~Stream() {
    is_over_ = true;
    thread_.join();
  }
  const TestRtspServer& server() const { return server_; }
  void set_is_small(bool is_small) { is_small_ = is_small; }

 private:
  TestRtspServer server_;
  std::atomic<bool> is_over_{false};
  std::atomic<bool> is_small_{false};
  std::thread thread_;
};

// Passes the frames of the next seconds on.
void ForFrames(LiveSource* camera, Duration time, const std::function<void(const Frame&)>& take) {
  const Time end = Now() + time;
  while (Now() < end) {
    const auto event = camera->Next(milliseconds(50));
    if (event && std::holds_alternative<Frame>(*event)) take(std::get<Frame>(*event));
  }
}

bool ComesWithin(LiveSource* camera, Duration time, const std::function<bool()>& condition) {
  const Time end = Now() + time;
  while (Now() < end && !condition()) camera->Next(milliseconds(50));
  return condition();
}

std::unique_ptr<GstreamerCamera> Open(const std::string& address) {
  return std::make_unique<GstreamerCamera>(address, StreamCamera().intrinsics, PixelFormat::kGray,
                                           GstreamerCameraOptions());
}

std::string OpenErrorOf(const std::string& address) {
  return InputErrorOf([&] { Open(address); });
}

TEST(NetworkCameraTest, TimesHaveIntervalsOfSender) {
  const Stream stream({.delay = milliseconds(150), .jitter = milliseconds(40)});
  const auto camera = Open(stream.server().address());
  std::vector<double> steps_s;
  std::optional<Time> last;
  int frames = 0;
  ForFrames(camera.get(), seconds(8), [&](const Frame& frame) {
    if (last && ++frames > 60) steps_s.push_back(ToSeconds(frame.time - *last));
    last = frame.time;
    EXPECT_GT(Now() - frame.time, milliseconds(0));
  });
  ASSERT_GT(steps_s.size(), 50u);
  const double period_s = ToSeconds(kImagePeriod);
  const auto even = std::ranges::count_if(steps_s, [&](double step_s) {
    return std::abs(step_s - period_s * std::round(step_s / period_s)) < 0.003;
  });
  // A sender on a loaded computer stamps some of its images late.
  EXPECT_GT(even, 0.9 * static_cast<double>(steps_s.size()));
  EXPECT_EQ(camera->counters().untimed, 0u);
}

TEST(NetworkCameraTest, SmearedImagesAreLeftOut) {
  for (const std::string& encoder :
       {TestVideoLine().encoder,
        std::string("x265enc tune=zerolatency speed-preset=ultrafast key-int-max=10 bitrate=600 ! "
                    "rtph265pay name=pay0 pt=96 config-interval=-1")}) {
    const Stream stream({.loss = 0.03, .encoder = encoder});
    const auto camera = Open(stream.server().address());
    int frames = 0;
    ForFrames(camera.get(), seconds(8), [&](const Frame& frame) {
      ++frames;
      const cv::Mat sent = Numbered(NumberIn(frame.image));
      cv::Mat difference;
      cv::absdiff(sent, frame.image, difference);
      cv::blur(difference, difference, {16, 16});
      double largest = 0;
      cv::minMaxLoc(difference, nullptr, &largest);
      EXPECT_LT(largest, 40) << NumberIn(frame.image);
    });
    EXPECT_GT(frames, 20) << encoder;
  }
}

TEST(NetworkCameraTest, ReportsRefusedAddressWithoutPassword) {
  const Stream stream({.user = "pilot", .password = "correct"});
  const std::string host = "@127.0.0.1:" + std::to_string(stream.server().port());
  for (const auto& [address, words] :
       {std::pair{"rtsp://pilot:secret" + host + "/main", "refuses user and password"},
        {"rtsp://pilot:correct" + host + "/none", "no such stream"},
        {std::string("rtsp://pilot:secret@127.0.0.1:1/main"), "no connection"}}) {
    const std::string error = OpenErrorOf(address);
    EXPECT_THAT(error, HasSubstr(words));
    EXPECT_THAT(error, HasSubstr("rtsp://***@127.0.0.1"));
    EXPECT_THAT(error, Not(HasSubstr("secret")));
    EXPECT_THAT(error, Not(HasSubstr("correct")));
    EXPECT_THAT(error, Not(HasSubstr("\n")));
  }
  EXPECT_NO_THROW(Open("rtsp://pilot:correct" + host + "/main"));
}

TEST(NetworkCameraTest, ImagesOfAnotherSizeAreLeftOut) {
  Stream stream({});
  const auto camera = Open(stream.server().address());
  stream.set_is_small(true);
  ASSERT_TRUE(ComesWithin(camera.get(), seconds(10), [&] { return !camera->error().empty(); }));
  EXPECT_THAT(camera->error(), HasSubstr("the image is 288x160 px, expected 320x240 px"));
  ForFrames(camera.get(), seconds(1),
            [](const Frame& frame) { ADD_FAILURE() << frame.image.cols; });
  stream.set_is_small(false);
  EXPECT_TRUE(ComesWithin(camera.get(), seconds(10), [&] { return camera->error().empty(); }));
}

TEST(NetworkCameraTest, StreamThatBreaksComesBack) {
  auto stream = std::make_unique<Stream>(TestVideoLine());
  const int port = stream->server().port();
  const auto camera = Open(stream->server().address());
  stream.reset();
  ASSERT_TRUE(ComesWithin(camera.get(), seconds(10), [&] { return !camera->error().empty(); }));
  stream = std::make_unique<Stream>(TestVideoLine(), port);
  EXPECT_TRUE(ComesWithin(camera.get(), seconds(20), [&] { return camera->error().empty(); }));
  EXPECT_EQ(camera->counters().reopened, 1u);
}

// A camera that turns over a far texture, its images over a line, and its attitude in time.
class TurningCamera {
 public:
  explicit TurningCamera(const TestVideoLine& line) : server_(line) {
    thread_ = std::thread([this] {
      Time due = begin_;
      for (int i = 0; !is_over_; ++i, due += kImagePeriod) {
        std::this_thread::sleep_for(due - Now());
        cv::Mat image = View(AttitudeAt(due));
        DrawNumber(i % (1 << kBits), &image);
        server_.Push(image, due);
      }
    });
  }
  ~TurningCamera() {
    is_over_ = true;
    thread_.join();
  }
  std::string address() const { return server_.address(); }
  // Returns how much later than its capture the time of a frame is.
  double ErrorOf(const Frame& frame) const {
    const Time first = begin_ + NumberIn(frame.image) * kImagePeriod;
    const double round_s = ToSeconds(kImagePeriod) * (1 << kBits);
    return std::remainder(ToSeconds(frame.time - first), round_s);
  }
  PoseSample PoseAt(Time time) const {
    PoseSample pose{.time = time, .world_from_body = {}};
    pose.world_from_body.rotation =
        AttitudeAt(time) * StreamCamera().body_from_camera->rotation.conjugate();
    return pose;
  }

 private:
  // world_from_camera; turns by 15 deg/s at most.
  Eigen::Quaterniond AttitudeAt(Time time) const {
    const double s = ToSeconds(time - begin_);
    const double a = Radians(4) * std::sin(2.6 * s) + Radians(3) * std::sin(1.1 * s + 1);
    const double b = Radians(4) * std::sin(2.1 * s + 2) + Radians(3) * std::sin(0.7 * s);
    return Eigen::AngleAxisd(a, Eigen::Vector3d::UnitX()) *
           Eigen::AngleAxisd(b, Eigen::Vector3d::UnitY());
  }
  static cv::Mat View(const Eigen::Quaterniond& attitude) {
    static const cv::Mat texture = Texture(800, 5);
    const Eigen::Matrix3d of_camera =
        (Eigen::Matrix3d() << 240, 0, 159.5, 0, 240, 119.5, 0, 0, 1).finished();
    const Eigen::Matrix3d of_texture =
        (Eigen::Matrix3d() << 240, 0, 399.5, 0, 240, 399.5, 0, 0, 1).finished();
    const Eigen::Matrix3d map = of_texture * attitude.toRotationMatrix() * of_camera.inverse();
    cv::Matx33d warp;
    for (int i = 0; i < 9; ++i) warp(i / 3, i % 3) = map(i / 3, i % 3);
    cv::Mat view;
    cv::warpPerspective(texture, view, warp, {320, 240}, cv::INTER_LINEAR | cv::WARP_INVERSE_MAP);
    return view;
  }

  TestRtspServer server_;
  Time begin_ = Now();
  std::atomic<bool> is_over_{false};
  std::thread thread_;
};

class LateVideoTest : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Delays, LateVideoTest, testing::Values(100, 300));

TEST_P(LateVideoTest, DelayIsKnownAfterTurns) {
  const TurningCamera turning(
      {.delay = milliseconds(GetParam()), .jitter = milliseconds(20), .loss = 0.02});
  LateVideo video(Open(turning.address()), StreamCamera(), true);
  EXPECT_THAT(video.InWords(), HasSubstr("not known yet"));
  Time pose_due = Now();
  const auto add_poses = [&] {
    for (; pose_due < Now(); pose_due += milliseconds(20)) video.Add(turning.PoseAt(pose_due));
  };
  ForFrames(&video, seconds(20), [&](const Frame&) { add_poses(); });
  ASSERT_TRUE(video.offset()) << video.InWords();
  EXPECT_THAT(video.InWords(), HasSubstr("ms late, +-"));
  std::vector<double> errors_s;
  ForFrames(&video, seconds(2), [&](const Frame& frame) {
    add_poses();
    errors_s.push_back(turning.ErrorOf(frame));
  });
  ASSERT_GT(errors_s.size(), 5u);
  std::ranges::sort(errors_s);
  const double error_s = errors_s[errors_s.size() / 2];
  RecordProperty("late_ms", std::to_string(-1e3 * video.offset()->offset_s));
  RecordProperty("error_ms", std::to_string(1e3 * error_s));
  EXPECT_NEAR(error_s, 0, 0.01);
}

}  // namespace
}  // namespace kestrel
