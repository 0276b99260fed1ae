// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/flight/flight_console.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/app/web_server/test_browser.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/base/test_folder.h"
#include "kestrel/core/camera/paper_camera.h"
#include "kestrel/io/recording/media/image_file.h"

namespace kestrel {
namespace {

using namespace std::chrono_literals;

int PortOf(const FlightConsole& console) {
  const std::string url = console.urls().front();
  return std::stoi(url.substr(url.rfind(':') + 1));
}

ConsoleOptions FreePort() {
  ConsoleOptions options;
  options.port = 0;
  return options;
}

CameraCalibration PaperCalibration() {
  CameraCalibration calibration;
  calibration.intrinsics = PaperCamera();
  return calibration;
}

Frame GrayFrame() { return {"", Now(), cv::Mat(240, 376, CV_8UC1, cv::Scalar(99))}; }

Observation ObservationOf(const Frame& frame, const LandingObservation& seen) {
  return {frame, seen, Now() - frame.time};
}

class FlightConsoleTest : public testing::Test {
 protected:
  FlightConsole console_{FreePort(),
                         "a flight",
                         {LandingView{CameraModel(PaperCamera()), {}, TurnNoise()}},
                         FlightExamination(PaperCalibration(), ".", 0)};
};

TEST_F(FlightConsoleTest, ShowsVisionResults) {
  TestSocket socket(PortOf(console_));
  const auto hello = socket.Next("hello");
  ASSERT_TRUE(hello);
  EXPECT_EQ((*hello)["title"], "a flight");
  EXPECT_EQ((*hello)["offers"], (nlohmann::json{"record", "snapshot", "settings"}));
  EXPECT_EQ((*hello)["colors"], false);
  EXPECT_EQ((*hello)["views"].size(), 4u);
  LandingObservation observation;
  observation.report.reason = "no ring";
  observation.detect_time = 3ms;
  console_.Take(ObservationOf(GrayFrame(), observation));
  const auto sample = socket.Next("sample");
  ASSERT_TRUE(sample);
  EXPECT_EQ((*sample)["values"].size(), (*hello)["series"].size());
  EXPECT_EQ((*sample)["values"][4], 3.0);
  socket.Send(R"({"images": true})");
  const auto image = socket.Next("image");
  ASSERT_TRUE(image);
  EXPECT_EQ((*image)["width"], 376);
  socket.Send(fmt::format(R"({{"ack": {}}})", (*image)["sequence"].get<int>()));
  // The image is of the same frame, as there is no newer one.
  socket.Send(R"({"images": "threshold 1/2"})");
  const auto threshold = socket.Next("image");
  ASSERT_TRUE(threshold);
  EXPECT_EQ((*threshold)["view"], "threshold 1/2");
  EXPECT_EQ((*threshold)["sequence"], (*image)["sequence"]);
  FlightReport report;
  report.autopilot.emplace();
  console_.Take(report);
  const auto sources = socket.Next("sources");
  ASSERT_TRUE(sources);
  EXPECT_GE((*sources)["sources"][0]["age_ms"], 0);
  EXPECT_EQ((*sources)["sources"][1]["name"], "autopilot");
  EXPECT_TRUE((*sources)["sources"][1]["age_ms"].is_null());
  const auto status = socket.Next("status");
  ASSERT_TRUE(status);
  EXPECT_THAT((*status)["reason"].get<std::string>(),
              testing::HasSubstr("no heartbeat of the autopilot"));
}

// A page that is opened later shows it as well.
TEST(FlightConsoleOfAHunt, ShowsMapOfTeam) {
  FlightConsole console(FreePort(), "a hunt", {HuntView{DefaultObjectModel()}},
                        FlightExamination(PaperCalibration(), ".", 0));
  TeamObject known;
  known.object.state.head<2>() << 3, -4;
  known.object.covariance(0, 1) = 0.25;
  known.object.color_log_likelihoods[0] = 5;
  known.uavs = {"one", "two"};
  known.holder = "two";
  console.Take(TeamReport{Now(), {known}});
  TestSocket socket(PortOf(console));
  const auto team = socket.Next("team");
  ASSERT_TRUE(team);
  ASSERT_EQ((*team)["objects"].size(), 1u);
  const nlohmann::json object = (*team)["objects"][0];
  EXPECT_EQ(object["label"], "red");
  EXPECT_EQ(object["position"], (nlohmann::json{3.0, -4.0}));
  EXPECT_EQ(object["covariance"], (nlohmann::json{0.0, 0.25, 0.0}));
  EXPECT_EQ(object["uavs"], (nlohmann::json{"one", "two"}));
  EXPECT_EQ(object["holder"], "two");
}

TEST_F(FlightConsoleTest, ShowsChecksOfDoctor) {
  TestSocket socket(PortOf(console_));
  ASSERT_TRUE(socket.Next("hello"));
  const auto doctor = socket.Next("doctor");
  ASSERT_TRUE(doctor);
  EXPECT_EQ((*doctor)["checks"][0]["name"], "image size");
  EXPECT_EQ((*doctor)["checks"][0]["verdict"], "not checked");
}

TEST_F(FlightConsoleTest, ExecutesRequestsOfPage) {
  TestSocket socket(PortOf(console_));
  ASSERT_TRUE(socket.Next("hello"));
  // Requests wait until somebody answers them.
  socket.Send(R"({"command": "record", "value": 1})");
  console_.Answer({.record = [](bool is_on) -> std::string {
                     if (!is_on) throw InputError("the disk is full");
                     return "recording";
                   },
                   .keep_snapshot =
                       [](const cv::Mat& image, Time captured) {
                         return fmt::format("kept {} px of {}", image.cols,
                                            ToNanoseconds(captured));
                       },
                   .settings =
                       [](const std::vector<std::string>& settings) {
                         ConsoleSettings state{.file = "kestrel.yaml", .settings = {}};
                         if (!settings.empty()) state.saved = settings.front();
                         return state;
                       }});
  const auto settings = socket.Next("settings");
  ASSERT_TRUE(settings);
  EXPECT_EQ((*settings)["file"], "kestrel.yaml");
  EXPECT_EQ((*settings)["saved"], "");
  const auto begun = socket.Next("event");
  ASSERT_TRUE(begun);
  EXPECT_EQ((*begun)["text"], "recording");
  socket.Send(R"({"command": "record", "value": 0})");
  const auto ended = socket.Next("event");
  ASSERT_TRUE(ended);
  EXPECT_EQ((*ended)["text"], "the disk is full");
  EXPECT_EQ((*ended)["level"], "error");
  socket.Send(R"({"command": "snapshot"})");
  const auto none = socket.Next("event");
  ASSERT_TRUE(none);
  EXPECT_THAT((*none)["text"].get<std::string>(), testing::HasSubstr("no image yet"));
  const Frame frame = GrayFrame();
  console_.Take(ObservationOf(frame, LandingObservation()));
  socket.Send(R"({"images": true})");
  ASSERT_TRUE(socket.Next("image"));
  socket.Send(R"({"command": "snapshot"})");
  const auto kept = socket.Next("event");
  ASSERT_TRUE(kept);
  EXPECT_EQ((*kept)["text"], fmt::format("kept 376 px of {}", ToNanoseconds(frame.time)));
  socket.Send(R"({"command": "settings", "settings": ["landing.target.id=3"]})");
  const auto saved = socket.Next("settings");
  ASSERT_TRUE(saved);
  EXPECT_EQ((*saved)["saved"], "landing.target.id=3");
}

TEST_F(FlightConsoleTest, KeepsNoImageWithoutViewer) {
  const Frame frame = GrayFrame();
  console_.Take(ObservationOf(frame, LandingObservation()));
  EXPECT_EQ(frame.image.u->refcount, 1);
}

TEST(PointedConsoleTest, GimbalIsPointedAgainOnRequest) {
  FlightConsole console(FreePort(), "a flight",
                        {LandingView{CameraModel(PaperCamera()), {}, TurnNoise()}},
                        FlightExamination(PaperCalibration(), ".", 0), nullptr, std::nullopt,
                        {ConsoleCommandKind::kPoint});
  TestSocket socket(PortOf(console));
  const auto hello = socket.Next("hello");
  ASSERT_TRUE(hello);
  EXPECT_THAT((*hello)["offers"], testing::Contains("point"));
  console.Answer({.record = {},
                  .keep_snapshot = {},
                  .point = [] { return "requests the gimbal again"; },
                  .settings = [](const auto&) { return ConsoleSettings(); }});
  socket.Send(R"({"command": "point"})");
  const auto event = socket.Next("event");
  ASSERT_TRUE(event);
  EXPECT_EQ((*event)["text"], "requests the gimbal again");
}

TEST(FollowConsoleTest, MarkNamesThePictureAndTheBox) {
  FlightConsole console(FreePort(), "a flight", {FollowView()},
                        FlightExamination(PaperCalibration(), ".", 0));
  TestSocket socket(PortOf(console));
  const auto hello = socket.Next("hello");
  ASSERT_TRUE(hello);
  EXPECT_THAT((*hello)["offers"], testing::Contains("mark"));
  EXPECT_THAT((*hello)["offers"], testing::Not(testing::Contains("confirm")));
  console.Answer({.record = {},
                  .keep_snapshot = {},
                  .mark =
                      [](Time captured, const cv::Rect2d& box) {
                        return fmt::format("{} {:g} {:g} {:g} {:g}", ToNanoseconds(captured), box.x,
                                           box.y, box.width, box.height);
                      },
                  .settings = [](const auto&) { return ConsoleSettings(); }});
  const auto answer = [&](const std::string& mark) -> std::string {
    socket.Send(R"({"command": "mark", "settings": [)" + mark + "]}");
    const auto event = socket.Next("event");
    return event ? (*event)["text"] : "none";
  };
  EXPECT_EQ(answer(R"("1700000000000000001", "1.5", "2", "30", "40")"),
            "1700000000000000001 1.5 2 30 40");
  EXPECT_EQ(answer(R"("7", "1.5", "nan", "30", "40")"), "mark: expected numbers");
  EXPECT_EQ(answer(R"("7", "1.5")"), "mark: expected the time of a picture and a box");
}

TEST(FollowConsoleTest, PersonConfirmsAndStopsTheFlight) {
  FlightConsole console(FreePort(), "a flight", {FollowView()},
                        FlightExamination(PaperCalibration(), ".", 0), nullptr, std::nullopt,
                        {ConsoleCommandKind::kConfirm, ConsoleCommandKind::kStop});
  TestSocket socket(PortOf(console));
  const auto hello = socket.Next("hello");
  ASSERT_TRUE(hello);
  EXPECT_THAT((*hello)["offers"], testing::IsSupersetOf({"mark", "confirm", "stop"}));
  console.Answer({.record = {},
                  .keep_snapshot = {},
                  .confirm = []() -> std::string { throw InputError("nothing is marked yet"); },
                  .stop = [] { return std::string("stopped"); },
                  .settings = [](const auto&) { return ConsoleSettings(); }});
  const auto answer = [&](const std::string& command) -> std::string {
    socket.Send(R"({"command": ")" + command + "\"}");
    const auto event = socket.Next("event");
    return event ? (*event)["text"] : "none";
  };
  EXPECT_EQ(answer("confirm"), "nothing is marked yet");
  EXPECT_EQ(answer("stop"), "stopped");
}

// A green square on gray ground.
Frame ColorFrame() {
  cv::Mat image(240, 376, CV_8UC3, cv::Scalar(90, 100, 95));
  image(cv::Rect(100, 100, 60, 60)).setTo(cv::Scalar(40, 160, 40));
  return {"", Now(), image};
}

TEST(HuntConsoleTest, KeepsFramesAndTeachesColours) {
  namespace fs = std::filesystem;
  const TestFolder test_folder;
  const fs::path folder = test_folder.path();
  {
    FlightConsole console(FreePort(), "a hunt", {HuntView{DefaultObjectModel()}},
                          FlightExamination(PaperCalibration(), ".", 0), nullptr,
                          FlightColors{folder / "colors", (folder / "taught").string(), {}});
    TestSocket socket(PortOf(console));
    const auto hello = socket.Next("hello");
    ASSERT_TRUE(hello);
    EXPECT_EQ((*hello)["colors"], true);
    EXPECT_EQ((*hello)["exports"], false);
    EXPECT_EQ((*hello)["views"], nlohmann::json{"segmentation"});
    const auto request = [&](const std::string& message) {
      socket.Send(message);
      return socket.Next("colors").value_or(nlohmann::json());
    };
    ASSERT_TRUE(socket.Next("colors"));
    EXPECT_THAT(request(R"({"colors": "keep"})")["answer"].get<std::string>(),
                testing::HasSubstr("there is no image yet"));
    const Frame frame = ColorFrame();
    console.Take(Observation{frame, HuntObservation()});
    socket.Send(R"({"images": "segmentation"})");
    const auto image = socket.Next("image");
    ASSERT_TRUE(image);
    EXPECT_EQ((*image)["view"], "segmentation");
    EXPECT_EQ(request(R"({"colors": "keep"})")["frames"], 1);
    const auto state = request(
        R"({"colors": "mark", "frame": 0, "color": "green", "tool": "grow", "size": 8, "points": [120, 120]})");
    EXPECT_EQ(state["strokes"], 1) << state["answer"];
    EXPECT_EQ(request(R"({"colors": "teach", "color": "green"})")["answer"], "taught green");
    TestBrowser browser(PortOf(console));
    EXPECT_EQ(browser.Send(browser.Get("/export/labels-0.bin")).result_int(), 200u);
    TestBrowser other(PortOf(console));
    EXPECT_EQ(other.Send(other.Get("/export/frame-0.png")).result_int(), 404u)
        << "a flight has no other exports";
    EXPECT_FALSE(request(R"({"colors": "save"})")["refused"]);
    const std::string file =
        (folder / "colors" / fmt::format("01_{}.png", ToNanoseconds(frame.time))).string();
    EXPECT_EQ(cv::norm(ReadImage(file, PixelFormat::kBgr), frame.image, cv::NORM_INF), 0);
  }
  EXPECT_TRUE(fs::exists(folder / "taught" / "draft.yaml"));
  EXPECT_TRUE(fs::exists(folder / "taught" / "objects.yaml"));
}

TEST(FlightHealthTest, ReportsWaitingOnlyAfterStartUp) {
  FlightHealth health;
  FlightReport state;
  state.autopilot.emplace();
  const Time start = Now();
  health.Update(state, start);
  const auto early = health.Update(state, start + 1s);
  ASSERT_TRUE(early);
  EXPECT_EQ(early->checks.at(0).measured, "not checked yet");
  for (const ConsoleCheck& check : early->checks) EXPECT_NE(check.verdict, "wrong") << check.name;
  state.trouble = "waits for the camera: no image yet";
  state.autopilot->waits = "waits for the autopilot: nothing received on /dev/ttyAMA0";
  const auto later = health.Update(state, start + 2s);
  ASSERT_TRUE(later);
  EXPECT_EQ(later->checks.at(0).measured, state.trouble);
  const auto autopilot = std::ranges::find(later->checks, "autopilot", &ConsoleCheck::name);
  ASSERT_NE(autopilot, later->checks.end());
  EXPECT_EQ(autopilot->verdict, "wrong");
  EXPECT_EQ(autopilot->measured, state.autopilot->waits);
}

TEST(FlightHealthTest, ComparesSeconds) {
  FlightHealth health;
  FlightReport state;
  state.autopilot.emplace().is_here = true;
  state.autopilot->mode = "LOITER";
  const Time start = Now();
  EXPECT_FALSE(health.Update(state, start));
  state.capture.captured = 30;
  state.autopilot->link.received = 100;
  EXPECT_FALSE(health.Update(state, start + 500ms));
  const auto good = health.Update(state, start + 1s);
  ASSERT_TRUE(good);
  EXPECT_EQ(health.link_rate_hz(), 100);
  for (const ConsoleCheck& check : good->checks) EXPECT_EQ(check.verdict, "good") << check.name;
  state.autopilot->is_here = false;
  state.events.dropped_frames = 1;
  const auto bad = health.Update(state, start + 2s);
  ASSERT_TRUE(bad);
  const auto verdict = [&](const std::string& name) {
    for (const ConsoleCheck& check : bad->checks) {
      if (check.name == name) return check.verdict;
    }
    return std::string();
  };
  EXPECT_EQ(verdict("camera"), "wrong") << "no frame in a second";
  EXPECT_EQ(verdict("vision"), "doubtful");
  EXPECT_EQ(verdict("autopilot"), "wrong");
}

TEST(SourceWatchTest, ReportsAgeOfLastDataOfEachSource) {
  const Time start = Now();
  SourceWatch watch;
  FlightReport report;
  ASSERT_EQ(watch.Update(report, start).ages.size(), 1u) << "no autopilot, no poses";
  EXPECT_FALSE(watch.Update(report, start).ages[0].age) << "no frame yet";
  report.autopilot.emplace().is_here = true;
  report.autopilot->link.received = 7;
  watch.Look(start - 40ms, /*has_pose=*/true);
  watch.Look(start, /*has_pose=*/false);
  const ConsoleSources sources = watch.Update(report, start + 10ms);
  ASSERT_EQ(sources.ages.size(), 3u);
  EXPECT_EQ(sources.ages[0].age, Duration(10ms));
  EXPECT_EQ(sources.ages[1].source, ValueSource::kAutopilot);
  EXPECT_EQ(sources.ages[1].age, Duration(0));
  EXPECT_EQ(sources.ages[2].age, Duration(50ms));
  EXPECT_EQ(watch.Update(report, start + 2s).ages[1].age, Duration(1990ms)) << "no more packets";
  report.autopilot->is_here = false;
  report.autopilot->link.received = 8;
  EXPECT_EQ(watch.Update(report, start + 3s).ages[1].age, Duration(2990ms)) << "those of others";
}

TEST(FlightStatusTest, ShowsMostImportantState) {
  const ViewStatus vision{"tracking", "", false};
  FlightReport state;
  EXPECT_EQ(FlightStatus(state, vision), vision);
  state.autopilot.emplace().is_here = true;
  state.autopilot->is_landing = true;
  EXPECT_EQ(FlightStatus(state, vision).state, "landing, tracking");
  state.autopilot->guidance = GuidancePhase::kDescend;
  EXPECT_EQ(FlightStatus(state, vision).state, "descend, tracking");
  state.autopilot->target = TargetPhase::kContact;
  EXPECT_EQ(FlightStatus(state, vision).state, "on the pattern");
  state.trouble = "the camera is gone";
  state.recorder.emplace();
  EXPECT_EQ(FlightStatus(state, vision), (ViewStatus{"blind", "the camera is gone", true}));
}

TEST(FlightStatusTest, KeepsEndOfFlight) {
  FlightReport report;
  report.trouble = "the camera is gone";
  report.recording = "flight";
  report.end = FlightEnd{FlightOutcome::kOnPattern, 0.05};
  const ViewStatus status = FlightStatus(report, {.state = "tracking", .reason = ""});
  EXPECT_TRUE(status.is_over);
  EXPECT_EQ(status.reason, "landed 0.05 m from the centre (estimated)");
  EXPECT_EQ(status.replay, "flight");
}

TEST(VehicleTest, ShowsReportsOfAutopilot) {
  FlightReport report;
  EXPECT_FALSE(VehicleOf(report));
  AutopilotState& autopilot = report.autopilot.emplace();
  EXPECT_EQ(VehicleOf(report)->facts[0], (ConsoleCheck{"mode", "wrong", "no heartbeat"}));
  EXPECT_EQ(VehicleOf(report)->facts.size(), 2u) << "what is not reported is not shown";
  autopilot.is_here = autopilot.is_armed = true;
  autopilot.mode = "GUIDED";
  autopilot.battery_v = 14.9;
  autopilot.battery_remaining = 0.2;
  autopilot.gnss_fix = 1;
  autopilot.satellites = 4;
  autopilot.has_good_position = false;
  autopilot.limits = LimitsInUse{0.5, 0.25, 1, "needs 54 deg of lean, the limit is 35"};
  const ConsoleVehicle vehicle = *VehicleOf(report);
  EXPECT_THAT(vehicle.facts,
              testing::ElementsAre(ConsoleCheck{"mode", "good", "GUIDED"},
                                   ConsoleCheck{"motors", "good", "armed"},
                                   ConsoleCheck{"battery", "doubtful", "14.9 V, 20 %"},
                                   ConsoleCheck{"GPS", "wrong", "no fix, 4 satellites"},
                                   ConsoleCheck{"position", "wrong", "not trusted"}));
  ASSERT_EQ(vehicle.limits.size(), 3u);
  EXPECT_EQ(vehicle.limits[2], (ConsoleVehicle::Use{"climb", 1}));
  EXPECT_EQ(vehicle.cannot_follow, "needs 54 deg of lean, the limit is 35");
}

}  // namespace
}  // namespace kestrel
