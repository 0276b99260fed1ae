// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/replay/replay_console.h"

#include <atomic>
#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/app/console/replay/replay_options.h"
#include "kestrel/app/web_server/test_browser.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/codec/image_codec.h"
#include "kestrel/io/recording/media/video_source.h"
#include "kestrel/io/recording/test_files.h"

namespace kestrel {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kFrames = 20;

// One frame every 100 ms.
std::vector<ReplayFrame> Frames() {
  std::vector<ReplayFrame> frames(kFrames);
  for (std::size_t i = 0; i < kFrames; ++i) {
    frames[i].time = Time(1000s + i * 100ms);
    frames[i].error_px = static_cast<double>(i);
    frames[i].facts = {{"found", "no"}};
  }
  return frames;
}

ReplaySubject Subject() {
  return {LandingSeries(), LandingLayers(), LandingImageViews(),
          ReplayOptions(LandingPipelineOptions()), /*has_truth=*/true};
}

class ReplayConsoleTest : public testing::Test {
 protected:
  static ConsoleOptions FreePort() {
    ConsoleOptions options;
    options.port = 0;
    return options;
  }
  ReplayConsoleTest() {
    thread_ = std::thread([this] {
      const auto open = [this] { return [this](std::size_t frame) { return Image(frame); }; };
      const auto detect = [this](const std::vector<std::string>& settings) {
        return [this, options = WithSettings(LandingPipelineOptions(), settings)](
                   const SecondRun::GoOn& go_on) { return DetectAgain(options, go_on); };
      };
      ReplayResult first{Frames(), "frame,timestamp_ns\n", {}};
      MapEntry& entry = first.map.emplace_back();
      entry.since = Time(1000s + 500ms);
      entry.object.label = "red";
      console_.Play(std::move(first), {open, detect, Autopilot()},
                    [this] { return is_stopped_.load(); });
    });
  }
  ~ReplayConsoleTest() override {
    is_stopped_ = true;
    thread_.join();
  }
  // It enters another mode half-way.
  static RecordedAutopilot Autopilot() {
    const ConsoleVehicle loiter{{{"mode", "good", "LOITER"}}, {}, ""};
    const ConsoleVehicle land{{{"mode", "good", "LAND"}}, {}, ""};
    const Time changed(1000s + 1s);
    return {{{Time::min(), loiter}, {changed, land}},
            {{changed, EventLevel::kInfo, "mode LAND, armed"}},
            ""};
  }
  // A run that finds the pattern in the first half of the frames, unless it has to wait or
  // fail.
  std::optional<ReplayResult> DetectAgain(const LandingPipelineOptions& options,
                                          const SecondRun::GoOn& go_on) {
    if (options.hint_age_s == 7) throw InputError("frame3.png: no such file");
    while (options.hint_age_s == 8) {
      if (!go_on(5)) return std::nullopt;
      std::this_thread::sleep_for(1ms);  // a run's time for a frame
    }
    ReplayResult result{Frames(), "second\n", {}};
    for (std::size_t i = 0; i < kFrames / 2; ++i) {
      ReplayFrame& frame = result.frames[i];
      frame.mark = FrameMark::kFound;
      frame.shapes = {{OverlayLayer::kDetection, {{188, 120}}, "ring 0.93"},
                      {OverlayLayer::kPrediction, {{100, 50}}, ""}};
      frame.facts = {{"found", "yes"}};
    }
    return result;
  }
  cv::Mat Image(std::size_t frame) {
    if (frame == missing_) throw InputError("frame7.png: no such file");
    read_ = frame;
    return cv::Mat(240, 376, CV_8UC1, cv::Scalar(static_cast<double>(frame)));
  }
  // The next report of the second run with this state; null: there is none.
  static nlohmann::json NextSecond(TestSocket* socket, const std::string& state) {
    while (const auto second = socket->Next("second")) {
      if ((*second)["state"] == state) return *second;
    }
    return {};
  }
  int port() const {
    const std::string url = console_.urls().front();
    return std::stoi(url.substr(url.rfind(':') + 1));
  }
  // Reads until the page is told this frame with this speed; false when it is not.
  static bool IsShown(TestSocket* socket, std::size_t frame, double speed) {
    while (const auto playback = socket->Next("playback")) {
      if ((*playback)["frame"] == frame && (*playback)["speed"] == speed) return true;
    }
    return false;
  }

  std::atomic<std::size_t> missing_{99};
  std::atomic<bool> is_stopped_{false};
  std::atomic<std::size_t> read_{99};
  ReplayConsole console_{FreePort(), "a recording", Subject()};
  std::thread thread_;
};

TEST_F(ReplayConsoleTest, SeeksStepsAndPlays) {
  TestSocket socket(port());
  const auto timeline = socket.Next("timeline");
  ASSERT_TRUE(timeline);
  EXPECT_EQ((*timeline)["times_ms"].size(), kFrames);
  socket.Send(R"({"command": "seek", "value": 0.52})");
  EXPECT_TRUE(IsShown(&socket, 5, 0));
  EXPECT_EQ(read_, 5U);
  socket.Send(R"({"command": "step", "value": -1})");
  EXPECT_TRUE(IsShown(&socket, 4, 0));
  socket.Send(R"({"command": "seek", "value": -1e300})");
  EXPECT_TRUE(IsShown(&socket, 0, 0));
  socket.Send(R"({"command": "step", "value": 1e300})");
  EXPECT_TRUE(IsShown(&socket, kFrames - 1, 0));
  // Play at the end starts from the beginning, and holds at the end.
  socket.Send(R"({"command": "play", "value": 0.001})");
  EXPECT_TRUE(IsShown(&socket, 0, 0.001));
  socket.Send(R"({"command": "play", "value": 10})");
  EXPECT_TRUE(IsShown(&socket, kFrames - 1, 0));
  socket.Send(R"({"command": "play", "value": -20})");
  EXPECT_TRUE(IsShown(&socket, 0, 0));
}

TEST_F(ReplayConsoleTest, SendsPlotsOfWholeRecordingAtOnce) {
  TestSocket socket(port());
  const auto series = socket.Next("series");
  ASSERT_TRUE(series);
  EXPECT_EQ((*series)["times_ms"].size(), kFrames);
  for (const auto& values : (*series)["values"]) EXPECT_EQ(values.size(), kFrames);
}

TEST_F(ReplayConsoleTest, ShowsVehicleStateAtFrame) {
  TestSocket socket(port());
  const auto is_at = [&socket](double seconds, const std::string& mode) {
    socket.Send(fmt::format(R"({{"command": "seek", "value": {}}})", seconds));
    while (const auto vehicle = socket.Next("vehicle")) {
      if ((*vehicle)["facts"][0]["measured"] == mode) return true;
    }
    return false;
  };
  const auto log = socket.Next("log");
  ASSERT_TRUE(log);
  EXPECT_EQ((*log)["events"][0]["text"], "mode LAND, armed");
  EXPECT_EQ((*log)["events"][0]["time"], "1001000000000");
  EXPECT_TRUE(is_at(1.5, "LAND"));
  EXPECT_TRUE(is_at(0.5, "LOITER"));
}

TEST_F(ReplayConsoleTest, DetectsAgainWithOtherOptions) {
  TestSocket socket(port());
  const auto options = socket.Next("options");
  ASSERT_TRUE(options);
  EXPECT_EQ((*options)["options"][0]["name"], "landing.detector.pattern.outer_diameter_m");
  socket.Send(R"({"command": "detect", "settings": ["landing.hint_age_s=1"]})");
  const nlohmann::json second = NextSecond(&socket, "done");
  ASSERT_TRUE(second.is_object());
  EXPECT_EQ(second["marks"], "ffffffffff----------");
  EXPECT_EQ(second["settings"][0], "landing.hint_age_s=1");
  // The shapes are drawn beside those of the first run, which has none here. A picture from
  // before the second run may still be on its way.
  nlohmann::json shapes;
  while (shapes.empty()) {
    socket.Send(R"({"images": true})");
    const auto image = socket.Next("image");
    ASSERT_TRUE(image);
    shapes = (*image)["shapes"];
    socket.Send(fmt::format(R"({{"ack": {}}})", (*image)["sequence"].get<int>()));
    if (shapes.empty()) socket.Send(R"({"command": "step", "value": 0})");
  }
  EXPECT_EQ(shapes[0]["layer"], "detection");
  EXPECT_EQ(shapes[0]["run"], 2);
  EXPECT_EQ(shapes[0]["label"], "ring 0.93");
}

TEST_F(ReplayConsoleTest, SendsFindingsOfEachRunForFrame) {
  TestSocket socket(port());
  const auto next = [&socket](std::size_t runs) {
    while (const auto findings = socket.Next("findings")) {
      if ((*findings)["runs"].size() == runs) return *findings;
    }
    return nlohmann::json();
  };
  EXPECT_EQ(next(1)["runs"][0][0], (nlohmann::json{{"name", "found"}, {"value", "no"}}));
  socket.Send(R"({"command": "detect", "settings": []})");
  const nlohmann::json both = next(2);
  ASSERT_TRUE(both.is_object());
  EXPECT_EQ(both["frame"], 0);
  EXPECT_EQ(both["runs"][1][0]["value"], "yes");
}

TEST_F(ReplayConsoleTest, MapHasObjectsSeenUntilFrame) {
  TestSocket socket(port());
  const auto mapped = [&socket](int frames) {
    socket.Send(fmt::format(R"({{"command": "step", "value": {}}})", frames));
    return socket.Next("map").value_or(nlohmann::json());
  };
  ASSERT_TRUE(socket.Next("map"));
  EXPECT_EQ(mapped(4)["mapped"].size(), 0u);
  const nlohmann::json map = mapped(1);
  ASSERT_EQ(map["mapped"].size(), 1u);
  EXPECT_EQ(map["mapped"][0]["label"], "red");
}

TEST_F(ReplayConsoleTest, ExportsClip) {
  TestSocket socket(port());
  ASSERT_TRUE(socket.Next("timeline"));
  TestBrowser browser(port());
  const auto clip = browser.Send(browser.Get("/export/overlays-3-8.mp4"));
  ASSERT_EQ(clip.result_int(), 200u) << clip.body();
  const std::string disposition(clip["Content-Disposition"]);
  EXPECT_TRUE(disposition.starts_with("attachment; filename=\"overlays-3-8.")) << disposition;
  EXPECT_EQ(clip["X-Content-Type-Options"], "nosniff");
  const TestFolder folder;
  const auto video = OpenVideoFile(
      folder.Write(clip["Content-Type"] == "video/mp4" ? "a.mp4" : "a.avi", clip.body()));
  int frames = 0;
  for (Frame frame; video->Next(&frame); ++frames) {
    EXPECT_EQ(frame.image.size(), cv::Size(376, 240));
  }
  EXPECT_EQ(frames, 6);
  EXPECT_NEAR(video->rate_hz(), 10, 0.1);
  // The connection goes on; there is no clip that ends after the recording.
  EXPECT_EQ(browser.Send(browser.Get("/export/frame-1.png")).result_int(), 200u);
  EXPECT_EQ(browser.Send(browser.Get("/export/clip-3-20.mp4")).result_int(), 404u);
}

TEST_F(ReplayConsoleTest, RefusesClipWithMissingFrame) {
  missing_ = 7;
  TestSocket socket(port());
  ASSERT_TRUE(socket.Next("timeline"));
  TestBrowser browser(port());
  const auto refused = browser.Send(browser.Get("/export/clip-0-19.mp4"));
  EXPECT_EQ(refused.result_int(), 409u);
  EXPECT_EQ(refused.body(), "frame7.png: no such file\n");
}

TEST_F(ReplayConsoleTest, ExportsFramesAndTables) {
  TestSocket socket(port());
  socket.Send(R"({"command": "detect", "settings": []})");
  ASSERT_TRUE(NextSecond(&socket, "done").is_object());
  TestBrowser browser(port());
  const auto get = [&](const std::string& path) { return browser.Send(browser.Get(path)); };
  const auto picture = [&](const std::string& path) {
    const std::string png = get(path).body();
    return png.empty() ? cv::Mat() : DecodeImage(png, "picture");
  };
  const cv::Mat plain(240, 376, CV_8UC1, cv::Scalar(7));
  EXPECT_EQ(cv::norm(picture("/export/frame-7.png"), plain, cv::NORM_INF), 0);
  const cv::Mat drawn = picture("/export/overlays-7.png");
  ASSERT_EQ(drawn.type(), CV_8UC3);
  EXPECT_EQ(drawn.at<cv::Vec3b>(120, 188), cv::Vec3b(74, 216, 255)) << "the second run's centre";
  EXPECT_EQ(get("/export/detections-1.csv").body(), "frame,timestamp_ns\n");
  const auto second = get("/export/detections-2.csv");
  EXPECT_EQ(second.body(), "second\n");
  EXPECT_EQ(second["Content-Disposition"], "attachment; filename=\"detections-2.csv\"");
  EXPECT_EQ(get("/export/frame-20.png").result_int(), 404u) << "the last is 19";
}

TEST_F(ReplayConsoleTest, RefusesExportToOtherPages) {
  TestSocket socket(port());
  ASSERT_TRUE(socket.Next("timeline"));
  for (const char* path : {"/export/../frame-1.png", "/export/frame-x.png", "/export/"}) {
    TestBrowser browser(port());
    EXPECT_EQ(browser.Send(browser.Get(path)).result_int(), 404u) << path;
  }
  // A link on another site may open the page, but not this.
  TestBrowser stranger(port());
  auto request = stranger.Get("/export/frame-1.png");
  request.set("Sec-Fetch-Site", "cross-site");
  request.set("Sec-Fetch-Mode", "navigate");
  EXPECT_EQ(stranger.Send(request).result_int(), 403u);
  TestBrowser rebound(port());
  auto foreign = rebound.Get("/export/frame-1.png");
  foreign.set(boost::beast::http::field::host, "evil.example");
  EXPECT_EQ(rebound.Send(foreign).result_int(), 421u);
}

TEST_F(ReplayConsoleTest, CancelsSecondRunWhilePagePlaysOn) {
  TestSocket socket(port());
  socket.Send(R"({"command": "detect", "settings": ["landing.hint_age_s=8"]})");
  for (;;) {
    const nlohmann::json running = NextSecond(&socket, "running");
    ASSERT_TRUE(running.is_object());
    if (running["done"] == 5) break;
  }
  socket.Send(R"({"command": "step", "value": 3})");
  EXPECT_TRUE(IsShown(&socket, 3, 0));
  socket.Send(R"({"command": "cancel"})");
  EXPECT_TRUE(NextSecond(&socket, "cancelled").is_object());
  // A run in progress makes way for the next.
  socket.Send(R"({"command": "detect", "settings": ["landing.hint_age_s=8"]})");
  EXPECT_TRUE(NextSecond(&socket, "running").is_object());
  socket.Send(R"({"command": "detect", "settings": []})");
  EXPECT_TRUE(NextSecond(&socket, "done").is_object());
}

TEST_F(ReplayConsoleTest, ReportsWhySecondRunFails) {
  TestSocket socket(port());
  socket.Send(R"({"command": "detect", "settings": ["landing.hint_age_s=7"]})");
  EXPECT_EQ(NextSecond(&socket, "failed")["error"], "frame3.png: no such file");
  socket.Send(R"({"command": "detect", "settings": ["fly.keep_folder=/"]})");
  EXPECT_EQ(NextSecond(&socket, "failed")["error"],
            "fly.keep_folder: no option that the page may change");
}

TEST_F(ReplayConsoleTest, ReportsFrameWithMissingFile) {
  missing_ = 7;
  TestSocket socket(port());
  socket.Send(R"({"command": "seek", "value": 0.7})");
  const auto event = socket.Next("event");
  ASSERT_TRUE(event);
  EXPECT_EQ((*event)["text"], "frame7.png: no such file");
  socket.Send(R"({"images": true})");
  socket.Send(R"({"command": "step", "value": 1})");
  EXPECT_TRUE(IsShown(&socket, 8, 0));
}

}  // namespace
}  // namespace kestrel
