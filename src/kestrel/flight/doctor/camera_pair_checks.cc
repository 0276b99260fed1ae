// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/doctor/camera_pair_checks.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "kestrel/core/geometry/angles.h"
#include "kestrel/flight/doctor/statistics.h"

namespace kestrel {
namespace {

using Eigen::Vector3d;

constexpr char kAdvice[] =
    "hold the UAV where all cameras see the pattern, and tilt and turn it while doctor runs";

// Returns the pattern's place in the body by a camera; nothing between images far apart.
std::optional<Vector3d> PlaceAt(const CameraSetup& setup, Time time) {
  constexpr Duration kLongest = std::chrono::milliseconds(250);
  const auto& patterns = setup.vision.patterns;
  const auto after = std::ranges::lower_bound(patterns, time, {}, &PatternSample::time);
  if (after == patterns.begin() || after == patterns.end()) return std::nullopt;
  const auto before = after - 1;
  if (after->time - before->time > kLongest) return std::nullopt;
  const double share = ToSeconds(time - before->time) / ToSeconds(after->time - before->time);
  const Vector3d in_camera = (1 - share) * before->camera_from_target.translation +
                             share * after->camera_from_target.translation;
  return *setup.calibration.body_from_camera * in_camera;
}

// The distance between the places at which two cameras show the pattern.
struct Apart {
  std::size_t images = 0;
  Vector3d mean = Vector3d::Zero();  // m, in the body
  double spread_m = 0;               // root mean square distance from the mean
};

// 'late_s': so much later than it claims the further camera's images are stamped.
Apart Compare(const CameraSetup& first, const CameraSetup& further, double late_s) {
  std::vector<Vector3d> offsets;
  Apart apart;
  for (const PatternSample& pattern : further.vision.patterns) {
    const auto place = PlaceAt(first, pattern.time - DurationFromSeconds(late_s));
    if (!place) continue;
    const Vector3d in_body =
        *further.calibration.body_from_camera * pattern.camera_from_target.translation;
    offsets.push_back(in_body - *place);
    apart.mean += offsets.back();
  }
  apart.images = offsets.size();
  if (offsets.empty()) return apart;
  apart.mean /= static_cast<double>(offsets.size());
  for (const Vector3d& offset : offsets) apart.spread_m += (offset - apart.mean).squaredNorm();
  apart.spread_m = std::sqrt(apart.spread_m / static_cast<double>(offsets.size()));
  return apart;
}

// The lag that explains best what the further camera shows.
struct Lag {
  double late_s = 0;
  Apart apart;
  bool is_determined = false;  // another one explains it clearly worse
};

Lag FindLag(const CameraSetup& first, const CameraSetup& further, std::size_t images) {
  constexpr int kSteps = 50;
  constexpr double kStep_s = 0.01;
  constexpr int kClearSteps = 5;  // from the best one
  constexpr double kClear_m = 0.01;
  std::vector<Apart> all;
  for (int i = -kSteps; i <= kSteps; ++i) all.push_back(Compare(first, further, kStep_s * i));
  const auto is_usable = [&](const Apart& apart) { return 2 * apart.images >= images; };
  const auto spread_m = [&](const Apart& apart) {
    return is_usable(apart) ? apart.spread_m : std::numeric_limits<double>::infinity();
  };
  const auto best = std::ranges::min_element(all, {}, spread_m);
  const auto index = static_cast<int>(best - all.begin());
  const auto is_worse = [&](int other) {
    return other >= 0 && other <= 2 * kSteps &&
           spread_m(all[static_cast<std::size_t>(other)]) > spread_m(*best) + kClear_m;
  };
  return {kStep_s * (index - kSteps), *best,
          is_worse(index - kClearSteps) && is_worse(index + kClearSteps)};
}

}  // namespace

Finding CheckCamerasTogether(const CameraSetup& first, const CameraSetup& further) {
  constexpr double kLate_s = 0.03, kTooLate_s = 0.09;  // as the track of several cameras has it
  constexpr double kTurned = Radians(1.6), kDisplaced_m = 0.03;
  constexpr std::size_t kFewest = 10;
  const std::string check = "beside the first camera";
  for (const CameraSetup* setup : {&first, &further}) {
    if (setup->calibration.gimbal) return NotChecked(check, "one of them is on a gimbal");
    if (!setup->calibration.body_from_camera) return NotChecked(check, "one of them has no mount");
  }
  const std::size_t images = Compare(first, further, 0).images;
  if (images < kFewest) {
    return NotChecked(check, fmt::format("both show the pattern in {} images", images), kAdvice);
  }
  const Lag lag = FindLag(first, further, images);
  if (!lag.is_determined) return NotChecked(check, "the UAV moved too little to tell", kAdvice);
  std::vector<double> distances_m;
  for (const PatternSample& pattern : further.vision.patterns) {
    distances_m.push_back(pattern.camera_from_target.translation.norm());
  }
  const double distance_m = MedianOf(std::move(distances_m));
  const double apart_m = lag.apart.mean.norm();
  const double ms = kMilliseconds * std::abs(lag.late_s);
  const std::string measured = fmt::format(
      "{:.0f} cm apart at {:.1f} m, {}", kPercent * apart_m, distance_m,
      lag.late_s == 0 ? "at the same time"
                      : fmt::format("{:.0f} ms {}", ms, lag.late_s > 0 ? "later" : "earlier"));
  if (std::abs(lag.late_s) > kLate_s) {
    Finding finding = Doubtful(
        check, measured + ": they see the same place at different times",
        fmt::format("time_offset_s in its calibration {:.0f} ms {} (kestrel calibrate clock, of "
                    "each camera)",
                    ms, lag.late_s > 0 ? "less" : "more"));
    if (std::abs(lag.late_s) > kTooLate_s) finding.verdict = Verdict::kWrong;
    return finding;
  }
  if (apart_m > kTurned * distance_m + kDisplaced_m) {
    return Doubtful(check, measured,
                    "one of the mounts is wrong: kestrel calibrate mount, of each camera");
  }
  return Good(check, measured);
}

}  // namespace kestrel
