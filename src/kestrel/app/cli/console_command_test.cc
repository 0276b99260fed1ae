// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <filesystem>
#include <string>

#include "kestrel/app/cli/test_running_command.h"
#include "kestrel/app/web_server/test_browser.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

class ConsoleCommandTest : public CommandTest {
 protected:
  // A short flight with truth.
  std::string Recording() const {
    return Simulate("landing", "--scenario calm --seed 2 --set frames=10 --set rate_hz=10");
  }
  static void ExpectPage(int port) {
    TestBrowser browser(port);
    auto request = browser.Get("/");
    request.set(boost::beast::http::field::accept_encoding, "gzip");
    EXPECT_EQ(browser.Send(request).result_int(), 200u);
  }
};

TEST_F(ConsoleCommandTest, ShowsFlight) {
  RunningCommand fly(
      "fly sim:standing --autopilot sim:px4 --console 127.0.0.1:0 --set fly.sim_camera.scale=0.4",
      folder_);
  const int port = fly.Port();
  ExpectPage(port);
  TestSocket socket(port);
  socket.Send(R"({"images": true})");
  const nlohmann::json hello = socket.Await("hello");
  EXPECT_EQ(hello["title"], "sim:standing");
  EXPECT_EQ(hello["live"], true);
  const nlohmann::json image = socket.Await("image");
  EXPECT_GT(image["width"], 100);
  EXPECT_LT(image["age_ms"], 5000);
  const nlohmann::json sample = socket.Await("sample");
  EXPECT_EQ(sample["values"].size(), hello["series"].size());
  socket.Await("map");
  const nlohmann::json health = socket.Await("health");
  EXPECT_THAT(health.dump(), HasSubstr("autopilot"));
  EXPECT_EQ(fly.End(), 0) << fly.Log();
}

TEST_F(ConsoleCommandTest, ShowsCameraWithoutCalibrationAndAutopilot) {
  for (const char* camera : {"'videotestsrc is-live=true ! video/x-raw,width=320,height=240'",
                             "sim:standing --set fly.sim_camera.scale=0.4"}) {
    RunningCommand console(fmt::format("console {} --address 127.0.0.1:0", camera), folder_);
    TestSocket socket(console.Port());
    socket.Send(R"({"images": true})");
    EXPECT_EQ(socket.Await("hello")["offers"].back(), "lens");
    EXPECT_GT(socket.Await("image")["width"], 100) << camera;
    EXPECT_GT(socket.Await("sample")["values"][2], 0);
    EXPECT_EQ(console.End(), 0) << console.Log();
  }
}

TEST_F(ConsoleCommandTest, SavesFlightSettings) {
  const std::string config = folder_.Write(
      "kestrel.yaml", "# ours\nfly:\n  sim_camera:\n    scale: 0.4\nlanding:\n  still: false\n");
  const auto answer = [](TestSocket* socket, const std::string& setting) {
    socket->Await("settings");
    socket->Send(R"({"command": "settings", "settings": [")" + setting + "\"]}");
    return socket->Await("settings");
  };
  {
    RunningCommand fly("fly " + Recording() + " --loop --console 127.0.0.1:0 --config " + config,
                       folder_);
    TestSocket socket(fly.Port());
    EXPECT_EQ(answer(&socket, "landing.target.size_m=0.6")["saved"],
              "saved to " + config + "; restart kestrel fly");
  }
  EXPECT_EQ(ReadFile(config),
            "# ours\nfly:\n  sim_camera:\n    scale: 0.4\nlanding:\n  target:\n    size_m: 0.6\n"
            "  still: false\n");
  RunningCommand fly(
      "fly sim:standing --autopilot sim:px4 --console 127.0.0.1:0 --config " + config, folder_);
  TestSocket socket(fly.Port());
  nlohmann::json vehicle = socket.Await("vehicle");
  while (vehicle.dump().find("disarmed") != std::string::npos) vehicle = socket.Await("vehicle");
  socket.Send(R"({"command": "settings", "settings": ["landing.target.size_m=0.7"]})");
  nlohmann::json settings = socket.Await("settings");
  while (settings["error"] == "") settings = socket.Await("settings");
  EXPECT_THAT(settings["error"].get<std::string>(), HasSubstr("the UAV is armed"));
}

TEST_F(ConsoleCommandTest, ShowsAndRecordsFlightWithoutCalibration) {
  const std::string kept = folder_ / "kept";
  RunningCommand fly(
      "fly 'videotestsrc is-live=true ! video/x-raw,width=320,height=240' --console 127.0.0.1:0"
      " --set fly.keep_folder=" +
          kept,
      folder_);
  TestSocket socket(fly.Port());
  socket.Send(R"({"images": true})");
  EXPECT_EQ(socket.Await("hello")["offers"].back(), "lens");
  EXPECT_TRUE(socket.Await("image")["shapes"].empty());
  socket.Send(R"({"command": "record", "value": 1})");
  nlohmann::json status = socket.Await("status");
  while (!status["recording"]) status = socket.Await("status");
  socket.Await("sample");
  EXPECT_EQ(fly.End(), 0) << fly.Log();
  EXPECT_THAT(fly.Log(), HasSubstr("no lens calibration"));
  EXPECT_FALSE(std::filesystem::is_empty(kept));
}

TEST_F(ConsoleCommandTest, ReportsMissingCameraAndReopensIt) {
  RunningCommand console("console /dev/video63 --address 127.0.0.1:0", folder_);
  TestSocket socket(console.Port());
  nlohmann::json status = socket.Await("status");
  while (status["state"] != "no picture") status = socket.Await("status");
  EXPECT_THAT(status["reason"].get<std::string>(), HasSubstr("/dev/video63, "));
  EXPECT_EQ(console.End(), 0);
  EXPECT_THAT(console.Log(), HasSubstr("kestrel: trying again: there is no /dev/video63, "));
}

TEST_F(ConsoleCommandTest, RecordsFlightOnRequestOfPage) {
  const std::string kept = folder_ / "kept";
  RunningCommand fly(
      "fly sim:standing --autopilot sim:px4 --console 127.0.0.1:0"
      " --set fly.sim_camera.scale=0.4"
      " --set fly.keep_folder=" +
          kept,
      folder_);
  const int port = fly.Port();
  TestSocket socket(port);
  const auto is_recording = [&](bool wanted) {
    while (const auto status = socket.Next("status")) {
      if ((*status)["recording"] == wanted) return true;
    }
    return false;
  };
  // Waits for an image: the snapshot needs one.
  socket.Send(R"({"images": true})");
  socket.Await("image");
  socket.Send(R"({"command": "snapshot"})");
  socket.Send(R"({"command": "record", "value": 1})");
  ASSERT_TRUE(is_recording(true));
  // Images may come seldom: a recording that ends before the next one has none.
  const auto has_image = [](const nlohmann::json& check) {
    const std::string measured = check["measured"];
    return check["name"] == "recording" && !measured.starts_with("0 images");
  };
  nlohmann::json checks;
  while (std::none_of(checks.begin(), checks.end(), has_image)) {
    checks = socket.Await("health")["checks"];
  }
  socket.Send(R"({"command": "record", "value": 0})");
  ASSERT_TRUE(is_recording(false));
  EXPECT_EQ(fly.End(), 0) << fly.Log();
  int recordings = 0, snapshots = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kept)) {
    recordings += std::filesystem::exists(entry.path() / "mav0/cam0/data.csv");
    snapshots += entry.path().extension() == ".png";
  }
  EXPECT_EQ(recordings, 1);
  EXPECT_EQ(snapshots, 1);
}

TEST_F(ConsoleCommandTest, ReplaysRecording) {
  RunningCommand console("console " + Recording() + " --address 127.0.0.1:0", folder_);
  const int port = console.Port();
  ExpectPage(port);
  TestSocket socket(port);
  const nlohmann::json timeline = socket.Await("timeline");
  EXPECT_EQ(timeline["marks"], std::string(10, 'f'));
  socket.Send(R"({"command": "step", "value": 3})");
  while (socket.Await("playback")["frame"] != 3) continue;
  socket.Send(R"({"images": true})");
  const nlohmann::json image = socket.Await("image");
  EXPECT_EQ(image["age_ms"], nullptr);
  EXPECT_EQ(image["shapes"][0]["layer"], "prediction");
  TestBrowser browser(port);
  EXPECT_THAT(browser.Send(browser.Get("/export/detections-1.csv")).body(),
              ::testing::StartsWith("frame,timestamp_ns,detected,"));
  EXPECT_THAT(browser.Send(browser.Get("/export/overlays-3.png")).body(), HasSubstr("PNG"));
  // No detection is as sure as this: the second run finds none.
  socket.Send(R"({"command": "detect", "settings": ["landing.detector.min_quality=1"]})");
  nlohmann::json second = socket.Await("second");
  while (second["state"] == "running") second = socket.Await("second");
  EXPECT_EQ(second["state"], "done") << second;
  EXPECT_EQ(second["marks"], std::string(10, 'l'));
  EXPECT_EQ(console.End(), 0) << console.Log();
}

TEST_F(ConsoleCommandTest, TeachesAndSavesColours) {
  const std::string hunt =
      Simulate("hunt", "--seed 4 --set frames=2 --set shutter.rays_per_pixel=1");
  const std::string taught = folder_ / "taught";
  RunningCommand console("console " + hunt + " --address 127.0.0.1:0 --output " + taught, folder_);
  const int port = console.Port();
  TestSocket socket(port);
  const nlohmann::json hello = socket.Await("hello");
  EXPECT_EQ(hello["colors"], true);
  const auto send = [&](const std::string& message) {
    socket.Send(message);
    return socket.Next("colors").value_or(nlohmann::json());
  };
  const nlohmann::json state = socket.Await("colors");
  EXPECT_EQ(state["frames"], 2);
  // Teaches the colour of the ground as green: the model does not matter here.
  send(R"({"colors": "mark", "frame": 1, "color": "green", "tool": "rectangle", "size": 0,)"
       R"( "points": [600, 300, 700, 400]})");
  EXPECT_EQ(send(R"({"colors": "teach", "color": "green"})")["answer"], "taught green");
  EXPECT_EQ(send(R"({"colors": "save"})")["refused"], false);
  EXPECT_EQ(console.End(), 0) << console.Log();
  EXPECT_TRUE(std::filesystem::exists(taught + "/draft.yaml"));
  Succeed("hunt " + hunt + " --model " + taught + "/objects.yaml");
}

TEST_F(ConsoleCommandTest, TeachesColoursDuringAndAfterFlight) {
  const std::string hunt =
      Simulate("hunt", "--seed 4 --set frames=2 --set shutter.rays_per_pixel=1");
  const std::string kept = folder_ / "kept";
  RunningCommand fly(
      "fly " + hunt + " --hunt --loop --console 127.0.0.1:0" + " --set fly.keep_folder=" + kept,
      folder_);
  const int port = fly.Port();
  const auto send = [](TestSocket* socket, const std::string& message) {
    socket->Send(message);
    return socket->Next("colors").value_or(nlohmann::json());
  };
  {
    TestSocket socket(port);
    socket.Await("colors");
    socket.Send(R"({"images": true})");
    socket.Await("image");
    EXPECT_EQ(send(&socket, R"({"colors": "keep"})")["frames"], 1);
    const auto state =
        send(&socket, R"({"colors": "mark", "frame": 0, "color": "green", "tool": "rectangle",)"
                      R"( "size": 0, "points": [600, 300, 700, 400]})");
    EXPECT_EQ(state["strokes"], 1) << state["answer"];
  }
  EXPECT_EQ(fly.End(), 0) << fly.Log();
  std::string frames;
  for (const auto& entry : std::filesystem::directory_iterator(kept)) {
    if (entry.path().filename().string().starts_with("colors_")) frames = entry.path().string();
  }
  ASSERT_NE(frames, "");
  RunningCommand console("console " + frames + "/ --camera " + hunt +
                             "/mav0/cam0/sensor.yaml --address 127.0.0.1:0 --output " + kept +
                             "/taught",
                         folder_);
  TestSocket socket(console.Port());
  const nlohmann::json state = socket.Await("colors");
  EXPECT_EQ(state["frames"], 1);
  EXPECT_EQ(state["strokes"], 1) << "goes on with the marks of the flight";
  socket.Await("timeline");  // before it, Ctrl-C would end the detection, not the page
  EXPECT_EQ(console.End(), 0) << console.Log();
}

TEST_F(ConsoleCommandTest, PageCalibratesLikeCommandAndReplacesNothing) {
  const std::string flight =
      Simulate("landing", "--scenario aggressive --seed 11 --set frames=60 --set rate_hz=15");
  const std::string saved = folder_ / "saved";
  RunningCommand console("console " + flight + " --address 127.0.0.1:0 --output " + saved, folder_);
  const int port = console.Port();
  TestSocket socket(port);
  const auto next = [&socket](const std::string& state) {
    while (const auto message = socket.Next("calibration")) {
      if ((*message)["state"] != "running") {
        EXPECT_EQ((*message)["state"], state) << *message;
        return *message;
      }
    }
    return nlohmann::json();
  };
  ASSERT_TRUE(next("none").is_object());
  socket.Send(R"({"command": "calibrate", "settings": ["mount", "clock", "moving"]})");
  const nlohmann::json done = next("done");
  EXPECT_EQ(done["numbers"].size(), 4u);
  EXPECT_LT(done["residuals"]["rms_after"], done["residuals"]["rms_before"]);
  socket.Send(R"({"command": "calibrate-save"})");
  EXPECT_EQ(next("done")["saved"], saved + "/mount_clock.yaml");
  socket.Send(R"({"command": "calibrate-save"})");
  EXPECT_EQ(next("done")["saved"], saved + "/mount_clock_2.yaml");
  const std::string by_command = folder_ / "command.yaml";
  Succeed("calibrate clock --both --moving " + flight + " --output " + by_command);
  EXPECT_EQ(ReadFile(saved + "/mount_clock.yaml"), ReadFile(by_command));
  EXPECT_EQ(ReadFile(saved + "/mount_clock_2.yaml"), ReadFile(by_command));
  TestBrowser browser(port);
  EXPECT_EQ(browser.Send(browser.Get("/export/calibration-1.yaml")).body(), ReadFile(by_command));
}

TEST_F(ConsoleCommandTest, PlaysBagAndRefusesItWithErrorOfCommand) {
  const std::string bag = folder_ / "flight.mcap";
  Succeed("convert " + Recording() + " " + bag);
  RunningCommand console("console " + bag + " --topic /camera/image_raw --address 127.0.0.1:0",
                         folder_);
  const int port = console.Port();
  TestSocket socket(port);
  const nlohmann::json timeline = socket.Await("timeline");
  EXPECT_EQ(timeline["times_ms"].size(), 10u);
  TestBrowser browser(port);
  const auto frame = [&browser](int number) {
    return browser.Send(browser.Get(fmt::format("/export/frame-{}.png", number))).body();
  };
  const std::string last = frame(9);
  EXPECT_THAT(last, HasSubstr("PNG"));
  EXPECT_NE(frame(2), last) << "a bag is wound back";
  const std::string too_few = "images with poses around them, expected at least 20";
  socket.Send(R"({"command": "calibrate", "settings": ["mount"]})");
  nlohmann::json refused = socket.Await("calibration");
  while (refused["state"] != "refused") refused = socket.Await("calibration");
  EXPECT_THAT(refused["error"].dump(), HasSubstr(too_few));
  EXPECT_THAT(refused["coverage"].dump(), HasSubstr("of 10 images"));
  ExpectInputError("calibrate mount " + bag, too_few);
  ExpectInputError("console " + bag + " --topic /up", "flight.mcap: has no topic /up");
}

TEST_F(ConsoleCommandTest, ShowsResultOverItsRecording) {
  const std::string flight = Recording();
  const std::string result = folder_ / "result";
  Succeed("land " + flight + " --output " + result);
  // A run with these options would find nothing: the page shows the result.
  RunningCommand console("console " + flight + " " + result +
                             " --address 127.0.0.1:0 --set landing.detector.min_quality=1",
                         folder_);
  const int port = console.Port();
  TestSocket socket(port);
  const nlohmann::json timeline = socket.Await("timeline");
  EXPECT_EQ(timeline["marks"], std::string(10, 'f'));
  TestBrowser browser(port);
  const std::string table = ReadFile(result + "/landing_detections.csv");
  EXPECT_EQ(browser.Send(browser.Get("/export/detections-1.csv")).body(), table);
  EXPECT_EQ(console.End(), 0) << console.Log();
  const std::string row = table.substr(0, table.find('\n', table.find('\n') + 1) + 1);
  const auto one_row =
      Run("console --address 127.0.0.1:0 " + flight + " " + folder_.Write("one.csv", row));
  EXPECT_EQ(one_row.status, 1);
  EXPECT_THAT(one_row.err, HasSubstr("row 2 is not of the recording's frame at"));
  ExpectInputError("console " + result, "is a result: name its recording, too");
  ExpectInputError("console " + flight + " " + result + " " + result, "is a second result");
}

TEST_F(ConsoleCommandTest, ReportsFaults) {
  const std::string fly = "fly sim:standing --autopilot sim:px4 --console ";
  ExpectInputError(fly + "8080", "--console '8080': expected ADDRESS:PORT");
  ExpectInputError(fly + "192.0.2.1:8080 --set console.token=0123456789abcdef",
                   "cannot listen at 192.0.2.1 port 8080");
  ExpectInputError(fly + "--set console.token=short", "console.token is not 16 to 128");
  const std::string flight = Recording();
  ExpectInputError("console " + flight + " --address nowhere:1", "--address 'nowhere:1'");
  ExpectInputError("console " + flight + " --model any.yaml", "has no images in color");
  ExpectInputError("console --hunt /dev/video0", "`kestrel fly --console` shows a camera");
  ExpectInputError("console " + folder_ / "missing", "no such file or folder");
  RunningCommand first("console " + flight + " --address 127.0.0.1:0", folder_);
  ExpectInputError(fmt::format("{}127.0.0.1:{}", fly, first.Port()), "expected a free port");
}

}  // namespace
}  // namespace kestrel
