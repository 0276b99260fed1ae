// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/calibration/calibration_page.h"

#include <atomic>
#include <chrono>
#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/app/console/replay/replay_console.h"
#include "kestrel/app/web_server/test_browser.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/camera/paper_camera.h"

namespace kestrel {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

// A recording on a page that calibrates. The words of the request make the calibration wait or
// fail.
class CalibrationPageTest : public testing::Test {
 protected:
  CalibrationPageTest() {
    ConsoleOptions options;
    options.port = 0;
    console_.emplace(options, "a recording", ReplaySubject());
    console_->OfferCalibration(
        {Calibrate, [this](const std::string& name, const CalibrationResult&) {
           if (++saved_ > 1) throw InputError("calibrated: cannot be written");
           return "calibrated/" + name + ".yaml";
         }});
    thread_ = std::thread([this] {
      const auto open = [] {
        return [](std::size_t) { return cv::Mat(8, 8, CV_8UC1, cv::Scalar(0)); };
      };
      console_->Play({Frames(), "", {}}, {open, {}}, [this] { return is_stopped_.load(); });
    });
  }
  ~CalibrationPageTest() override {
    is_stopped_ = true;
    thread_.join();
  }

  static std::vector<ReplayFrame> Frames() {
    std::vector<ReplayFrame> frames(9);
    for (std::size_t i = 0; i < frames.size(); ++i) frames[i].time = Time(i * 100ms);
    return frames;
  }

  static std::optional<CalibrationResult> Calibrate(const CalibrationRequest& request,
                                                    const CalibrationPage::Run::GoOn& go_on) {
    if (request.lens) throw InputError("the views cannot tell the lens: tilt the camera");
    while (request.moving) {
      if (!go_on(4)) return std::nullopt;
      std::this_thread::sleep_for(1ms);  // a run's time for a frame
    }
    CalibrationResult result;
    result.calibration.intrinsics = PaperCamera();
    result.report = FlightCoverage({{{3, 4}, 2}}, 9, {752, 480});
    if (!request.clock) {
      result.report.error = "the pattern was seen in 1 images";
      return result;
    }
    FlightCalibration found;
    found.rms_before_m = 0.5;
    AddFlight(found, {}, {}, &result.report);
    return result;
  }

  int port() const {
    const std::string url = console_->urls().front();
    return std::stoi(url.substr(url.rfind(':') + 1));
  }
  static nlohmann::json Next(TestSocket* socket, const std::string& state) {
    while (const auto message = socket->Next("calibration")) {
      if ((*message)["state"] == state) return *message;
    }
    return {};
  }
  std::string File(int number) const {
    TestBrowser browser(port());
    const auto answer =
        browser.Send(browser.Get(fmt::format("/export/calibration-{}.yaml", number)));
    return answer.result_int() == 200 ? answer.body() : "";
  }

  std::optional<ReplayConsole> console_;
  std::atomic<bool> is_stopped_{false};
  std::atomic<int> saved_{0};
  std::thread thread_;
};

TEST_F(CalibrationPageTest, CalibratesShowsAndSaves) {
  TestSocket socket(port());
  EXPECT_EQ(Next(&socket, "none")["can_save"], true);
  socket.Send(R"({"command": "calibrate", "settings": ["mount", "clock"]})");
  const nlohmann::json done = Next(&socket, "done");
  ASSERT_TRUE(done.is_object());
  EXPECT_THAT(done["asked"].dump(), R"(["mount","clock"])");
  EXPECT_EQ(done["numbers"][3]["name"], "clock offset");
  EXPECT_EQ(done["residuals"]["rms_before"], 0.5);
  EXPECT_EQ(done["places"].dump(), "[3,4]");
  EXPECT_EQ(done["saved"], "");
  EXPECT_THAT(File(1), HasSubstr("intrinsics"));
  EXPECT_EQ(File(2), "");
  socket.Send(R"({"command": "calibrate-save"})");
  EXPECT_EQ(Next(&socket, "done")["saved"], "calibrated/mount_clock.yaml");
  socket.Send(R"({"command": "calibrate-save"})");
  EXPECT_EQ(Next(&socket, "done")["save_error"], "calibrated: cannot be written");
}

TEST_F(CalibrationPageTest, ReportsReasonOfRefusal) {
  TestSocket socket(port());
  socket.Send(R"({"command": "calibrate", "settings": ["lens"]})");
  EXPECT_EQ(Next(&socket, "refused")["error"], "the views cannot tell the lens: tilt the camera");
  // The coverage is shown all the same.
  socket.Send(R"({"command": "calibrate", "settings": ["mount"]})");
  const nlohmann::json refused = Next(&socket, "refused");
  EXPECT_EQ(refused["error"], "the pattern was seen in 1 images");
  EXPECT_THAT(refused["coverage"].dump(), HasSubstr("in 1 of 9 images"));
  EXPECT_EQ(File(2), "") << "nothing was found";
  socket.Send(R"({"command": "calibrate-save"})");
  socket.Send(R"({"command": "calibrate", "settings": ["/etc/passwd"]})");
  EXPECT_THAT(Next(&socket, "refused")["error"].dump(), HasSubstr("no calibration of this name"));
  EXPECT_EQ(saved_, 0);
}

TEST_F(CalibrationPageTest, CancelsCalibrationWhilePagePlaysOn) {
  TestSocket socket(port());
  socket.Send(R"({"command": "calibrate", "settings": ["mount", "moving"]})");
  nlohmann::json running;
  do {
    running = Next(&socket, "running");
    ASSERT_TRUE(running.is_object());
  } while (running["done"] != 4);
  EXPECT_EQ(running["of"], 9);
  // Another calibration has to wait for the end of this one.
  socket.Send(R"({"command": "calibrate", "settings": ["clock"]})");
  socket.Send(R"({"command": "step", "value": 3})");
  for (;;) {
    const auto playback = socket.Next("playback");
    ASSERT_TRUE(playback);
    if ((*playback)["frame"] == 3) break;
  }
  socket.Send(R"({"command": "calibrate-cancel"})");
  const nlohmann::json cancelled = Next(&socket, "cancelled");
  ASSERT_TRUE(cancelled.is_object());
  EXPECT_EQ(cancelled["number"], 1);
  socket.Send(R"({"command": "calibrate", "settings": ["clock"]})");
  EXPECT_EQ(Next(&socket, "done")["number"], 2);
}

}  // namespace
}  // namespace kestrel
