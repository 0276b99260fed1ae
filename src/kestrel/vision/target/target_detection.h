// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/vision/target/calibration_evidence.h"
#include "kestrel/vision/target/seen_print.h"

namespace kestrel {

// Means by which a pad was recognised.
enum class DetectionMethod {
  kRing,      // the ring with a cross
  kPartial,   // a part of the pad, the rest is out of view or hidden
  kTags,      // decoded tags
  kLetter,    // the letter of a helipad
  kFollowed,  // its appearance, at the place where it was expected
  kOther,     // a pad of one's own
};
inline constexpr std::array kDetectionMethods = {
    DetectionMethod::kRing,   DetectionMethod::kPartial,  DetectionMethod::kTags,
    DetectionMethod::kLetter, DetectionMethod::kFollowed, DetectionMethod::kOther,
};
// "ring", "partial", "tags", "letter", "followed", "other"
const char* ToString(DetectionMethod method);

// The stages of a search, in order. A report names the last one that a candidate reached.
enum class LandingStage {
  kBinarize,  // the image has no contrast in the part that was searched
  kAreas,     // no dark area and no arc of an edge that a pad could have
  kRing,      // no candidate has the pad's outline: a circle (ring), a quadrangle (tag)
  kCross,     // an outline, but inside not what belongs there: a cross, a code, a letter
  kMatch,     // outline and inside, but the image does not look like the pad
  kLocate,    // no pose explains the edges
  kFound,
};
inline constexpr int kLandingStageCount = 7;
const char* ToString(LandingStage stage);  // "binarize", "areas", ... "found"

// Prior knowledge about a frame, from a tracker or from the navigation. Everything is optional.
// Without a hint the whole image is searched.
struct TargetHint {
  // Expected centre of the pattern (m), and its standard deviation per axis.
  std::optional<Eigen::Vector3d> center_in_camera;
  double center_sigma_m = 0.5;
  // Expected orientation of the pad, camera_from_target, one of those under which it looks the
  // same, and which pad it is. Both come from the last detection, if that had a heading and an id.
  std::optional<Eigen::Quaterniond> rotation_in_camera;
  std::optional<std::int32_t> id;
  // Height of the camera above the pattern, m.
  std::optional<double> altitude_m;
  // Unit vector away from the ground, in the camera frame. Resolves the mirror pose of a circle and
  // steadies the tilt of a far one.
  std::optional<Eigen::Vector3d> up_in_camera;
  // Angle (rad) above the horizon of 'up_in_camera' from which on nothing is searched; nothing: the
  // whole image is.
  std::optional<double> sky_above_rad;
  // Step at which the search begins: SearchDiagnostics::next_step of the frame before.
  int first_step = 0;
  // Time limit (ms) of this frame where the options set none; 0: no limit.
  double max_search_ms = 0;
};

// A part of a pad that was recognised.
struct SeenPart {
  std::string_view name;           // static text: "ring", "tag"
  std::optional<std::size_t> tag;  // index in TargetShape::tags
  double size_px;                  // the longer side or axis
};

// The parts of one detection. Keeps the first kMost of them.
class SeenParts {
 public:
  static constexpr std::size_t kMost = 16;

  void Add(const SeenPart& part) {
    if (count_ < kMost) parts_[count_++] = part;
  }
  std::span<const SeenPart> all() const { return std::span(parts_).first(count_); }

 private:
  std::array<SeenPart, kMost> parts_{};
  std::size_t count_ = 0;
};

// Fit of a detection to lens and print, for those who examine a calibration.
struct DetectionDiagnostics {
  // Root mean square distance (px) of the edges from where pose and lens predict them, and the
  // largest value that agrees with print and lens as they are described. 0 where the detection used
  // no edges.
  double misfit_px = 0;
  double misfit_bound_px = 0;
  std::optional<SeenPrint> seen;    // where the image shows the print's outlines
  CalibrationEvidence calibration;  // evidence of the edges about the calibration
  // The other pose under which the print looks the same, when the image cannot tell the two apart.
  std::optional<RigidTransform> mirror_camera_from_target;

  // True when lens or print are not as described: pose and lens predict the print elsewhere than
  // the image shows it.
  bool is_misfit() const { return misfit_px > misfit_bound_px; }
};

struct TargetDetection {
  Eigen::Vector2d center_px;          // origin of frame P; may be out of view
  RigidTransform camera_from_target;  // pose of the pad (frame P, see TargetShape) in the camera
  // Covariance of the pose error: rows 0 to 2 translation in the camera frame (m^2), 3 to 5
  // rotation vector in the camera frame (rad^2).
  Eigen::Matrix<double, 6, 6> covariance;
  DetectionMethod method;
  // Probability that this is the pad, 0 to 1 (docs/score.md).
  double quality;
  // Half of the extent in the image of what was seen, longest and across: the axes of the ring.
  double semi_major_px;
  double semi_minor_px;
  std::optional<std::int32_t> id;  // which pad, where pads of this kind differ
  // Number of headings under which the pad looks the same: 4 for the ring with a cross, 2 for an H,
  // 1 where the heading is known, 0 for a disc, which has none.
  int heading_symmetry = 1;
  SeenParts parts;
  DetectionDiagnostics diagnostics;
};

// Counts and times of one search, for those who look into a detector.
struct SearchDiagnostics {
  std::array<std::int32_t, kLandingStageCount> candidates{};  // number that entered each stage
  std::array<std::int64_t, kLandingStageCount> stage_ns{};    // time spent in each stage
  // Step at which the search ran out of time, for the hint of the next frame; 0 when it did not.
  int next_step = 0;
};

struct TargetReport {
  std::optional<TargetDetection> detection;
  LandingStage reached = LandingStage::kBinarize;  // kFound, or where the best candidate fell
  std::string_view reason;                         // why it failed, static text; empty when found
  bool is_another_pad = false;  // a pad of this kind is in view, but it is not this one
  SearchDiagnostics diagnostics;
};

// Returns in words why there is no detection, in those of the kind of pad: "not in view" unless a
// candidate looked like the pad, or there is another pad. 'is_expected': the pad was there just
// before, so that the stage where the best candidate fell is worth saying anyway.
std::string_view MissInWords(const TargetReport& report, bool is_expected = false);

}  // namespace kestrel
