// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/doctor/gimbal_checks.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "kestrel/core/geometry/angles.h"
#include "kestrel/core/geometry/rotation_between.h"
#include "kestrel/core/poses/gimbal_history.h"

namespace kestrel {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr Duration kAhead = std::chrono::milliseconds(300);
constexpr double kCmPerMetre = 100;

// Reads the reports in one frame of the yaw, so much later than they claim, and turned.
struct Reading {
  YawFrame frame;
  double late_s = 0;
  double yaw_rad = 0;
};

double AngleBetween(const Quaterniond& a, const Quaterniond& b) { return a.angularDistance(b); }

// The place of the pattern in the world by each image; only those with pose and attitude.
std::vector<Vector3d> Places(const DoctorObservations& all, const GimbalHistory& reports,
                             const Reading& reading) {
  const GimbalMount& mount = *all.calibration.gimbal;
  std::vector<Vector3d> places;
  for (const PatternSample& pattern : all.vision.patterns) {
    const Time time = pattern.time - mount.clock_offset - DurationFromSeconds(reading.late_s);
    auto attitude = reports.At(time, kAhead);
    if (!pattern.world_from_body || !attitude) continue;
    attitude->yaw_frame = reading.frame;
    attitude->level_from_platform =
        Eigen::AngleAxisd(reading.yaw_rad, Vector3d::UnitZ()) * attitude->level_from_platform;
    const RigidTransform world_from_platform =
        WorldFromPlatform(*pattern.world_from_body, mount.body_from_pivot, *attitude);
    places.push_back(world_from_platform *
                     (mount.platform_from_camera * pattern.camera_from_target.translation));
  }
  return places;
}

// Root mean square distance of the places from their middle, m.
double Spread(const std::vector<Vector3d>& places) {
  Vector3d middle = Vector3d::Zero();
  for (const Vector3d& place : places) middle += place / static_cast<double>(places.size());
  double sum = 0;
  for (const Vector3d& place : places) sum += (place - middle).squaredNorm();
  return std::sqrt(sum / static_cast<double>(places.size()));
}

// Largest angle between the first of some rotations and the others, rad.
template <class RotationOf>
double Swing(const std::vector<GimbalObservation>& reports, const RotationOf& rotation_of) {
  double largest = 0;
  for (const GimbalObservation& report : reports) {
    largest = std::max(largest, AngleBetween(rotation_of(reports.front()), rotation_of(report)));
  }
  return largest;
}

// The attitude against the horizon alone: the shortest rotation that levels it.
Quaterniond TiltOf(const Quaterniond& rotation) {
  return RotationBetween(Vector3d::UnitZ(), rotation.conjugate() * Vector3d::UnitZ());
}

Quaterniond BodyFromPlatform(const GimbalObservation& report) {
  const GimbalAttitude attitude{report.sample.level_from_platform, report.sample.yaw_frame};
  return report.world_from_body.conjugate() *
         WorldFromPlatform({report.world_from_body, Vector3d::Zero()}, {}, attitude).rotation;
}

// Largest speed from one report to the next, rad/s.
double FastestTurn(const std::vector<GimbalObservation>& reports) {
  double fastest = 0;
  for (std::size_t i = 1; i < reports.size(); ++i) {
    const GimbalSample& before = reports[i - 1].sample;
    const GimbalSample& after = reports[i].sample;
    const double seconds = ToSeconds(after.time - before.time);
    if (!(seconds > 0) || before.yaw_frame != after.yaw_frame) continue;
    fastest = std::max(
        fastest, AngleBetween(before.level_from_platform, after.level_from_platform) / seconds);
  }
  return fastest;
}

// Returns the other meanings that a gimbal's reports may have.
std::vector<Reading> OtherReadings(YawFrame frame) {
  constexpr int kLongest = 8, kHalfTurn = 18;  // steps
  constexpr double kStep_s = 0.05, kStep = Radians(10.0);
  std::vector<Reading> readings = {
      {frame == YawFrame::kEarth ? YawFrame::kVehicle : YawFrame::kEarth}};
  for (int i = -kLongest; i <= kLongest; ++i) readings.push_back({frame, kStep_s * i});
  for (int i = 1 - kHalfTurn; i <= kHalfTurn; ++i) readings.push_back({frame, 0, kStep * i});
  return readings;
}

// 'measured': by the reports as they are, and by 'best', the reading that explains the images.
Finding WrongReading(const std::string& check, const std::string& measured, YawFrame frame,
                     const Reading& best) {
  if (best.frame != frame) {
    return Wrong(check,
                 fmt::format("{} with their yaw against {}", measured,
                             best.frame == YawFrame::kEarth ? "north" : "the UAV's heading"),
                 "the flags of its reports name another frame than they have: newer firmware of "
                 "the gimbal, or lock and follow mode changed in it");
  }
  if (best.yaw_rad != 0) {
    return Wrong(
        check,
        fmt::format("{} with their yaw turned by {:.0f} deg", measured, Degrees(best.yaw_rad)),
        "its yaw is zero where it looked when it was powered on: power it on while it "
        "looks ahead; kestrel calibrate mount --both finds an error that stays");
  }
  return Wrong(check,
               fmt::format("{} if the gimbal is {:.2f} s {}", measured, std::abs(best.late_s),
                           best.late_s > 0 ? "behind its reports" : "ahead of its reports"),
               "an echoed set-point, or late stamps: kestrel calibrate mount --both finds the "
               "gimbal's clock; MNT_MODE_OUT 0 of PX4 and servos of ArduPilot echo");
}

}  // namespace

Finding CheckGimbalReports(const LinkObservations& link) {
  constexpr double kLeast_hz = 10;
  const std::string check = "gimbal";
  if (link.listened_s <= 0) return NotChecked(check, "the autopilot was not heard for long enough");
  const int reports = link.gimbal_reports.value_or(0);
  const double rate_hz = reports / link.listened_s;
  if (reports == 0) {
    return Wrong(
        check, "no report came",
        "MNT1_TYPE (ArduPilot), MNT_MODE_OUT 2 and MAV_n_FORWARD 1 on both lines (PX4); is "
        "gimbal.device_id in the camera's file right?");
  }
  const std::string measured = fmt::format("{:.0f} reports/s", rate_hz);
  if (rate_hz >= kLeast_hz) return Good(check, measured);
  return Doubtful(check, measured,
                  "10 or more: between slow reports the attitude of a gimbal that turns is a guess "
                  "(SR2_EXTRA3 or MAV2_EXTRA3 50, ArduPilot)");
}

Finding CheckGimbalMotors(const GimbalObservations& gimbal) {
  constexpr double kFastest = Radians(400.0);  // 1/s
  constexpr double kTilts = Radians(5.0), kRigid = Radians(1.0);
  constexpr std::size_t kFewest = 10;
  const std::string check = "gimbal's motors";
  if (gimbal.reports.size() < kFewest) return NotChecked(check, "too few reports with an attitude");
  const double fastest = FastestTurn(gimbal.reports);
  if (fastest > kFastest) {
    return Wrong(check,
                 fmt::format("the reported attitude jumps by {:.0f} deg/s: it is the set-point",
                             Degrees(fastest)),
                 "a gimbal that reports its own attitude (MNT_MODE_OUT 2, PX4; a MNT1_TYPE other "
                 "than servo, ArduPilot): without it the camera's attitude is not known");
  }
  const double tilts = Swing(gimbal.reports, [](const GimbalObservation& report) {
    return TiltOf(report.world_from_body);
  });
  if (tilts < kTilts) {
    return NotChecked(check, "the UAV tilted too little to tell",
                      "tilt it by 10 deg and more while doctor runs");
  }
  const double moves = Swing(gimbal.reports, BodyFromPlatform);
  const std::string measured = fmt::format("turned by {:.1f} deg while the UAV tilted by {:.0f}",
                                           Degrees(moves), Degrees(tilts));
  if (moves > kRigid) return Good(check, measured);
  return Wrong(check, measured + ": it is locked to the UAV",
               "its power, its lock for transport, its motors; retracted by MNT1_DEFLT_MODE 0?");
}

Finding CheckGimbalByImages(const DoctorObservations& observations) {
  constexpr std::size_t kFewest = 10;
  constexpr double kLeast_m = 0.06, kClear = 0.5;  // as of a fixed mount
  const std::string check = "gimbal against images";
  const char* const advice = "turn UAV and gimbal above the pattern while doctor runs";
  const auto& reports = observations.gimbal.reports;
  if (reports.empty()) return NotChecked(check, "no report with an attitude of the UAV");
  GimbalHistory history(reports.size());
  for (const GimbalObservation& report : reports) history.Add(report.sample);
  const YawFrame frame = reports.front().sample.yaw_frame;
  const std::vector<Vector3d> places = Places(observations, history, {frame});
  if (places.size() < kFewest) {
    return NotChecked(check, fmt::format("the pattern in {} images", places.size()), advice);
  }
  const double spread_m = Spread(places);
  const std::string measured =
      fmt::format("the pattern wanders by {:.0f} cm", kCmPerMetre * spread_m);
  double best_m = spread_m;
  Reading best{frame};
  for (const Reading& other : OtherReadings(frame)) {
    const std::vector<Vector3d> by_other = Places(observations, history, other);
    if (2 * by_other.size() < places.size() || Spread(by_other) >= best_m) continue;
    best_m = Spread(by_other);
    best = other;
  }
  if (spread_m - best_m > kLeast_m && best_m < kClear * spread_m) {
    return WrongReading(
        check, fmt::format("{} by its reports, by {:.0f} cm", measured, kCmPerMetre * best_m),
        frame, best);
  }
  if (spread_m < kLeast_m) return Good(check, measured);
  return Doubtful(check, measured,
                  "kestrel calibrate mount --both, from a flight over the pattern");
}

Finding CheckGimbalControl(const DoctorObservations& observations) {
  const std::string check = "gimbal's control";
  const auto& controller = observations.gimbal.controller;
  if (!controller) {
    return NotChecked(check, "the autopilot has no gimbal manager that reports",
                      "ArduPilot 4.3 or newer with MNT1_TYPE, PX4 with MNT_MODE_IN 4");
  }
  const LinkObservations& link = observations.link;
  const bool is_free = controller->system == 0;
  const bool is_known = controller->system == link.autopilot_system;
  const std::string measured = is_free ? std::string("nobody has it")
                                       : fmt::format("system {} component {} has it",
                                                     controller->system, controller->component);
  if (is_free || is_known || !observations.use.points) return Good(check, measured);
  return Doubtful(check, measured,
                  "release it there: Kestrel takes it when it flies, and leaves it when somebody "
                  "takes it back");
}

Finding CheckGimbalRange(const DoctorObservations& observations) {
  constexpr double kGood = Radians(80.0), kWrong = Radians(55.0);
  const std::string check = "gimbal's range";
  const auto& range = observations.gimbal.range;
  if (!range) return NotChecked(check, "the autopilot does not report it");
  const Vector3d axis =
      observations.calibration.gimbal->platform_from_camera.rotation * Vector3d::UnitZ();
  const double lowest = range->lowest + std::atan2(-axis.z(), axis.x());
  const std::string measured =
      fmt::format("the camera looks {:.0f} deg below the horizon at most", Degrees(lowest));
  const char* const advice =
      "90 for a landing: the pad is below (MNT1_PITCH_MIN -90, ArduPilot, if the gimbal can)";
  if (lowest < kWrong) return Wrong(check, measured, advice);
  if (lowest < kGood) return Doubtful(check, measured, advice);
  return Good(check, measured);
}

std::vector<Finding> CheckGimbal(const DoctorObservations& observations) {
  if (!observations.calibration.gimbal || !observations.link.is_heard) return {};
  return {CheckGimbalReports(observations.link), CheckGimbalMotors(observations.gimbal),
          CheckGimbalByImages(observations), CheckGimbalControl(observations),
          CheckGimbalRange(observations)};
}

}  // namespace kestrel
