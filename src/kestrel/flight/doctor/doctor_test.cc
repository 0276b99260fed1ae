// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <functional>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/flight/doctor/camera_checks.h"
#include "kestrel/flight/doctor/check_list.h"
#include "kestrel/flight/doctor/examination.h"
#include "kestrel/flight/doctor/finding.h"
#include "kestrel/flight/doctor/parameter_checks.h"
#include "kestrel/flight/doctor/test_setups.h"

namespace kestrel {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using Break = std::function<void(DoctorObservations*)>;

std::vector<std::string> Flagged(const std::vector<Finding>& findings) {
  std::vector<std::string> flagged;
  for (const Finding& finding : findings) {
    if (finding.verdict == Verdict::kDoubtful || finding.verdict == Verdict::kWrong) {
      flagged.push_back(finding.check + ": " + finding.measured);
    }
  }
  return flagged;
}

// --- A good set-up ---

TEST(DoctorTest, FlagsNothingOnGoodSetup) {
  for (const AutopilotKind kind : {AutopilotKind::kArduPilot, AutopilotKind::kPx4}) {
    EXPECT_THAT(Flagged(Check(GoodSetup(kind))), IsEmpty()) << ToString(kind);
    EXPECT_THAT(Flagged(Check(GoodGuidedSetup(kind))), IsEmpty()) << ToString(kind);
    EXPECT_THAT(Flagged(Check(OnGimbal(GoodSetup(kind)))), IsEmpty()) << ToString(kind);
    EXPECT_THAT(Flagged(Check(GoodPadSetup(kind))), IsEmpty()) << ToString(kind);
    EXPECT_THAT(Flagged(Check(GoodNoPositionSetup(kind))), IsEmpty()) << ToString(kind);
  }
}

TEST(DoctorTest, RunsAllChecksOnGoodSetup) {
  for (const Finding& finding : Check(GoodSetup(AutopilotKind::kPx4))) {
    EXPECT_EQ(finding.verdict, Verdict::kGood) << finding.check << ": " << finding.measured;
  }
}

TEST(DoctorTest, DelayOfVideoIsJudgedByItsUse) {
  struct Case {
    std::optional<ClockEstimate> delay;
    std::optional<double> target_mps;
    Verdict verdict;
    const char* words;
  };
  for (const Case& given : std::vector<Case>{
           {{}, {}, Verdict::kNotChecked, "has not turned"},
           {ClockEstimate{-0.2, 0.004}, {}, Verdict::kGood, "200 ms late, +- 4 ms"},
           {ClockEstimate{-0.2, 0.004}, 4.2, Verdict::kGood, "200 ms late"},
           {ClockEstimate{-0.2, 0.01}, 8.3, Verdict::kDoubtful, "0.08 m for a target at 8.3 m/s"},
           {ClockEstimate{-0.4, 0.004}, 4.2, Verdict::kDoubtful, "400 ms late"},
           {ClockEstimate{-0.4, 0.004}, {}, Verdict::kGood, "400 ms late"},
           {ClockEstimate{-0.7, 0.004}, {}, Verdict::kWrong, "700 ms late"}}) {
    DoctorObservations setup = GoodSetup(AutopilotKind::kArduPilot);
    setup.camera.comes_late = true;
    setup.camera.delay = given.delay;
    setup.use.target_mps = given.target_mps;
    const Finding finding = CheckVideoDelay(setup.camera, setup.use);
    EXPECT_EQ(finding.verdict, given.verdict) << given.words;
    EXPECT_THAT(finding.measured, HasSubstr(given.words));
    std::vector<std::string> checks;
    for (const Finding& other : Check(setup)) checks.push_back(other.check);
    EXPECT_THAT(checks, Contains("video delay"));
  }
}

TEST(DoctorTest, VideoWithGapsIsTooOldForGuidance) {
  DoctorObservations setup = GoodGuidedSetup(AutopilotKind::kArduPilot);
  setup.camera.comes_late = true;
  setup.camera.delay = ClockEstimate{-0.2, 0.004};
  EXPECT_EQ(CheckVideoDelay(setup.camera, setup.use).verdict, Verdict::kGood);
  std::erase_if(setup.camera.frames, [](const FrameSample& frame) {
    return (frame.stamp - FrameTime(0)) % std::chrono::seconds(1) > std::chrono::milliseconds(400);
  });
  const Finding finding = CheckVideoDelay(setup.camera, setup.use);
  EXPECT_EQ(finding.verdict, Verdict::kDoubtful);
  EXPECT_THAT(finding.measured, HasSubstr("climbs after 0.5 s"));
}

TEST(DoctorTest, ListsEveryCheck) {
  std::vector<std::string> listed;
  for (const ListedCheck& check : ListedChecks()) listed.emplace_back(check.name);
  for (const AutopilotKind kind : {AutopilotKind::kArduPilot, AutopilotKind::kPx4}) {
    for (const ListedCheck& check : CheckedParameters(kind)) listed.emplace_back(check.name);
    for (const auto& setup : {GoodSetup(kind), GoodGuidedSetup(kind), OnGimbal(GoodSetup(kind)),
                              GoodPadSetup(kind), GoodNoPositionSetup(kind)}) {
      for (const Finding& finding : Check(setup)) EXPECT_THAT(listed, Contains(finding.check));
    }
  }
}

// --- One fault at a time ---

enum class Setup {
  kArduPilot,
  kPx4,
  kGuidedArduPilot,
  kGuidedPx4,
  kPadArduPilot,
  kPadPx4,
  kNoPositionArduPilot,
  kNoPositionPx4
};

DoctorObservations Make(Setup setup) {
  switch (setup) {
    case Setup::kArduPilot:
      return GoodSetup(AutopilotKind::kArduPilot);
    case Setup::kPx4:
      return GoodSetup(AutopilotKind::kPx4);
    case Setup::kGuidedArduPilot:
      return GoodGuidedSetup(AutopilotKind::kArduPilot);
    case Setup::kGuidedPx4:
      return GoodGuidedSetup(AutopilotKind::kPx4);
    case Setup::kPadArduPilot:
      return GoodPadSetup(AutopilotKind::kArduPilot);
    case Setup::kPadPx4:
      return GoodPadSetup(AutopilotKind::kPx4);
    case Setup::kNoPositionArduPilot:
      return GoodNoPositionSetup(AutopilotKind::kArduPilot);
    case Setup::kNoPositionPx4:
      return GoodNoPositionSetup(AutopilotKind::kPx4);
  }
  return {};
}

struct Fault {
  std::string name;
  Setup setup;
  Break break_it;
  std::string check;  // name of the check that should find it
  Verdict verdict;
  std::string words;  // words in its measurement or advice
};

Break Parameter(const std::string& name, double value) {
  return [=](DoctorObservations* all) { all->parameters[name] = {value, name, 1}; };
}

// The camera's real mount is turned from the calibration's.
Break TurnedCamera(const Eigen::Vector3d& axis, double degrees) {
  return [=](DoctorObservations* all) {
    RigidTransform mount = DownwardMount();
    mount.rotation = mount.rotation * Eigen::AngleAxisd(Radians(degrees), axis);
    all->vision.patterns = PatternsSeen(mount, 15);
  };
}

Break Qualities(const std::function<void(ImageQuality*)>& change) {
  return [=](DoctorObservations* all) {
    for (ImageQuality& quality : all->camera.qualities) change(&quality);
  };
}

void SlowDown(DoctorObservations* all) {
  for (int i = 0; i < kFrames; ++i) {
    FrameSample& frame = all->camera.frames[static_cast<std::size_t>(i)];
    frame.stamp = FrameTime(4 * i);
    frame.arrival = frame.stamp + std::chrono::milliseconds(30);
  }
}

void JumpClock(DoctorObservations* all) {
  for (std::size_t i = 80; i < kFrames; ++i) {
    all->camera.frames[i].stamp += std::chrono::seconds(2);
  }
}

void Silence(DoctorObservations* all) {
  all->link.is_heard = false;
  all->link.counters = {};
  all->link.heartbeats = 0;
  all->parameters.clear();
}

void MoveTarget(DoctorObservations* all) { all->use.target_mps = 4.2; }

const Eigen::Vector3d kAxis = Eigen::Vector3d::UnitZ();  // optical axis of the camera

std::vector<Fault> CameraFaults() {
  return {
      {"swapped width and height", Setup::kArduPilot,
       [](DoctorObservations* all) {
         std::swap(all->calibration.intrinsics.width_px, all->calibration.intrinsics.height_px);
       },
       "image size", Verdict::kWrong, "swapped"},
      {"a camera that does not open", Setup::kPx4,
       [](DoctorObservations* all) {
         all->camera = {};
         all->camera.open_error = "/dev/video7: there is no such device";
       },
       "images", Verdict::kWrong, "/dev/video7"},
      {"no images", Setup::kPx4,
       [](DoctorObservations* all) {
         all->camera.frames.clear();
         all->camera.qualities.clear();
       },
       "images", Verdict::kWrong, "none in 8 s"},
      {"calibration of another lens", Setup::kArduPilot,
       [](DoctorObservations* all) {
         all->vision.focal = all->vision.focal_contradiction = FocalFactor{1.2, 0.01, 80};
       },
       "calibration by the pattern", Verdict::kWrong, "calibrate lens"},
      {"another pattern", Setup::kArduPilot,
       [](DoctorObservations* all) {
         for (PatternSample& pattern : all->vision.patterns) pattern.misfit_px = 2.5;
       },
       "calibration by the pattern", Verdict::kWrong, "another pattern"},
      {"a lens model that bends back", Setup::kPx4,
       [](DoctorObservations* all) {
         all->calibration.intrinsics.distortion_model = DistortionModel::kRadialTangential;
         all->calibration.intrinsics.distortion = {-0.6, 0.05, 0, 0};
       },
       "lens model", Verdict::kWrong, "border"},
      {"dark", Setup::kArduPilot, Qualities([](ImageQuality* q) { q->bright_gray = 30; }),
       "exposure", Verdict::kWrong, "dark"},
      {"saturated", Setup::kArduPilot, Qualities([](ImageQuality* q) { q->saturated_share = 0.4; }),
       "exposure", Verdict::kWrong, "saturated"},
      {"blurred", Setup::kPx4, Qualities([](ImageQuality* q) { q->edge_px = 9; }), "focus",
       Verdict::kWrong, "blurred"},
      {"5 frames/s", Setup::kArduPilot, SlowDown, "frame rate", Verdict::kWrong, "5.0 images/s"},
      {"frozen frames", Setup::kPx4, Qualities([](ImageQuality* q) { q->hash = 7; }),
       "frozen images", Verdict::kWrong, "repeats"},
      {"clock jump", Setup::kArduPilot, JumpClock, "capture clock", Verdict::kWrong, "jumped"},
      {"times that go back", Setup::kArduPilot,
       [](DoctorObservations* all) { all->camera.frames[50].stamp = all->camera.frames[40].stamp; },
       "capture clock", Verdict::kWrong, "back"},
      {"late images", Setup::kArduPilot,
       [](DoctorObservations* all) {
         for (FrameSample& frame : all->camera.frames) frame.arrival += std::chrono::seconds(1);
       },
       "capture clock", Verdict::kWrong, "buffering"},
      {"images that are lost", Setup::kPx4,
       [](DoctorObservations* all) { all->camera.counters.missed = kFrames; }, "missed images",
       Verdict::kDoubtful, "50 %"},
  };
}

std::vector<Fault> MountFaults() {
  return {
      {"no mount", Setup::kPx4,
       [](DoctorObservations* all) { all->calibration.body_from_camera.reset(); }, "mount",
       Verdict::kWrong, "T_BS"},
      {"a mount that looks up", Setup::kPx4,
       [](DoctorObservations* all) {
         all->calibration.body_from_camera->rotation =
             Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitX()) * DownwardMount().rotation;
       },
       "mount", Verdict::kWrong, "180 deg from straight down"},
      {"mount turned by 90 degrees", Setup::kArduPilot, TurnedCamera(kAxis, 90),
       "mount against motion", Verdict::kWrong,
       "90 deg clockwise (seen from behind) about its optical axis"},
      {"mount turned the other way", Setup::kPx4, TurnedCamera(kAxis, -90), "mount against motion",
       Verdict::kWrong, "counterclockwise"},
      {"camera upside down", Setup::kArduPilot, TurnedCamera(kAxis, 180), "mount against motion",
       Verdict::kWrong, "upside down"},
      {"camera tilted by 45 degrees", Setup::kPx4, TurnedCamera(Eigen::Vector3d::UnitX(), 45),
       "mount against gravity", Verdict::kWrong, "from level"},
  };
}

std::vector<Fault> LinkFaults() {
  return {
      {"no heartbeat", Setup::kArduPilot, Silence, "heartbeat", Verdict::kWrong, "MAVLink"},
      {"wrong baud", Setup::kPx4,
       [](DoctorObservations* all) {
         Silence(all);
         all->link.baud = 57600;
         all->link.counters.garbage_bytes = 30'000;
       },
       "line", Verdict::kWrong, "57600"},
      {"a damaged line", Setup::kArduPilot,
       [](DoctorObservations* all) { all->link.counters.bad_checksums = 200; }, "line",
       Verdict::kDoubtful, "200 damaged"},
      {"streams missing", Setup::kArduPilot,
       [](DoctorObservations* all) { all->link.attitudes = 0; }, "attitude", Verdict::kWrong,
       "none came"},
      {"streams that are too slow", Setup::kPx4,
       [](DoctorObservations* all) { all->link.attitudes = 20; }, "attitude", Verdict::kWrong,
       "921600"},
      {"position lost", Setup::kPx4, [](DoctorObservations* all) { all->link.position_age_s = 3; },
       "position", Verdict::kWrong, "3.0 s ago"},
      {"position not trusted", Setup::kArduPilot,
       [](DoctorObservations* all) { all->link.has_good_position = false; }, "position estimate",
       Verdict::kWrong, "GNSS"},
      {"a plane", Setup::kArduPilot, [](DoctorObservations* all) { all->link.vehicle_type = 1; },
       "vehicle", Verdict::kWrong, "multicopter"},
      {"an autopilot that started anew", Setup::kPx4,
       [](DoctorObservations* all) { all->link.restarts = 1; }, "heartbeat", Verdict::kWrong,
       "power"},
      {"a clock that jumps", Setup::kArduPilot,
       [](DoctorObservations* all) { all->link.clock_jumps = 2; }, "autopilot's clock",
       Verdict::kWrong, "jumped"},
      {"a link that takes half a second", Setup::kArduPilot,
       [](DoctorObservations* all) { all->link.round_trip_s = 0.5; }, "round trip", Verdict::kWrong,
       "500"},
      {"unsigned link refused", Setup::kPx4,
       [](DoctorObservations* all) {
         Silence(all);
         all->link.is_signed = true;
         all->link.counters.unsigned_packets = 300;
       },
       "signing", Verdict::kWrong, "SETUP_SIGNING"},
      {"an autopilot that signs", Setup::kArduPilot,
       [](DoctorObservations* all) { all->link.hears_signed = true; }, "signing", Verdict::kWrong,
       "--signing-key"},
      {"another source of targets", Setup::kArduPilot,
       [](DoctorObservations* all) { all->link.events = {"somebody else sends targets"}; },
       "others on the line", Verdict::kDoubtful, "targets"},
  };
}

// A fault of a set-up with a gimbal.
Break Gimbal(const Break& change, double echo_s = 0) {
  return [=](DoctorObservations* all) {
    *all = OnGimbal(*all, echo_s);
    change(all);
  };
}

std::vector<Fault> GimbalFaults() {
  const auto each = [](const std::function<void(GimbalObservation*)>& change) {
    return [=](DoctorObservations* all) {
      for (GimbalObservation& report : all->gimbal.reports) change(&report);
    };
  };
  return {
      {"a gimbal that is silent", Setup::kArduPilot,
       Gimbal([](DoctorObservations* all) { all->link.gimbal_reports = 0; }), "gimbal",
       Verdict::kWrong, "MNT1_TYPE"},
      {"a gimbal that reports seldom", Setup::kPx4,
       Gimbal([](DoctorObservations* all) { all->link.gimbal_reports = 20; }), "gimbal",
       Verdict::kDoubtful, "10 or more"},
      {"a gimbal in another frame than its flags say", Setup::kArduPilot,
       Gimbal(each([](auto* report) { report->sample.yaw_frame = YawFrame::kVehicle; })),
       "gimbal against images", Verdict::kWrong, "against north"},
      {"an echoed set-point", Setup::kPx4, Gimbal([](DoctorObservations*) {}, 0.15),
       "gimbal against images", Verdict::kWrong, "0.15 s behind its reports"},
      {"a set-point that jumps", Setup::kPx4, Gimbal([](DoctorObservations* all) {
         auto& attitude = all->gimbal.reports[50].sample.level_from_platform;
         attitude = attitude * Eigen::AngleAxisd(Radians(40), Eigen::Vector3d::UnitY());
       }),
       "gimbal's motors", Verdict::kWrong, "set-point"},
      {"a gimbal that is locked", Setup::kArduPilot, Gimbal(each([](auto* report) {
         report->sample.level_from_platform = report->world_from_body;
       })),
       "gimbal's motors", Verdict::kWrong, "locked to the UAV"},
      {"a gimbal whose yaw is zero at power-on", Setup::kArduPilot,
       Gimbal([](DoctorObservations* all) {
         for (GimbalObservation& report : all->gimbal.reports) {
           Eigen::Quaterniond& platform = report.sample.level_from_platform;
           platform = Eigen::AngleAxisd(Radians(-40), Eigen::Vector3d::UnitZ()) * platform;
         }
       }),
       "gimbal against images", Verdict::kWrong, "turned by 40 deg"},
      {"a gimbal controlled by another", Setup::kPx4, Gimbal([](DoctorObservations* all) {
         all->gimbal.controller = {255, 190};
       }),
       "gimbal's control", Verdict::kDoubtful, "system 255 component 190"},
      {"a gimbal that cannot look down", Setup::kArduPilot,
       Gimbal([](DoctorObservations* all) { all->gimbal.range->lowest = Radians(45); }),
       "gimbal's range", Verdict::kWrong, "45 deg below the horizon"},
      {"MNT1_TYPE of none", Setup::kArduPilot, Gimbal(Parameter("MNT1_TYPE", 0)), "MNT1_TYPE",
       Verdict::kWrong, "no gimbal"},
      {"MNT1_TYPE of servos", Setup::kArduPilot, Gimbal(Parameter("MNT1_TYPE", 1)), "MNT1_TYPE",
       Verdict::kDoubtful, "set-point"},
      {"MNT1_DEFLT_MODE retracted", Setup::kArduPilot, Gimbal(Parameter("MNT1_DEFLT_MODE", 0)),
       "MNT1_DEFLT_MODE", Verdict::kDoubtful, "retracted"},
      {"MNT_MODE_IN off", Setup::kPx4, Gimbal(Parameter("MNT_MODE_IN", -1)), "MNT_MODE_IN",
       Verdict::kWrong, "ignored"},
      {"MNT_MODE_OUT of servos", Setup::kPx4, Gimbal(Parameter("MNT_MODE_OUT", 0)), "MNT_MODE_OUT",
       Verdict::kDoubtful, "set-point"},
      {"MAV_1_FORWARD off", Setup::kPx4, Gimbal([](DoctorObservations* all) {
         all->link.gimbal_reports = 0;
         Parameter("MAV_1_FORWARD", 0)(all);
       }),
       "MAV_1_FORWARD", Verdict::kDoubtful, "forwarded"},
  };
}

std::vector<Fault> ParameterFaults() {
  return {
      {"CAM1_TYPE beside a camera that follows", Setup::kArduPilot,
       [](DoctorObservations* all) {
         all->use.follows = true;
         Parameter("CAM1_TYPE", 4)(all);
       },
       "CAM1_TYPE", Verdict::kDoubtful, "param set CAM1_TYPE 0"},
      {"CAM1_TYPE of none with a zoom", Setup::kArduPilot,
       [](DoctorObservations* all) {
         all->calibration.zoom.emplace();
         Parameter("CAM1_TYPE", 0)(all);
       },
       "CAM1_TYPE", Verdict::kDoubtful, "no camera that could report"},
      {"CAM1_HFOV with a zoom", Setup::kArduPilot,
       [](DoctorObservations* all) {
         all->calibration.zoom.emplace();
         Parameter("CAM1_HFOV", 60)(all);
       },
       "CAM1_HFOV", Verdict::kDoubtful, "whatever the lens does"},
      {"PLND_TYPE wrong", Setup::kArduPilot, Parameter("PLND_TYPE", 2), "PLND_TYPE",
       Verdict::kWrong, "param set PLND_TYPE 1, then reboot"},
      {"PLND_ENABLED", Setup::kArduPilot, Parameter("PLND_ENABLED", 0), "PLND_ENABLED",
       Verdict::kWrong, "param set PLND_ENABLED 1"},
      {"precision landing off, and hidden", Setup::kArduPilot,
       [](DoctorObservations* all) {
         std::erase_if(all->parameters, [](const auto& p) { return p.first.starts_with("PLND"); });
         all->parameters["PLND_ENABLED"] = {0, "PLND_ENABLED", 1};
       },
       "PLND_ENABLED", Verdict::kWrong, "hidden"},
      {"LAG too small", Setup::kArduPilot,
       [](DoctorObservations* all) { all->vision.latency_s = 0.12; }, "latency", Verdict::kDoubtful,
       "param set PLND_LAG 0.12"},
      {"PLND_YAW_ALIGN", Setup::kArduPilot, Parameter("PLND_YAW_ALIGN", 9000), "PLND_YAW_ALIGN",
       Verdict::kWrong, "param set PLND_YAW_ALIGN 0"},
      {"frame of the target wrong for ArduPilot", Setup::kArduPilot,
       [](DoctorObservations* all) { all->use.profile = LinkProfile::kPx4; }, "frame of the target",
       Verdict::kWrong, "LOCAL_NED is ignored"},
      {"frame of the target wrong for PX4", Setup::kPx4,
       [](DoctorObservations* all) { all->use.profile = LinkProfile::kArduPilot; },
       "frame of the target", Verdict::kWrong, "BODY_FRD is refused"},
      {"VTE_EN 0", Setup::kPx4,
       [](DoctorObservations* all) { all->use.profile = LinkProfile::kPx4Vte; }, "VTE_EN",
       Verdict::kWrong, "param set VTE_EN 1"},
      {"a target that moves, and PX4's own landing", Setup::kPx4, MoveTarget, "moving target",
       Verdict::kWrong, "--guide"},
      {"a target that moves, PLND_OPTIONS 0", Setup::kArduPilot, MoveTarget, "PLND_OPTIONS",
       Verdict::kWrong, "param set PLND_OPTIONS 1"},
      {"a target that moves, PLND_RET_MAX 4", Setup::kArduPilot, MoveTarget, "PLND_RET_MAX",
       Verdict::kWrong, "param set PLND_RET_MAX 0"},
      {"a target that moves, PLND_XY_DIST_MAX 2.5", Setup::kArduPilot, MoveTarget,
       "PLND_XY_DIST_MAX", Verdict::kWrong, "param set PLND_XY_DIST_MAX 0"},
      {"the old name, in centimetres", Setup::kGuidedArduPilot,
       [](DoctorObservations* all) {
         all->parameters["WP_SPD"] = {3, "WPNAV_SPEED", 0.01};
       },
       "WPNAV_SPEED", Verdict::kWrong, "param set WPNAV_SPEED 800"},
      {"too little acceleration for a curve", Setup::kGuidedArduPilot, Parameter("WP_ACC", 2.5),
       "WP_ACC", Verdict::kDoubtful, "param set WP_ACC 6"},
      {"too little jerk for a curve", Setup::kGuidedArduPilot, Parameter("PSC_JERK_NE", 5),
       "PSC_JERK_NE", Verdict::kDoubtful, "param set PSC_JERK_NE 20"},
      {"height by range finder", Setup::kGuidedArduPilot, Parameter("EK3_SRC1_POSZ", 2),
       "EK3_SRC1_POSZ", Verdict::kWrong, "deck"},
      {"GUID_TIMEOUT", Setup::kGuidedArduPilot, Parameter("GUID_TIMEOUT", 3), "GUID_TIMEOUT",
       Verdict::kWrong, "param set GUID_TIMEOUT 0.3"},
      {"GUID_TIMEOUT of a second", Setup::kGuidedArduPilot, Parameter("GUID_TIMEOUT", 1),
       "GUID_TIMEOUT", Verdict::kWrong, "flown on"},
      {"GUID_TIMEOUT of half a second", Setup::kGuidedArduPilot, Parameter("GUID_TIMEOUT", 0.5),
       "GUID_TIMEOUT", Verdict::kDoubtful, "flown on"},
      {"GUID_TIMEOUT of a blink", Setup::kGuidedArduPilot, Parameter("GUID_TIMEOUT", 0.05),
       "GUID_TIMEOUT", Verdict::kDoubtful, "whenever the link is slow"},
      {"FS_GCS_ENABLE that lands", Setup::kGuidedArduPilot, Parameter("FS_GCS_ENABLE", 5),
       "FS_GCS_ENABLE", Verdict::kDoubtful, "lands where it is"},
      {"ATC_ANGLE_MAX below what guidance may lean", Setup::kGuidedArduPilot,
       Parameter("ATC_ANGLE_MAX", 20), "ATC_ANGLE_MAX", Verdict::kWrong,
       "param set ATC_ANGLE_MAX 30"},
      {"another ground station only", Setup::kArduPilot,
       [](DoctorObservations* all) {
         all->parameters["MAV_OPTIONS"] = {1, "MAV_OPTIONS", 1};
         all->link.own_system = 42;
       },
       "MAV_GCS_SYSID", Verdict::kWrong, "fly.link.system_id=0"},
      {"COM_OF_LOSS_T", Setup::kGuidedPx4, Parameter("COM_OF_LOSS_T", 1), "COM_OF_LOSS_T",
       Verdict::kWrong, "param set COM_OF_LOSS_T 0.3"},
      {"COM_OBL_RC_ACT with NAV_RCL_ACT 0", Setup::kGuidedPx4,
       [](DoctorObservations* all) {
         Parameter("COM_OBL_RC_ACT", 0)(all);
         Parameter("NAV_RCL_ACT", 0)(all);
       },
       "COM_OBL_RC_ACT", Verdict::kWrong, "for ever"},
      {"COM_OBL_RC_ACT that waits for the sticks", Setup::kGuidedPx4,
       Parameter("COM_OBL_RC_ACT", 0), "COM_OBL_RC_ACT", Verdict::kDoubtful, "drifts"},
      {"COM_OBL_RC_ACT that returns", Setup::kGuidedPx4, Parameter("COM_OBL_RC_ACT", 3),
       "COM_OBL_RC_ACT", Verdict::kDoubtful, "returns"},
      {"COM_OBL_RC_ACT that lands", Setup::kGuidedPx4, Parameter("COM_OBL_RC_ACT", 4),
       "COM_OBL_RC_ACT", Verdict::kDoubtful, "lands where it is"},
      {"MPC_TILTMAX_AIR below what guidance may lean", Setup::kGuidedPx4,
       [](DoctorObservations* all) {
         all->use.tilt_deg = 35;
         Parameter("MPC_TILTMAX_AIR", 20)(all);
       },
       "MPC_TILTMAX_AIR", Verdict::kWrong, "param set MPC_TILTMAX_AIR 35"},
      {"COM_OBL_RC_ACT that stops the motors", Setup::kGuidedPx4, Parameter("COM_OBL_RC_ACT", 7),
       "COM_OBL_RC_ACT", Verdict::kWrong, "motors"},
      {"LNDMC_XY_VEL_MAX", Setup::kGuidedPx4, Parameter("LNDMC_XY_VEL_MAX", 1.5),
       "LNDMC_XY_VEL_MAX", Verdict::kWrong, "param set LNDMC_XY_VEL_MAX 6"},
      {"MPC_XY_VEL_MAX", Setup::kGuidedPx4, Parameter("MPC_XY_VEL_MAX", 4), "MPC_XY_VEL_MAX",
       Verdict::kWrong, "param set MPC_XY_VEL_MAX 8"},
      {"dead sticks", Setup::kGuidedPx4, Parameter("MAN_OVERRIDE_SPD", -1), "MAN_OVERRIDE_SPD",
       Verdict::kDoubtful, "sticks"},
      {"a return that searches", Setup::kPx4, Parameter("RTL_PLD_MD", 2), "RTL_PLD_MD",
       Verdict::kDoubtful, "param set RTL_PLD_MD 1"},
      {"no search", Setup::kPx4, Parameter("PLD_MAX_SRCH", 0), "PLD_MAX_SRCH", Verdict::kDoubtful,
       "param set PLD_MAX_SRCH 3"},
      {"a search above the range of sight", Setup::kPx4,
       [](DoctorObservations* all) {
         all->parameters["PLD_SRCH_ALT"] = {30, "PLD_SRCH_ALT", 1};
         all->use.sight_range_m = 12.5;
       },
       "PLD_SRCH_ALT", Verdict::kDoubtful, "param set PLD_SRCH_ALT 12"},
      {"an offset that is left over", Setup::kArduPilot, Parameter("PLND_LAND_OFS_X", 12),
       "PLND_LAND_OFS_X", Verdict::kDoubtful, "param set PLND_LAND_OFS_X 0"},
      {"landing slower than allowed", Setup::kPx4, Parameter("MPC_Z_VEL_MAX_DN", 0.5),
       "MPC_Z_VEL_MAX_DN", Verdict::kWrong, "contact"},
  };
}

// The pad is the position.
std::vector<Fault> PadFaults() {
  return {
      {"no origin", Setup::kPadArduPilot,
       [](DoctorObservations* all) { all->use.has_pad_origin = false; }, "origin", Verdict::kWrong,
       "fly.pad_origin"},
      {"ODOMETRY not read", Setup::kPadArduPilot, Parameter("VISO_TYPE", 0), "VISO_TYPE",
       Verdict::kWrong, "param set VISO_TYPE 1, then reboot"},
      {"a delay left at its default", Setup::kPadArduPilot,
       [](DoctorObservations* all) { all->vision.latency_s = 0.12; }, "VISO_DELAY_MS",
       Verdict::kDoubtful, "param set VISO_DELAY_MS 122"},
      {"place by GNSS", Setup::kPadArduPilot, Parameter("EK3_SRC1_POSXY", 3), "EK3_SRC1_POSXY",
       Verdict::kWrong, "param set EK3_SRC1_POSXY 6"},
      {"speed by GNSS", Setup::kPadArduPilot, Parameter("EK3_SRC1_VELXY", 3), "EK3_SRC1_VELXY",
       Verdict::kDoubtful, "speed by GNSS"},
      {"vertical speed by GNSS", Setup::kPadArduPilot, Parameter("EK3_SRC1_VELZ", 3),
       "EK3_SRC1_VELZ", Verdict::kDoubtful, "param set EK3_SRC1_VELZ 0"},
      {"height by GNSS", Setup::kPadArduPilot, Parameter("EK3_SRC1_POSZ", 3), "EK3_SRC1_POSZ",
       Verdict::kWrong, "param set EK3_SRC1_POSZ 1"},
      {"heading by GNSS", Setup::kPadArduPilot, Parameter("EK3_SRC1_YAW", 2), "EK3_SRC1_YAW",
       Verdict::kWrong, "param set EK3_SRC1_YAW 1"},
      {"a receiver of GNSS", Setup::kPadArduPilot, Parameter("GPS1_TYPE", 1), "GPS1_TYPE",
       Verdict::kDoubtful, "param set GPS1_TYPE 0"},
      {"no failsafe of the estimator", Setup::kPadArduPilot, Parameter("FS_EKF_ACTION", 0),
       "FS_EKF_ACTION", Verdict::kDoubtful, "drifts"},
      {"a fence", Setup::kPadArduPilot, Parameter("FENCE_ENABLE", 1), "FENCE_ENABLE",
       Verdict::kDoubtful, "arms with a position only"},
      {"a return without transmitter", Setup::kPadArduPilot, Parameter("FS_THR_ENABLE", 1),
       "FS_THR_ENABLE", Verdict::kDoubtful, "returns"},
      {"a return without ground station", Setup::kPadArduPilot, Parameter("FS_GCS_ENABLE", 1),
       "FS_GCS_ENABLE", Verdict::kDoubtful, "returns"},
      {"GUID_TIMEOUT", Setup::kPadArduPilot, Parameter("GUID_TIMEOUT", 3), "GUID_TIMEOUT",
       Verdict::kWrong, "param set GUID_TIMEOUT 0.3"},
      {"external vision off", Setup::kPadPx4, Parameter("EKF2_EV_CTRL", 8), "EKF2_EV_CTRL",
       Verdict::kWrong, "param set EKF2_EV_CTRL 11"},
      {"a guess for 5 s", Setup::kPadPx4, Parameter("EKF2_NOAID_TOUT", 5e6), "EKF2_NOAID_TOUT",
       Verdict::kDoubtful, "param set EKF2_NOAID_TOUT 500000"},
      {"GNSS in the estimator", Setup::kPadPx4, Parameter("EKF2_GPS_CTRL", 7), "EKF2_GPS_CTRL",
       Verdict::kDoubtful, "param set EKF2_GPS_CTRL 0"},
      {"GNSS wanted", Setup::kPadPx4, Parameter("SYS_HAS_GPS", 1), "SYS_HAS_GPS",
       Verdict::kDoubtful, "COM_ARM_WO_GPS"},
      {"COM_OBL_RC_ACT that returns", Setup::kPadPx4, Parameter("COM_OBL_RC_ACT", 3),
       "COM_OBL_RC_ACT", Verdict::kWrong, "param set COM_OBL_RC_ACT 4"},
      {"thrust instead of climb rate", Setup::kNoPositionArduPilot, Parameter("GUID_OPTIONS", 9),
       "GUID_OPTIONS", Verdict::kWrong, "param set GUID_OPTIONS 1"},
      {"fence without position", Setup::kNoPositionArduPilot, Parameter("FENCE_ENABLE", 1),
       "FENCE_ENABLE", Verdict::kWrong, "does not arm"},
      {"landing in any mode", Setup::kNoPositionArduPilot, Parameter("FS_EKF_ACTION", 3),
       "FS_EKF_ACTION", Verdict::kDoubtful, "param set FS_EKF_ACTION 1"},
      {"hover thrust not learnt", Setup::kNoPositionArduPilot,
       Parameter("MOT_THST_HOVER", static_cast<double>(0.35f)), "MOT_THST_HOVER",
       Verdict::kDoubtful, "MOT_HOVER_LEARN 2"},
      {"slow end of set-points", Setup::kNoPositionArduPilot, Parameter("GUID_TIMEOUT", 3),
       "GUID_TIMEOUT", Verdict::kWrong, "param set GUID_TIMEOUT 0.3"},
      {"no arming without GNSS", Setup::kNoPositionPx4, Parameter("COM_ARM_WO_GPS", 0),
       "COM_ARM_WO_GPS", Verdict::kWrong, "param set COM_ARM_WO_GPS 1"},
      {"hover thrust fixed", Setup::kNoPositionPx4, Parameter("MPC_USE_HTE", 0), "MPC_USE_HTE",
       Verdict::kDoubtful, "param set MPC_USE_HTE 1"},
      {"Hold without position", Setup::kNoPositionPx4, Parameter("COM_OBL_RC_ACT", 0),
       "COM_OBL_RC_ACT", Verdict::kWrong, "param set COM_OBL_RC_ACT 4"},
      {"NAV_RCL_ACT that returns", Setup::kPadPx4, Parameter("NAV_RCL_ACT", 2), "NAV_RCL_ACT",
       Verdict::kDoubtful, "returns"},
  };
}

std::vector<Fault> ComputerFaults() {
  return {
      {"too slow a computer", Setup::kPx4,
       [](DoctorObservations* all) { all->vision.detect_s = all->vision.detect_p90_s = 0.08; },
       "detection time", Verdict::kWrong, "smaller images"},
      {"a busy computer", Setup::kPx4, [](DoctorObservations* all) { all->computer.load = 8; },
       "load", Verdict::kDoubtful, "top"},
      {"throttled", Setup::kPx4, [](DoctorObservations* all) { all->computer.throttled = 0x4; },
       "heat", Verdict::kWrong, "slowed"},
      {"hot", Setup::kArduPilot, [](DoctorObservations* all) { all->computer.hottest_c = 83; },
       "heat", Verdict::kDoubtful, "83"},
      {"undervoltage", Setup::kPx4, [](DoctorObservations* all) { all->computer.throttled = 0x1; },
       "power", Verdict::kWrong, "5.1 V"},
      {"undervoltage before", Setup::kPx4,
       [](DoctorObservations* all) { all->computer.throttled = 0x10000; }, "power",
       Verdict::kDoubtful, "since it was started"},
      {"undervoltage by the kernel's alarm", Setup::kPx4,
       [](DoctorObservations* all) { all->computer.has_low_voltage = true; }, "power",
       Verdict::kWrong, "undervoltage now"},
      {"a disk that can only be read", Setup::kPx4,
       [](DoctorObservations* all) { all->computer.is_disk_read_only = true; }, "disk",
       Verdict::kWrong, "fsck"},
      {"a slow card", Setup::kPx4, [](DoctorObservations* all) { all->computer.disk_mb_per_s = 2; },
       "disk", Verdict::kDoubtful, "too slow"},
      {"a worn card", Setup::kPx4, [](DoctorObservations* all) { all->computer.disk_wear = 0.9; },
       "disk", Verdict::kDoubtful, "90 % of the card's life"},
      {"a clock that nobody sets", Setup::kPx4,
       [](DoctorObservations* all) {
         all->computer.is_time_synchronized = false;
         all->computer.has_battery_clock = false;
       },
       "time of day", Verdict::kDoubtful, "no battery clock"},
      {"a full disk", Setup::kArduPilot,
       [](DoctorObservations* all) { all->computer.free_disk_mb = 100; }, "disk", Verdict::kWrong,
       "100 MB"},
  };
}

// GoogleTest prints this for failed tests.
void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.name; }

class DoctorFaultTest : public ::testing::TestWithParam<Fault> {};

TEST_P(DoctorFaultTest, IsReported) {
  const Fault& fault = GetParam();
  DoctorObservations all = Make(fault.setup);
  fault.break_it(&all);
  const std::vector<Finding> findings = Check(all);
  const auto found = std::ranges::find(findings, fault.check, &Finding::check);
  ASSERT_NE(found, findings.end()) << FindingsTable(findings, false);
  EXPECT_EQ(found->verdict, fault.verdict) << FindingsTable(findings, false);
  EXPECT_THAT(found->measured + " " + found->advice, HasSubstr(fault.words));
  EXPECT_FALSE(found->advice.empty());
}

INSTANTIATE_TEST_SUITE_P(Camera, DoctorFaultTest, ::testing::ValuesIn(CameraFaults()));
INSTANTIATE_TEST_SUITE_P(Mount, DoctorFaultTest, ::testing::ValuesIn(MountFaults()));
INSTANTIATE_TEST_SUITE_P(Gimbal, DoctorFaultTest, ::testing::ValuesIn(GimbalFaults()));
INSTANTIATE_TEST_SUITE_P(Link, DoctorFaultTest, ::testing::ValuesIn(LinkFaults()));
INSTANTIATE_TEST_SUITE_P(Parameters, DoctorFaultTest, ::testing::ValuesIn(ParameterFaults()));
INSTANTIATE_TEST_SUITE_P(Pad, DoctorFaultTest, ::testing::ValuesIn(PadFaults()));
INSTANTIATE_TEST_SUITE_P(Computer, DoctorFaultTest, ::testing::ValuesIn(ComputerFaults()));

// --- A further camera ---

// A good set-up with a second camera that looks ahead, named "cam1", whose mount is turned by
// 'turned_deg' and whose stamps are late.
DoctorObservations WithSecondCamera(double turned_deg, double late_s, double tilt_deg = 15) {
  DoctorObservations all = GoodSetup(AutopilotKind::kArduPilot);
  all.vision.patterns = PatternsSeen(DownwardMount(), tilt_deg);
  CameraSetup& second = all.further.emplace_back();
  second.calibration = all.calibration;
  second.calibration.name = "cam1";
  RigidTransform mount = DownwardMount();
  mount.rotation = mount.rotation * Eigen::AngleAxisd(Radians(30), Eigen::Vector3d::UnitX());
  second.calibration.body_from_camera = mount;
  mount.rotation =
      mount.rotation * Eigen::AngleAxisd(Radians(turned_deg), Eigen::Vector3d::UnitY());
  second.camera = GoodCamera();
  second.vision = all.vision;
  second.vision.patterns = PatternsSeen(mount, tilt_deg);
  for (PatternSample& pattern : second.vision.patterns) {
    pattern.time += DurationFromSeconds(late_s);
  }
  return all;
}

TEST(DoctorTest, FurtherCameraIsComparedWithFirst) {
  struct Case {
    double turned_deg, late_s, tilt_deg;
    Verdict verdict;
    const char* words;
  };
  for (const Case& given : std::vector<Case>{{0, 0, 15, Verdict::kGood, "at the same time"},
                                             {0, 0.02, 15, Verdict::kGood, "20 ms later"},
                                             {0, 0.06, 15, Verdict::kDoubtful, "60 ms less"},
                                             {0, -0.2, 15, Verdict::kWrong, "200 ms more"},
                                             {5, 0, 15, Verdict::kDoubtful, "calibrate mount"},
                                             {0, 0, 0.1, Verdict::kNotChecked, "too little"}}) {
    const DoctorObservations all = WithSecondCamera(given.turned_deg, given.late_s, given.tilt_deg);
    const std::vector<Finding> findings = Check(all);
    const auto found =
        std::ranges::find(findings, "cam1: beside the first camera", &Finding::check);
    ASSERT_NE(found, findings.end());
    EXPECT_EQ(found->verdict, given.verdict) << found->measured;
    EXPECT_THAT(found->measured + found->advice, HasSubstr(given.words));
  }
}

TEST(DoctorTest, ChecksFurtherCameraByItself) {
  EXPECT_THAT(Flagged(Check(WithSecondCamera(0, 0))), IsEmpty());
  DoctorObservations all = WithSecondCamera(0, 0);
  all.further[0].camera.width_px = 640;
  all.unopened = {"cam2: /dev/video7: there is no such device"};
  EXPECT_THAT(Flagged(Check(all)),
              ElementsAre(HasSubstr("cam1: image size: "), HasSubstr("images: cam2: /dev/video7")));
}

// --- Cases that must not mislead a check ---

TEST(DoctorTest, DoesNotJudgeMountOnStationaryUav) {
  DoctorObservations all = GoodSetup(AutopilotKind::kArduPilot);
  RigidTransform turned = DownwardMount();
  turned.rotation = turned.rotation * Eigen::AngleAxisd(kPi / 2, kAxis);
  for (const RigidTransform& mount : {DownwardMount(), turned}) {
    all.vision.patterns = PatternsSeen(mount, 0);
    const std::vector<Finding> findings = Check(all);
    EXPECT_THAT(Flagged(findings), IsEmpty());
    const auto motion = std::ranges::find(findings, "mount against motion", &Finding::check);
    EXPECT_EQ(motion->verdict, Verdict::kNotChecked);
  }
}

TEST(DoctorTest, AcceptsDarkImageBelowUavOnGround) {
  DoctorObservations all = GoodSetup(AutopilotKind::kPx4);
  all.camera.is_on_ground = true;
  for (ImageQuality& quality : all.camera.qualities) quality.bright_gray = 30;
  const std::vector<Finding> findings = Check(all);
  EXPECT_THAT(Flagged(findings), IsEmpty());
  EXPECT_EQ(std::ranges::find(findings, "exposure", &Finding::check)->verdict,
            Verdict::kNotChecked);
}

// ArduPilot listens to its own system always: the ground station's number is left alone.
TEST(DoctorTest, KeepsGroundStationId) {
  DoctorObservations all = GoodGuidedSetup(AutopilotKind::kArduPilot);
  all.parameters["MAV_OPTIONS"] = {1, "MAV_OPTIONS", 1};
  all.parameters["MAV_GCS_SYSID"] = {255, "MAV_GCS_SYSID", 1};
  EXPECT_THAT(Flagged(Check(all)), IsEmpty());
  all.link.own_system = 42;
  for (const Finding& finding : Check(all)) {
    EXPECT_NE(finding.fix.value_or(ParameterFix()).name, "MAV_GCS_SYSID");
  }
}

TEST(DoctorTest, AcceptsLossTimeoutWithinRange) {
  for (const double s : {0.1, 0.2, 0.3}) {
    DoctorObservations all = GoodGuidedSetup(AutopilotKind::kArduPilot);
    all.parameters["GUID_TIMEOUT"].value = s;
    EXPECT_THAT(Flagged(Check(all)), IsEmpty()) << s;
  }
  for (const double s : {0.1, 0.3, 0.5}) {
    DoctorObservations all = GoodGuidedSetup(AutopilotKind::kPx4);
    all.parameters["COM_OF_LOSS_T"].value = s;
    EXPECT_THAT(Flagged(Check(all)), IsEmpty()) << s;
  }
}

TEST(DoctorTest, MissedImagesAreNoJitter) {
  DoctorObservations all = GoodSetup(AutopilotKind::kPx4);
  auto& frames = all.camera.frames;
  for (std::size_t i = 150; i > 10; i -= 7) frames.erase(frames.begin() + static_cast<long>(i));
  EXPECT_THAT(Flagged(Check(all)), IsEmpty());
}

TEST(DoctorTest, MissingObservationsAreReportedAsWrong) {
  const std::vector<Finding> findings = Check({});
  EXPECT_TRUE(AnyWrong(findings));
  EXPECT_THAT(FindingsTable(findings, false), HasSubstr("not checked yet"));
}

}  // namespace
}  // namespace kestrel
