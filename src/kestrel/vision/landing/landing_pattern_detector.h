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
#include "kestrel/vision/landing/calibration_evidence.h"
#include "kestrel/vision/landing/landing_pattern.h"
#include "kestrel/vision/landing/seen_print.h"

namespace kestrel {

// How the cross was verified, by the size of the ring in the image (paper, section 2.4).
enum class CrossMethod { kQuadrants, kThinning, kLines, kPartial };
const char* ToString(CrossMethod method);  // "quadrants", "thinning", "lines", "partial"

// The stage at which the best candidate of a frame fell.
enum class LandingStage {
  kBinarize,  // the image has no contrast, or none where the hint points
  kAreas,     // no dark area or arc of an edge that a ring could have
  kRing,      // no candidate's border lies on the image of a circle
  kCross,     // a ring, but no cross inside
  kMatch,     // ring and cross, but the image does not look like the pattern
  kLocate,    // no pose explains the edges
  kFound,
};
inline constexpr int kLandingStageCount = 7;
const char* ToString(LandingStage stage);  // "binarize", "areas", ... "found"

// What is known before a frame is looked at, from a tracker or from the navigation. Everything is
// optional; without any of it the whole image is searched.
struct LandingHint {
  // Where the centre of the pattern should be, and the standard deviation of that per axis.
  std::optional<Eigen::Vector3d> center_in_camera;
  double center_sigma_m = 0.5;
  // Height of the camera above the pattern.
  std::optional<double> altitude_m;
  // Unit vector away from the ground, in the camera frame: resolves the mirror pose of a circle and
  // helps with the tilt of a far one.
  std::optional<Eigen::Vector3d> up_in_camera;
  // Where the search of this frame begins: LandingReport::next_step of the frame before.
  int first_step = 0;
  // Time (ms) that this frame may take where the options say none; 0: any.
  double max_search_ms = 0;
};

struct LandingDetection {
  Eigen::Vector2d center_px;           // where the arms meet; may lie outside of the image
  RigidTransform camera_from_pattern;  // pose of the pattern (frame P) in the camera
  // Of the pose error: rows 0 to 2 translation in the camera frame (m^2), 3 to 5 rotation vector in
  // the camera frame (rad^2).
  Eigen::Matrix<double, 6, 6> covariance;
  CrossMethod method;
  // Probability that this is the pattern, 0 to 1, by what speaks against it (docs/score.md).
  double quality;
  double ring_semi_major_px;
  double ring_semi_minor_px;
  // How far the edges are from where pose and lens have them, root mean square, pixels; and the
  // most that it should be, where print and lens are as they are said to be. 0 where there were no
  // edges to use.
  double misfit_px = 0;
  double misfit_bound_px = 0;
  std::optional<SeenPrint> seen;    // where the edges are
  CalibrationEvidence calibration;  // what they say of it
  // The other pose under which the ring looks the same, when the image cannot tell the two apart.
  std::optional<RigidTransform> mirror_camera_from_pattern;

  // Lens or print are not what they are said to be: pose and lens do not show the print where it
  // is.
  bool is_misfit() const { return misfit_px > misfit_bound_px; }
};

struct LandingReport {
  std::optional<LandingDetection> detection;
  LandingStage reached = LandingStage::kBinarize;  // kFound, or where the best candidate fell
  std::string_view reason;                         // why it fell, static text; empty when found
  std::array<std::int32_t, kLandingStageCount> candidates{};  // how many entered each stage
  std::array<std::int64_t, kLandingStageCount> stage_ns{};    // time spent in each stage
  // Where the search was given up for want of time, for the hint of the next frame; 0: it was not.
  int next_step = 0;
};

struct LandingPatternDetectorOptions {
  LandingPattern pattern;
  // Smallest minor axis (diameter) of a ring that is searched for, in pixels; smaller is slower and
  // raises the danger of look-alikes.
  double min_ring_px = 6;
  // Smallest quality that is accepted, 0 to 1: the probability that it is the pattern.
  double min_quality = 0.7;
  // How far from level the pattern may lie, standard deviation per axis: of a far one the image
  // hardly tells the tilt, on which its distance hangs. Used where the hint says what is up; larger
  // for a deck that rolls, smaller for a floor.
  double level_sigma_deg = 3;
  // Height of the camera (m) up to which a partial pattern is searched for, when it is known.
  double max_partial_altitude_m = 2.5;
  // Time (ms) after which the search of a frame is given up, to be continued in the next one; 0: as
  // the hint says.
  double max_search_ms = 0;

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor.Group("pattern", self.pattern);
    visitor("min_ring_px", self.min_ring_px, "px", "smallest minor axis of a ring searched for");
    visitor("min_quality", self.min_quality, "1",
            "smallest probability of the pattern that is accepted, 0 to 1");
    visitor("level_sigma_deg", self.level_sigma_deg, "deg",
            "how far from level the pattern may lie, standard deviation");
    visitor("max_partial_altitude_m", self.max_partial_altitude_m, "m",
            "height up to which a pattern that is cut off by the image border is searched for");
    visitor("max_search_ms", self.max_search_ms, "ms",
            "time after which a search goes on in the next frame; 0: no limit, in flight what "
            "the camera's period leaves");
  }
  std::vector<std::string> Validate() const;
};

// The memory of one thread's detections: everything grows in the first frames and is kept.
class LandingWorkspace {
 public:
  LandingWorkspace();
  ~LandingWorkspace();
  LandingWorkspace(LandingWorkspace&&) noexcept;
  LandingWorkspace& operator=(LandingWorkspace&&) noexcept;

  struct Buffers;  // of the search

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

  // 'image': CV_8UC1 of the camera's size (anything else is a programming error: the report says
  // kBinarize and why). Thread-safe as long as each thread has its own workspace; does not throw,
  // and does not allocate once the workspace has warmed up.
  LandingReport Detect(const cv::Mat& image, const LandingHint& hint,
                       LandingWorkspace& workspace) const;

  const CameraModel& camera() const;
  const LandingPatternDetectorOptions& options() const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace kestrel
