// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/vision/landing/landing_pattern.h"
#include "kestrel/vision/landing/location/calibration_evidence.h"
#include "kestrel/vision/landing/verification/seen_print.h"

namespace kestrel {

// The method that verified the cross; it depends on the size of the ring (paper, section 2.4).
enum class CrossMethod { kQuadrants, kThinning, kLines, kPartial };
const char* ToString(CrossMethod method);  // "quadrants", "thinning", "lines", "partial"

// The stages of a search, in order. A report names the last one that a candidate reached.
enum class LandingStage {
  kBinarize,  // the image has no contrast in the part that was searched
  kAreas,     // no dark area and no arc of an edge that a ring could have
  kRing,      // no candidate's border lies on the image of a circle
  kCross,     // a ring, but no cross inside
  kMatch,     // ring and cross, but the image does not look like the pattern
  kLocate,    // no pose explains the edges
  kFound,
};
inline constexpr int kLandingStageCount = 7;
const char* ToString(LandingStage stage);  // "binarize", "areas", ... "found"

// Prior knowledge about a frame, from a tracker or from the navigation. Everything is optional.
// Without a hint the whole image is searched.
struct LandingHint {
  // Expected centre of the pattern (m), and its standard deviation per axis.
  std::optional<Eigen::Vector3d> center_in_camera;
  double center_sigma_m = 0.5;
  // Height of the camera above the pattern, m.
  std::optional<double> altitude_m;
  // Unit vector away from the ground, in the camera frame. Resolves the mirror pose of a circle and
  // steadies the tilt of a far one.
  std::optional<Eigen::Vector3d> up_in_camera;
  // Step at which the search begins: LandingReport::next_step of the frame before.
  int first_step = 0;
  // Time limit (ms) of this frame where the options set none; 0: no limit.
  double max_search_ms = 0;
};

struct LandingDetection {
  Eigen::Vector2d center_px;           // where the arms meet; may be out of view
  RigidTransform camera_from_pattern;  // pose of the pattern (frame P) in the camera
  // Covariance of the pose error: rows 0 to 2 translation in the camera frame (m^2), 3 to 5
  // rotation vector in the camera frame (rad^2).
  Eigen::Matrix<double, 6, 6> covariance;
  CrossMethod method;
  // Probability that this is the pattern, 0 to 1 (docs/score.md).
  double quality;
  double ring_semi_major_px;
  double ring_semi_minor_px;
  // Root mean square distance (px) of the edges from where pose and lens predict them, and the
  // largest value that agrees with print and lens as they are described. 0 where the detection used
  // no edges.
  double misfit_px = 0;
  double misfit_bound_px = 0;
  std::optional<SeenPrint> seen;    // where the image shows the print's outlines
  CalibrationEvidence calibration;  // evidence of the edges about the calibration
  // The other pose under which the ring looks the same, when the image cannot tell the two apart.
  std::optional<RigidTransform> mirror_camera_from_pattern;

  // True when lens or print are not as described: pose and lens predict the print elsewhere than
  // the image shows it.
  bool is_misfit() const { return misfit_px > misfit_bound_px; }
};

struct LandingReport {
  std::optional<LandingDetection> detection;
  LandingStage reached = LandingStage::kBinarize;  // kFound, or where the best candidate fell
  std::string_view reason;                         // why it failed, static text; empty when found
  std::array<std::int32_t, kLandingStageCount> candidates{};  // number that entered each stage
  std::array<std::int64_t, kLandingStageCount> stage_ns{};    // time spent in each stage
  // Step at which the search ran out of time, for the hint of the next frame; 0 when it did not.
  int next_step = 0;
};

struct LandingPatternDetectorOptions {
  LandingPattern pattern;
  // Smallest minor axis (diameter) of a ring that is searched for, px. Smaller values are slower
  // and raise the danger of look-alikes.
  double min_ring_px = 6;
  // Smallest accepted quality, 0 to 1: the probability that it is the pattern.
  double min_quality = 0.7;
  // Standard deviation per axis of the pattern's tilt from level. The image hardly shows the tilt
  // of a far pattern, and its distance depends on the tilt. Used where the hint has up_in_camera.
  // Larger for a deck that rolls, smaller for a floor.
  double level_sigma_deg = 3;
  // Height of the camera (m) up to which a partial pattern is searched for, where the height is
  // known.
  double max_partial_altitude_m = 2.5;
  // Time (ms) after which the search of a frame stops, to continue in the next one; 0: the hint's
  // limit.
  double max_search_ms = 0;

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor.Group("pattern", self.pattern);
    visitor("min_ring_px", self.min_ring_px, "px",
            "smallest minor axis of a ring that is searched for");
    visitor("min_quality", self.min_quality, "1",
            "smallest probability of the pattern that is accepted, 0 to 1");
    visitor("level_sigma_deg", self.level_sigma_deg, "deg",
            "tilt of the pattern from level, standard deviation");
    visitor("max_partial_altitude_m", self.max_partial_altitude_m, "m",
            "largest height at which a pattern cut off by the image border is searched for");
    visitor("max_search_ms", self.max_search_ms, "ms",
            "longest search in one frame, which the next frame continues; 0: no limit, in flight "
            "the rest of the camera's period");
  }
  std::vector<std::string> Validate() const;
};

// Memory of one thread's detections. It grows in the first frames and is kept.
class LandingWorkspace {
 public:
  LandingWorkspace();
  ~LandingWorkspace();
  LandingWorkspace(LandingWorkspace&&) noexcept;
  LandingWorkspace& operator=(LandingWorkspace&&) noexcept;

  struct Buffers;  // of LandingSearch

 private:
  friend class LandingPatternDetector;
  std::unique_ptr<Buffers> buffers_;
};

// Finds the landing pattern in one image (paper, sections 2.1 to 2.5).
class LandingPatternDetector {
 public:
  // Throws InputError when the options or the camera are not valid.
  LandingPatternDetector(const CameraModel& camera, const LandingPatternDetectorOptions& options);
  ~LandingPatternDetector();
  LandingPatternDetector(LandingPatternDetector&&) noexcept;
  LandingPatternDetector& operator=(LandingPatternDetector&&) noexcept;

  // Searches one image. 'image': CV_8UC1 of the camera's size (anything else is a programming
  // error: the report says kBinarize and why). Thread-safe as long as each thread has its own
  // workspace. Does not throw, and does not allocate once the workspace has warmed up.
  LandingReport Detect(const cv::Mat& image, const LandingHint& hint,
                       LandingWorkspace& workspace) const;

  const CameraModel& camera() const;
  const LandingPatternDetectorOptions& options() const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace kestrel
