// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/camera/camera_console.h"

#include <atomic>
#include <filesystem>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/app/web_server/test_browser.h"
#include "kestrel/calibration/lens/test_board_images.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/base/test_folder.h"
#include "kestrel/core/camera/calibration_reader.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

constexpr char kBoard[] = "chessboard:8x5:0.03";

// Shows each image for some frames, again and again.
class PlayedCamera : public LiveSource {
 public:
  explicit PlayedCamera(const std::vector<LensImage>* images) : images_(images) {}

  std::optional<Event> Next(Duration) override {
    constexpr int kFrames = 40;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));  // the camera's pace
    if (is_gone) return std::nullopt;
    Frame frame;
    frame.image = (*images_)[count_++ / kFrames % images_->size()].image;
    frame.time = Now();
    return frame;
  }
  std::string error() const override { return is_gone ? "the cable is off" : ""; }
  CaptureCounters counters() const override { return {}; }

  std::atomic<bool> is_gone{false};

 private:
  const std::vector<LensImage>* images_;
  std::size_t count_ = 0;
};

class CameraConsoleTest : public ::testing::Test {
 protected:
  CameraConsoleTest() {
    const CameraModel lens({320, 240, 250, 250, 160, 120, DistortionModel::kNone, {}});
    images_ = RenderBoard(lens, ParseLensBoard(kBoard), 40, 0.7, 5);
    CameraConsole::Camera camera;
    camera.name = "/dev/video7";
    camera.open = [this]() -> LiveSource* {
      if (is_missing_) throw InputError("/dev/video7: no such camera");
      return &camera_;
    };
    camera.exposure_s = [] { return std::optional(0.004); };
    camera.keep_snapshot = [](const cv::Mat& image, Time) {
      return "kept " + std::to_string(image.cols);
    };
    camera.record = [this](bool is_on) {
      is_recording_ = is_on;
      return is_on ? "recording" : "recorded";
    };
    camera.is_recording = [this] { return is_recording_; };
    camera.notify = [](const std::string&) {};
    console_.emplace(AnyPort(), camera, folder_.path(), LandingPatternDetectorOptions());
    thread_ = std::thread([this] { console_->Play([this] { return is_stopped_.load(); }); });
  }
  ~CameraConsoleTest() override {
    is_stopped_ = true;
    thread_.join();
  }
  int port() const {
    const std::string url = console_->urls().front();
    return std::stoi(url.substr(url.rfind(':') + 1));
  }
  // Waits for a status with this state.
  nlohmann::json AwaitState(TestSocket* socket, const std::string& state) {
    nlohmann::json status = socket->Await("status");
    while (status["state"] != state) status = socket->Await("status");
    return status;
  }

  TestFolder folder_;
  bool is_recording_ = false;  // used by the page's thread only
  std::vector<LensImage> images_;
  PlayedCamera camera_{&images_};
  std::atomic<bool> is_missing_{false}, is_stopped_{false};
  std::optional<CameraConsole> console_;
  std::thread thread_;
};

TEST_F(CameraConsoleTest, ShowsPictureAndItsQuality) {
  TestSocket socket(port());
  AwaitState(&socket, "live");
  const nlohmann::json sample = socket.Await("sample");
  EXPECT_GT(sample["values"][0], 10);
  EXPECT_EQ(sample["values"][1], 4);
  EXPECT_GT(sample["values"][4], 0);
  socket.Send(R"({"images": true})");
  socket.Await("image");
  socket.Send(R"({"command": "snapshot"})");
  EXPECT_EQ(socket.Await("event")["text"], "kept 320");
}

TEST_F(CameraConsoleTest, RecordsOnRequestOfPage) {
  TestSocket socket(port());
  EXPECT_FALSE(AwaitState(&socket, "live")["recording"]);
  socket.Send(R"({"command": "record", "value": 1})");
  EXPECT_EQ(socket.Await("event")["text"], "recording");
  EXPECT_TRUE(socket.Await("status")["recording"]);
  socket.Send(R"({"command": "record", "value": 0})");
  EXPECT_FALSE(socket.Await("status")["recording"]);
}

TEST_F(CameraConsoleTest, ReportsMissingCameraAndReopensIt) {
  TestSocket socket(port());
  AwaitState(&socket, "live");
  camera_.is_gone = true;
  EXPECT_THAT(AwaitState(&socket, "no picture")["reason"].get<std::string>(),
              HasSubstr("the cable is off"));
  camera_.is_gone = false;
  AwaitState(&socket, "live");
}

TEST_F(CameraConsoleTest, RefusesWrongBoard) {
  TestSocket socket(port());
  socket.Await("lens");
  socket.Send(R"({"command": "lens", "settings": ["chessboard:9", ""]})");
  const nlohmann::json lens = socket.Await("lens");
  EXPECT_FALSE(lens["running"]);
  EXPECT_THAT(lens["error"].get<std::string>(), HasSubstr("chessboard:COLUMNSxROWS:SQUARE"));
}

TEST_F(CameraConsoleTest, CalibratesLensAndReplacesFileOnRequestOnly) {
  TestSocket socket(port());
  socket.Await("lens");
  socket.Send(R"({"command": "lens", "settings": [")" + std::string(kBoard) + R"(", ""]})");
  nlohmann::json lens = socket.Await("lens");
  while (lens["estimate"].is_null() || lens["estimate"]["views"] < 14) lens = socket.Await("lens");
  EXPECT_NEAR(lens["estimate"]["focal_px"].get<double>(), 250, 5);
  const auto save = [&](const std::string& settings) {
    socket.Send(R"({"command": "lens-save", "settings": [)" + settings + "]}");
    do lens = socket.Await("lens");
    while (lens["saved"] == "" && lens["save_error"] == "" && !lens["exists"]);
    return lens;
  };
  EXPECT_THAT(save(R"("../camera.yaml")")["save_error"].get<std::string>(),
              HasSubstr("without a folder"));
  const std::string path = folder_ / "camera.yaml";
  socket.Send(R"({"command": "lens-stop"})");
  while (lens["running"]) lens = socket.Await("lens");
  EXPECT_EQ(save(R"("camera.yaml")")["saved"], path);
  EXPECT_THAT(lens["next"].get<std::string>(), HasSubstr("fly /dev/video7 --camera " + path));
  EXPECT_NEAR(ReadCalibration(path).intrinsics.fx_px, 250, 5);
  EXPECT_TRUE(save(R"("camera.yaml")")["exists"]);
  EXPECT_EQ(save(R"("camera.yaml", "replace")")["saved"], path);
}

}  // namespace
}  // namespace kestrel
