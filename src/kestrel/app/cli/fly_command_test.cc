// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "kestrel/app/cli/test_command.h"
#include "kestrel/app/foxglove/test_protobuf.h"

namespace kestrel {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

namespace fs = std::filesystem;

class FlyCommandTest : public CommandTest {
 protected:
  // A landing from close by that renders quickly.
  static constexpr const char* kNear =
      " --set fly.sim_autopilot.pilot.start_altitude_m=4"
      " --set fly.sim_autopilot.pilot.offset_east_m=0.5"
      " --set fly.sim_autopilot.pilot.offset_north_m=-0.5 --set fly.sim_camera.scale=0.4";

  // Expects exactly one image and one result for each row of the table.
  static void ExpectSameTimes(const std::string& mcap, const std::string& csv) {
    std::vector<std::string> rows, results, images;
    std::istringstream table(ReadFile(csv));
    std::string row;
    for (std::getline(table, row); std::getline(table, row);) {
      const std::size_t begin = row.find(',') + 1;
      rows.push_back(row.substr(begin, row.find(',', begin) - begin));
    }
    const auto messages = ReadMessages(mcap);
    const auto time_of = [](const StoredMessage& message) {
      EXPECT_EQ(message.time, message.fields.time(1));
      return std::to_string(ToNanoseconds(message.time));
    };
    for (const auto& message : messages.at("/result")) results.push_back(time_of(message));
    for (const auto& message : messages.at("/camera/image")) images.push_back(time_of(message));
    EXPECT_THAT(results, ::testing::ElementsAreArray(rows));
    EXPECT_EQ(images, results);
  }

  // Distance from the pattern's centre at contact (m), as the simulated autopilot says; 99 without.
  static double MissOf(const Outcome& outcome) {
    std::smatch match;
    const std::regex on_board("on the board, ([0-9.]+) m");
    return std::regex_search(outcome.err, match, on_board) ? std::stod(match[1]) : 99;
  }
};

TEST_F(FlyCommandTest, SimulatedArduPilotLandsByTargetMessages) {
  const std::string flight = folder_ / "flight";
  const Outcome outcome =
      Succeed("fly sim:standing --autopilot sim:ardupilot --record " + flight + " --output " +
              folder_ / "out" + " --mcap " + folder_ / "flight.mcap" + kNear);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("pattern found"), HasSubstr("landed")));
  EXPECT_LT(MissOf(outcome), 0.15) << outcome.err;
  EXPECT_TRUE(fs::exists(folder_ / "out/landing_track.csv"));
  EXPECT_THAT(ReadFile(folder_ / "out/flight_end.csv"),
              AllOf(HasSubstr("on pattern,0."), HasSubstr("from the centre (true), 0.")));
  EXPECT_GT(fs::file_size(flight + "/mavlink.tlog"), 10'000u);
  ExpectSameTimes(folder_ / "flight.mcap", folder_ / "out/landing_detections.csv");
  // The flight's record is a recording with truth.
  Succeed("land " + flight + " --output " + folder_ / "again");
  Succeed("evaluate " + flight + " " + folder_ / "again");
}

TEST_F(FlyCommandTest, SimulatedPx4LandsByBothProfiles) {
  for (const std::string arguments :
       {"px4", "px4-vte --set fly.sim_autopilot.parameters=VTE_EN=1"}) {
    const Outcome outcome =
        Succeed("fly sim:standing --autopilot sim:px4 --profile " + arguments + kNear);
    EXPECT_LT(MissOf(outcome), 0.15) << arguments << "\n" << outcome.err;
  }
}

TEST_F(FlyCommandTest, GuidesSimulatedPx4OntoCar) {
  const Outcome outcome =
      Succeed(std::string("fly sim:figure8 --autopilot sim:px4 --guide") + kNear);
  EXPECT_LT(MissOf(outcome), 0.5) << outcome.err;
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("descend: "), HasSubstr("landed: contact")));
}

// The camera is level and looks ahead when it starts.
TEST_F(FlyCommandTest, PointsGimbalAtPadAndLands) {
  const std::string camera = folder_.Write("gimbal.yaml", R"(camera_model: pinhole
resolution: [301, 192]
intrinsics: [104.4, 104.4, 150.1, 95.7]
distortion_model: equidistant
distortion_coefficients: [-0.0448, 0.0686053, -0.072277, 0.027011955]
T_GS: [[0, 0, 1, 0.02], [-1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 0, 1]]
gimbal:
  T_BG: [[1, 0, 0, 0.12], [0, 1, 0, 0], [0, 0, 1, -0.05], [0, 0, 0, 1]]
)");
  for (const std::string autopilot : {"ardupilot", "px4"}) {
    const Outcome outcome = Succeed("fly sim:standing --point --camera " + camera +
                                    " --autopilot sim:" + autopilot + kNear);
    EXPECT_LT(MissOf(outcome), 0.15) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("points the gimbal at the pattern")) << outcome.err;
  }
  ExpectInputError("fly sim:standing --autopilot udpin://127.0.0.1:0 --camera " + camera + kNear,
                   "expected sim:ardupilot or sim:px4");
}

TEST_F(FlyCommandTest, RejectsMalformedVideoAddress) {
  const std::string fly = "fly sim:standing --autopilot sim:px4 --video ";
  for (const char* url : {"http://127.0.0.1:8554/kestrel", "rtsp://127.0.0.1:8554",
                          "rtsp://127.0.0.1:8554/", "kestrel"}) {
    ExpectInputError(fly + url + kNear, "expected rtsp://ADDRESS:PORT/PATH");
  }
  ExpectInputError(fly + "rtsp://127.0.0.1/kestrel" + kNear, "--video '127.0.0.1': expected");
  ExpectInputError(fly + "rtsp://uav:8554/kestrel" + kNear, "expected ADDRESS:PORT");
}

TEST_F(FlyCommandTest, ServesVideoOfLanding) {
  const Outcome outcome = Succeed(
      std::string("fly sim:standing --autopilot sim:ardupilot --video rtsp://127.0.0.1:0/kestrel") +
      kNear);
  EXPECT_THAT(outcome.err, testing::ContainsRegex("video: rtsp://127.0.0.1:[0-9]+/kestrel"));
  EXPECT_LT(MissOf(outcome), 0.15) << outcome.err;
}

// ArduPilot's own landing trails behind what drives in a curve.
TEST_F(FlyCommandTest, LandingBesidePatternIsNoSuccess) {
  const Outcome outcome = Run(std::string("fly sim:figure8 --autopilot sim:ardupilot") + kNear);
  EXPECT_EQ(outcome.status, 4) << outcome.err;
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("drive straight"), HasSubstr("kestrel: ")));
}

// A tag of 5 cm is not seen from there: LAND comes down where it is.
TEST_F(FlyCommandTest, WarnsOfLandingOutOfSightBeforeAndAtItsStart) {
  const Outcome outcome =
      Run(std::string(
              "fly sim:standing --autopilot sim:ardupilot --target apriltag --target-size 0.05") +
          kNear);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("begin the autopilot's landing below that"),
                                 HasSubstr("the autopilot lands, and the pattern is not in view")));
}

TEST_F(FlyCommandTest, PlaysRecordingInRealTime) {
  const std::string flight =
      Simulate("landing", "--scenario calm --seed 2 --set frames=10 --set rate_hz=10");
  const Outcome outcome = Succeed("fly " + flight + " --output " + folder_ / "out");
  EXPECT_THAT(outcome.err, HasSubstr("10 frames, pattern found in 10"));
  EXPECT_EQ(Lines(ReadFile(folder_ / "out/landing_detections.csv")), 11);
}

TEST_F(FlyCommandTest, ReportsWaitingForAutopilot) {
  const std::string flight =
      Simulate("landing", "--scenario calm --seed 2 --set frames=30 --set rate_hz=10");
  const Outcome outcome = Succeed("fly " + flight + " --autopilot tcpout://127.0.0.1:1");
  EXPECT_THAT(outcome.err,
              AllOf(HasSubstr("runs until Ctrl-C, SIGTERM or the landing"),
                    HasSubstr("waits for the autopilot: tcpout://127.0.0.1:1 refused")));
}

TEST_F(FlyCommandTest, RecordsCameraWithoutCalibration) {
  const std::string record = folder_ / "flight";
  const Outcome outcome = Succeed(
      "fly 'videotestsrc num-buffers=20 ! video/x-raw,width=64,height=48,framerate=100/1'"
      " --record " +
      record);
  EXPECT_THAT(outcome.err,
              AllOf(HasSubstr("no lens calibration"), HasSubstr("`kestrel console 'videotestsrc "),
                    HasSubstr("kestrel calibrate lens"), HasSubstr("the source has ended")));
  EXPECT_GT(Lines(ReadFile(record + "/mav0/cam0/data.csv")), 1);
  EXPECT_FALSE(fs::exists(record + "/mav0/cam0/sensor.yaml"));
  // It is a recording for the lens that is calibrated later.
  EXPECT_THAT(Succeed("land " + record).err, HasSubstr("no calibration"));
}

TEST_F(FlyCommandTest, RefusesToSendWithoutCalibration) {
  for (const std::string option :
       {"--autopilot sim:px4", "--autopilot udpout://127.0.0.1:14550 --guide", "--dds 7",
        "--team a --hunt", "--output out", "--mcap a.mcap"}) {
    const Outcome outcome = Run("fly /dev/video63 --record " + folder_ / "flight" + " " + option);
    EXPECT_EQ(outcome.status, 2) << option;
    EXPECT_EQ(Lines(outcome.err), 1) << outcome.err;
    EXPECT_THAT(outcome.err, AllOf(HasSubstr(option.substr(0, option.find(' ')) + ": "),
                                   HasSubstr("--camera FILE")));
    EXPECT_FALSE(fs::exists(folder_ / "flight"));
  }
  ExpectInputError("fly /dev/video63", "/dev/video63");
  ExpectInputError("fly 'udpsrc port=99999 ! filesrc'", "udpsrc");
}

TEST_F(FlyCommandTest, ReadsSourceFromConfiguration) {
  const std::string flight =
      Simulate("landing", "--scenario calm --seed 2 --set frames=10 --set rate_hz=10");
  const std::string config = folder_.Write("kestrel.yaml", "fly:\n  source: " + flight + "\n");
  EXPECT_THAT(Succeed("fly --config " + config).err, HasSubstr("pattern found in 10"));
  const Outcome none = Run("fly");
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.err, HasSubstr("SOURCE, or fly.source in --config FILE, is required"));
}

TEST_F(FlyCommandTest, RefusesFlightToObjectBeforeItBegins) {
  const std::string fly = "fly sim:hunt --autopilot sim:ardupilot --hunt --guide";
  ExpectInputError(fly, "expected --go CLASS");
  ExpectInputError(fly + " --go purple",
                   "no class 'purple', expected red, green, blue, yellow, orange");
  ExpectInputError(fly + " --go red --then dance", "expected hover, look, drop");
  ExpectInputError(fly + " --go red --box 47.3,8.5", "--box: expected --then pick");
  ExpectInputError(fly + " --go red --then pick --box here", "--box 'here': expected LAT,LON");
  ExpectInputError(fly + " --go red --set fly.guidance.search_radius_m=200",
                   "expected at most 100 (limits.geofence_radius_m)");
  ExpectInputError(fly + " --go nan,8.5", "--go 'nan,8.5': expected LAT,LON");
  ExpectInputError(fly + " --go 97.4,8.5", "--go '97.4,8.5': expected LAT,LON");
  ExpectInputError(fly + " --go 47.4,8.5 --then pick", "pick: expected an object");
  ExpectInputError(fly + " --go 47.4,8.5 --then drop,0.5",
                   "the height above a place, where nothing is seen, is 0.5, expected at least");
  ExpectInputError(fly + " --go 47.4,8.5 --team a", "--go LAT,LON: expected no --team");
  const std::string follow =
      "fly sim:follow --autopilot sim:ardupilot --guide --follow --console "
      "127.0.0.1:0";
  ExpectInputError(follow + " --go red", "--go 'red': expected LAT,LON, marked with --follow");
  const Outcome marked = Run(follow + " --go marked");  // after the line with the page's address
  EXPECT_EQ(marked.status, 1);
  EXPECT_THAT(marked.err, HasSubstr("--go marked: the camera, fixed as it is, does not look"));
  ExpectInputError("fly sim:hunt --autopilot sim:ardupilot --guide --go red",
                   "--go 'red': expected LAT,LON");
  for (const char* wrong :
       {"fly sim:hunt --autopilot sim:ardupilot --hunt --go red",
        "fly sim:hunt --autopilot sim:ardupilot --hunt --follow --guide --go red",
        "fly sim:hunt --autopilot sim:ardupilot --hunt --guide --box 47.3,8.5"}) {
    EXPECT_EQ(Run(wrong).status, 2) << wrong;
  }
}

TEST_F(FlyCommandTest, ReportsFaults) {
  const std::string source = "fly sim:standing --autopilot ";
  ExpectInputError(source + "udp://127.0.0.1:14550", "udp");
  ExpectInputError(source + "serial:///dev/no_such_line:57600", "there is no /dev/no_such_line");
  ExpectInputError(source + "/dev/ttyACM0", "did you mean serial:///dev/ttyACM0:57600?");
  ExpectInputError("fly sim:nowhere", "there is no scenario 'sim:nowhere'");
  ExpectInputError("fly " + folder_ / "missing", "no such file or folder");
  ExpectInputError(source + "sim:ardupilot --link-delay soon", "--link-delay 'soon'");
  ExpectInputError("fly sim:standing --still", "--still");
  ExpectInputError("fly sim:standing --annotate --output " + folder_ / "out", "kestrel land");
  ExpectInputError("fly sim:standing --set fly.rate_hz=0", "rate_hz");
  ExpectInputError("fly sim:standing --guide", "--autopilot URL");
  ExpectInputError(source + "sim:px4 --guide --rate 10", "at least 20 set-points");
  ExpectInputError("fly sim:standing --point", "--autopilot URL");
  ExpectInputError(source + "sim:px4 --point", "no gimbal to point");
  ExpectInputError(source + "sim:px4 --follow --guide", "--follow --guide: expected --console");
  // The page is open by then, and its address has been printed.
  const Outcome refused = Run(source + "sim:px4 --follow --guide --console 127.0.0.1:0");
  EXPECT_EQ(refused.status, 1);
  EXPECT_THAT(refused.err, HasSubstr("does not look 34 degrees down"));
  const std::string key = folder_.Write("key", std::string(64, 'a'));
  fs::permissions(key, fs::perms::owner_read | fs::perms::others_read);
  ExpectInputError(source + "sim:ardupilot --signing-key " + key, key);
  EXPECT_EQ(Run(source + "sim:ardupilot --profile betaflight").status, 2);
  const Outcome blind = Run("fly sim:standing");
  EXPECT_EQ(blind.status, 2);
  EXPECT_THAT(blind.err, HasSubstr("expected --autopilot URL"));
  EXPECT_EQ(Lines(blind.err), 1);
  const std::string camera = folder_.Write("camera.yaml",
                                           "camera_model: pinhole\nintrinsics: [90, 90, 32, 24]\n"
                                           "resolution: [64, 48]\ndistortion_model: equidistant\n"
                                           "distortion_coefficients: [0, 0, 0, 0]\n");
  const Outcome pipeline = Run("fly 'udpsrc port=99999 ! filesrc' --camera " + camera);
  EXPECT_EQ(pipeline.status, 1);
  EXPECT_EQ(Lines(pipeline.err), 1) << pipeline.err;
}

}  // namespace
}  // namespace kestrel
