// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "kestrel/vision/landing/landing_pattern_detector.h"
#include "landing_frames.h"

namespace kestrel {

enum class LandingOutcome {
  kFound,   // the pattern is there and was found at its place
  kMissed,  // the pattern is there and was not found
  kWrong,   // something else was detected as the pattern
  kQuiet,   // no pattern, and no detection
};

// The result of a detector on one frame.
struct LandingScore {
  std::string name;
  std::string group;
  PatternTruth truth = PatternTruth::kUnknown;
  LandingOutcome outcome = LandingOutcome::kQuiet;
  double ring_radius_px = 0;
  double altitude_m = 0;
  Eigen::Vector2d detected_px = Eigen::Vector2d::Zero();  // place of the detection
  double quality = 0;                                     // quality of the detection
  double center_error_px = 0;                             // found, kWhole
  double position_error = 0;  // found, pose known: relative to the true distance
  double nees = 0;            // found, pose known: squared position error over covariance
  bool has_mirror = false;    // found, pose known: the mirror pose was reported too,
  bool is_mirrored = false;   // and has the truer tilt
  LandingStage reached{};
  std::string reason;
};

// A right centre is within max(4 px, 0.15 ring radii) of the true one. Of a ring that is cut by the
// border only the part in the image is known: a right pose projects its ring within max(2 px, 0.05
// ring radii), root mean square, of the annotated one there.
LandingScore ScoreLanding(const LandingFrame& frame, const TargetReport& report,
                          const CameraModel& camera, const LandingPattern& pattern);

// Returns the hint that a detector gets about a frame.
using HintOf = TargetHint (*)(const LandingFrame& frame);
TargetHint NoHint(const LandingFrame& frame);
TargetHint AttitudeHint(const LandingFrame& frame);

// Scores the frames 0 ... count - 1 that 'make_frame' makes, on 'threads' threads with one
// workspace each. 'sees' (if any) is called for each frame, by one thread at a time. The results
// are in order.
std::vector<LandingScore> ScoreFrames(
    const LandingPatternDetector& detector, std::size_t count, int threads, HintOf hint,
    const std::function<LandingFrame(std::size_t)>& make_frame,
    const std::function<void(const LandingFrame&, const LandingScore&)>& sees = {});

// Heights of the camera above the pattern by which results are grouped, metres.
struct AltitudeBin {
  double min_m;
  double max_m;
  std::string Name() const;
  bool Contains(double altitude_m) const { return altitude_m >= min_m && altitude_m < max_m; }
};
inline constexpr std::array<AltitudeBin, 5> kAltitudeBins{
    {{0.35, 1}, {1, 2}, {2, 6}, {6, 9}, {9, 14}}};

// Sums up scores.
class LandingTally {
 public:
  LandingTally() = default;
  explicit LandingTally(std::span<const LandingScore> scores);
  void Add(const LandingScore& score);
  void Add(const LandingTally& tally);

  int frames = 0;  // kWhole
  int found = 0;
  int wrong = 0;  // something else found in a frame with the pattern
  int partial = 0;
  int partial_found = 0;  // right or wrong
  int partial_right = 0;
  int negatives = 0;
  int false_detections = 0;  // in negatives
  int with_mirror = 0;       // of those with a known pose
  int mirrored = 0;          // of these: the mirror pose was the right one
  std::vector<double> center_errors_px;
  std::vector<double> position_errors;
  std::vector<double> nees;

  double FoundShare() const { return frames == 0 ? 1 : static_cast<double>(found) / frames; }
};

// Returns the quantile 'p' (0 to 1) of 'values'; 0 without values.
double Quantile(std::vector<double> values, double p);
double Mean(std::span<const double> values);

}  // namespace kestrel
