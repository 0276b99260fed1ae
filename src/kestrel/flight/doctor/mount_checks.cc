// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/doctor/mount_checks.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "kestrel/core/geometry/angles.h"
#include "kestrel/flight/doctor/statistics.h"

namespace kestrel {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr std::size_t kFewestPatterns = 10;
// Largest tilt of the pattern (rad) by a turned mount that is compared. It is generous: while the
// UAV tilts, the pattern's tilt is larger than by the right mount.
constexpr double kLevel = 0.6;
constexpr char kShakeAdvice[] =
    "hold the UAV 1 to 3 m above the pattern and tilt it by 20 deg forward, back and to the sides "
    "while doctor runs, or fly over it";

std::vector<const PatternSample*> PosedPatterns(const VisionObservations& vision, double least_px) {
  std::vector<const PatternSample*> posed;
  for (const PatternSample& pattern : vision.patterns) {
    if (pattern.world_from_body && pattern.ring_px >= least_px) posed.push_back(&pattern);
  }
  return posed;
}

// Returns the angle between the pattern's normal and the vertical, rad.
double TiltOf(const RigidTransform& camera_from_target, const Quaterniond& world_from_camera) {
  const Vector3d normal = world_from_camera * (camera_from_target.rotation * Vector3d::UnitZ());
  return std::acos(std::clamp(normal.z(), -1.0, 1.0));
}

// Returns the median tilt; of two poses that look the same the more level one counts.
double MedianTilt(const std::vector<const PatternSample*>& patterns,
                  const Quaterniond& body_from_camera) {
  std::vector<double> tilts;
  for (const PatternSample* pattern : patterns) {
    const Quaterniond world_from_camera = pattern->world_from_body->rotation * body_from_camera;
    double tilt = TiltOf(pattern->camera_from_target, world_from_camera);
    if (pattern->mirror_camera_from_target) {
      tilt = std::min(tilt, TiltOf(*pattern->mirror_camera_from_target, world_from_camera));
    }
    tilts.push_back(tilt);
  }
  return MedianOf(std::move(tilts));
}

// Returns the root mean square distance of the pattern from one place, or from a straight way, m.
double Wandering(const std::vector<const PatternSample*>& patterns,
                 const RigidTransform& body_from_camera, bool target_moves) {
  const auto count = static_cast<double>(patterns.size());
  std::vector<Vector3d> places;
  std::vector<double> times_s;
  Vector3d middle = Vector3d::Zero();
  double middle_s = 0;
  for (const PatternSample* pattern : patterns) {
    places.push_back(*pattern->world_from_body *
                     (body_from_camera * pattern->camera_from_target.translation));
    times_s.push_back(ToSeconds(pattern->time - patterns.front()->time));
    middle += places.back() / count;
    middle_s += times_s.back() / count;
  }
  Vector3d velocity = Vector3d::Zero();  // by least squares
  double spread = 0;
  for (std::size_t i = 0; target_moves && i < places.size(); ++i) {
    velocity += (times_s[i] - middle_s) * (places[i] - middle);
    spread += (times_s[i] - middle_s) * (times_s[i] - middle_s);
  }
  if (spread > 0) velocity /= spread;
  double sum = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    sum += (places[i] - middle - (times_s[i] - middle_s) * velocity).squaredNorm();
  }
  return std::sqrt(sum / count);
}

// All 24 rotations by quarter turns; the first is the identity.
std::vector<Quaterniond> QuarterTurns() {
  constexpr int kQuarters = 4;
  const auto turn = [](int quarters, const Vector3d& axis) {
    return Quaterniond(Eigen::AngleAxisd(0.5 * kPi * quarters, axis));
  };
  std::vector<Quaterniond> turns;
  for (int about_z = 0; about_z < kQuarters; ++about_z) {
    const Quaterniond spin = turn(about_z, Vector3d::UnitZ());
    for (int about_x = 0; about_x < kQuarters; ++about_x) {
      turns.push_back(turn(about_x, Vector3d::UnitX()) * spin);
    }
    turns.push_back(turn(1, Vector3d::UnitY()) * spin);
    turns.push_back(turn(-1, Vector3d::UnitY()) * spin);
  }
  return turns;
}

std::string InWords(const Quaterniond& turn) {
  constexpr double kAlong = 0.99;
  const Eigen::AngleAxisd angle_axis(turn);
  const double degrees = Degrees(angle_axis.angle());
  const Vector3d& axis = angle_axis.axis();
  if (std::abs(axis.z()) > kAlong) {
    const bool is_half = degrees > 179;
    return fmt::format("{:.0f} deg{} about its optical axis{}", degrees,
                       is_half        ? ""
                       : axis.z() > 0 ? " clockwise (seen from behind)"
                                      : " counterclockwise (seen from behind)",
                       is_half ? " (upside down)" : "");
  }
  return fmt::format("{:.0f} deg about ({:.1f}, {:.1f}, {:.1f}) of its axes right, down, ahead",
                     degrees, axis.x(), axis.y(), axis.z());
}

std::string MatrixText(const Quaterniond& rotation) {
  std::string text;
  const Eigen::Matrix3d matrix = rotation.toRotationMatrix();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      text += fmt::format("{}{:.4f}", text.empty() ? "" : ", ", matrix(row, column) + 0.0);
    }
  }
  return text;
}

Finding TooFewPatterns(const std::string& check, std::size_t patterns, double least_px) {
  return NotChecked(check,
                    fmt::format("pattern of {:.0f} px or more, with an attitude, in {} images",
                                least_px, patterns),
                    kShakeAdvice);
}

// Result of another mount.
struct OtherMount {
  Quaterniond turn;
  double wandering_m;
};

// Returns, of the turned mounts by which the pattern lies level, the one that keeps it in place
// best.
std::optional<OtherMount> BestTurned(const std::vector<const PatternSample*>& patterns,
                                     const RigidTransform& body_from_camera, bool target_moves) {
  std::optional<OtherMount> best;
  const std::vector<Quaterniond> turns = QuarterTurns();
  for (std::size_t i = 1; i < turns.size(); ++i) {
    const RigidTransform turned{body_from_camera.rotation * turns[i], body_from_camera.translation};
    if (MedianTilt(patterns, turned.rotation) > kLevel) continue;
    const double wandering_m = Wandering(patterns, turned, target_moves);
    if (!best || wandering_m < best->wandering_m) best = OtherMount{turns[i], wandering_m};
  }
  return best;
}

}  // namespace

Finding CheckMountGiven(const std::optional<RigidTransform>& body_from_camera) {
  constexpr double kSteepest = 60;   // deg from straight down
  constexpr double kSideways = 100;  // deg
  constexpr double kFarthest_m = 3;
  const std::string check = "mount";
  if (!body_from_camera) {
    return Wrong(check, "the calibration has none",
                 "T_BS (4x4, body x ahead, y left, z up, from camera x right, y down, z along its "
                 "axis) in the calibration file; kestrel calibrate mount finds it from a flight");
  }
  const Vector3d axis = body_from_camera->rotation * Vector3d::UnitZ();
  const Vector3d right = body_from_camera->rotation * Vector3d::UnitX();
  const double from_down = Degrees(std::acos(std::clamp(-axis.z(), -1.0, 1.0)));
  const double distance_m = body_from_camera->translation.norm();
  const auto direction = [](const Vector3d& v) {
    return fmt::format("({:.2f}, {:.2f}, {:.2f})", v.x(), v.y(), v.z());
  };
  const std::string measured = fmt::format(
      "looks {:.0f} deg from straight down, the image's right is {} of (ahead, left, up), {:.2f} m "
      "from the middle",
      from_down, direction(right), distance_m);
  const std::string advice =
      "T_BS is body_from_camera: body x ahead, y left, z up; is it the "
      "inverse, or in forward-right-down?";
  if (from_down > kSideways) return Wrong(check, measured, advice);
  if (from_down > kSteepest || distance_m > kFarthest_m) return Doubtful(check, measured, advice);
  return Good(check, measured);
}

Finding CheckMountByGravity(const std::optional<RigidTransform>& body_from_camera,
                            const VisionObservations& vision) {
  constexpr double kLeast_px = 30;
  constexpr double kGood = 10;   // deg
  constexpr double kWrong = 25;  // deg
  const std::string check = "mount against gravity";
  if (!body_from_camera) return NotChecked(check, "no mount");
  const auto patterns = PosedPatterns(vision, kLeast_px);
  if (patterns.size() < kFewestPatterns) return TooFewPatterns(check, patterns.size(), kLeast_px);
  const double tilt = Degrees(MedianTilt(patterns, body_from_camera->rotation));
  const std::string measured =
      fmt::format("by mount and attitude the pattern lies {:.1f} deg from level", tilt);
  const std::string advice =
      "where the pattern lies level the mount is turned or tilted: kestrel calibrate mount, or "
      "measure the angles";
  if (tilt > kWrong) return Wrong(check, measured, advice);
  if (tilt > kGood) return Doubtful(check, measured, advice);
  return Good(check, measured);
}

Finding CheckMountByMotion(const std::optional<RigidTransform>& body_from_camera,
                           const VisionObservations& vision, bool target_moves) {
  constexpr double kLeast_px = 15;
  constexpr double kClear = 0.5;  // largest ratio of the better mount's wandering to the other's
  constexpr double kLeast_m = 0.06;
  constexpr double kCentimetres = 100;
  const std::string check = "mount against motion";
  if (!body_from_camera) return NotChecked(check, "no mount");
  const auto patterns = PosedPatterns(vision, kLeast_px);
  if (patterns.size() < kFewestPatterns) return TooFewPatterns(check, patterns.size(), kLeast_px);
  const double wandering_m = Wandering(patterns, *body_from_camera, target_moves);
  const auto other = BestTurned(patterns, *body_from_camera, target_moves);
  if (!other) {
    return MedianTilt(patterns, body_from_camera->rotation) < kLevel
               ? Good(check, "by no mount turned by quarters the pattern lies level")
               : NotChecked(check, "the pattern does not lie level by any mount", kShakeAdvice);
  }
  const std::string measured =
      fmt::format("the pattern wanders by {:.0f} cm by this mount, by {:.0f} cm by the next best",
                  kCentimetres * wandering_m, kCentimetres * other->wandering_m);
  const double difference_m = wandering_m - other->wandering_m;
  if (difference_m > kLeast_m && other->wandering_m < kClear * wandering_m) {
    return Wrong(
        check, measured,
        fmt::format("the camera (or the compass) is turned by {}; the rotation of T_BS "
                    "would be [{}]",
                    InWords(other->turn), MatrixText(body_from_camera->rotation * other->turn)));
  }
  if (-difference_m > kLeast_m && wandering_m < kClear * other->wandering_m) {
    return Good(check, measured);
  }
  return NotChecked(check, "the UAV moved too little to tell: " + measured, kShakeAdvice);
}

Finding CheckGimbalMount() {
  return NotChecked("mount", "the camera is on a gimbal",
                    "kestrel calibrate mount RECORDING, from a flight over the pattern");
}

std::vector<Finding> CheckMount(const DoctorObservations& observations) {
  if (observations.calibration.gimbal) return {CheckGimbalMount()};
  const auto& mount = observations.calibration.body_from_camera;
  return {CheckMountGiven(mount), CheckMountByGravity(mount, observations.vision),
          CheckMountByMotion(mount, observations.vision, observations.use.target_mps.has_value())};
}

}  // namespace kestrel
