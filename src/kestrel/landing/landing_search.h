// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <chrono>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/camera/ray_table.h"
#include "kestrel/image/bit_image.h"
#include "kestrel/image/black_top_hat.h"
#include "kestrel/image/border_tracing.h"
#include "kestrel/image/local_threshold.h"
#include "kestrel/landing/cross.h"
#include "kestrel/landing/dark_areas.h"
#include "kestrel/landing/landing_pattern_detector.h"
#include "kestrel/landing/partial_pattern.h"
#include "kestrel/landing/pattern_locator.h"
#include "kestrel/landing/pattern_match.h"
#include "kestrel/landing/pattern_view.h"
#include "kestrel/landing/ring_arcs.h"
#include "kestrel/landing/ring_fit.h"
#include "kestrel/landing/small_pattern.h"

namespace kestrel {

// What the detector computed once for its camera and pattern.
struct LandingModels {
  LandingModels(const CameraModel& camera_model, const LandingPatternDetectorOptions& all_options)
      : camera(camera_model),
        options(all_options),
        rays(camera),
        matcher(options.pattern),
        locator(camera, options.pattern),
        small(camera, rays, options.pattern) {}

  CameraModel camera;
  LandingPatternDetectorOptions options;
  RayTable rays;
  PatternMatcher matcher;
  PatternLocator locator;
  SmallPatternFitter small;
};

// Adds the time of its life to a stage.
class StageTimer {
 public:
  StageTimer(LandingReport* report, LandingStage stage)
      : total_(report->stage_ns[static_cast<int>(stage)]),
        start_(std::chrono::steady_clock::now()) {}
  ~StageTimer() { total_ += (std::chrono::steady_clock::now() - start_).count(); }

 private:
  std::int64_t& total_;
  std::chrono::steady_clock::time_point start_;
};

// An outline that may be the ring, in pixels of the image of its pass.
struct RingCandidate {
  Ellipse outer_edge;
  RingEdge edge = RingEdge::kOuter;  // which edge of the ring was seen
  bool board = false;                // seen was the white board around the ring
  std::size_t border = 0;            // in the tracer of the pass
  double contrast = 0;               // of ring and white, gray values
};

// A ring, seen in one pass or another: pixels at full resolution.
struct RingPlace {
  Eigen::Vector2d center;
  Eigen::Vector2d diameters;
  double reach_px = 0;  // within which its edges were looked for
};

struct LandingWorkspace::Buffers {
  static constexpr std::size_t kPasses = 10;
  static constexpr std::size_t kMaxRays = 48;  // of a border

  int width_px = 0;  // of the images that there is room for
  int height_px = 0;
  TilePyramid pyramid;
  LocalThreshold threshold;
  BlackTopHat top_hat;
  BinaryImage binary;
  BitImage scratch;
  std::array<BorderTracer, kPasses> tracers;  // of each pass
  std::vector<RingCandidate> candidates;
  std::vector<Eigen::Vector3d> rays;
  RingArcsWorkspace arcs;
  CrossLinesWorkspace cross_lines;
  PartialPatternWorkspace partial;
  SmallPatternWorkspace small;
  // Rings of this image that were tested as a whole, those tested by their edges, and those that
  // hold another sign.
  std::vector<RingPlace> tested_small;
  std::vector<RingPlace> tested_large;
  std::vector<RingPlace> other_signs;
};

// The search of one image: runs the stages on candidates and keeps the best.
class LandingSearch {
 public:
  LandingSearch(const LandingModels& models, const cv::Mat& image, const LandingHint& hint,
                LandingWorkspace::Buffers* buffers);

  // Searches the whole image, or what the hint leaves of it.
  LandingReport Run();

 private:
  // One pass over the image at a resolution that suits rings of some sizes.
  struct Pass {
    int image_level;          // the image at 1 / 2^level
    int tile_level;           // tiles of the threshold's box
    double min_ring_px;       // minor axis, full resolution
    double max_ring_px;       // major axis, full resolution
    bool black = false;       // dark is what is black: not what lies in a shadow
    bool top_hat = false;     // dark is what is narrow: not what lies in a shadow beside light
    bool closing = false;     // close gaps of the dark areas first
    bool not_bright = false;  // dark is all that is not bright
    bool narrow = false;      // rings beside narrow strokes of white as well
  };
  static constexpr std::size_t kCoarsePasses = 3;   // whose borders are cut into arcs,
  static constexpr std::size_t kFirstFinePass = 6;  // those before it too
  static constexpr std::size_t kPartialPasses = 2;  // in which the cross of a near pattern is seen
  static const std::array<Pass, LandingWorkspace::Buffers::kPasses> kPasses;

  // A ring with a pose that was looked at: how well the image agrees.
  struct Hypothesis {
    RigidTransform camera_from_pattern;
    CrossMethod method;
    double quality;   // 0 where that was not asked
    double contrast;  // of ring and white, gray values
  };
  struct VerifiedCross {
    Cross cross;
    CrossMethod method;
  };
  // A detection and what of the image it leaves unexplained.
  struct Found {
    LandingDetection detection;
    double edge_rms_px;  // 0 where the print was fitted as a whole
    double gray_rms;     // 0 where edges were used
  };

  void MakeRoom();
  void Binarize(const Pass& pass);
  bool ChooseRegion(double sigma_m);
  void BuildPyramid(int last_level = TilePyramid::kLevels - 1);
  bool TestPrediction();
  void TestPredictedRing(const CirclePose& predicted, const Eigen::Vector2d& predicted_px);
  void SearchRegion();
  double ExpectedRingPx(const Eigen::Vector3d& center) const;
  bool Suits(const Pass& pass) const;
  bool IsPlausible(const CirclePose& ring) const;
  void Trace(std::size_t pass_index);
  void TestAreas(std::size_t pass_index);
  void TestCutAreas(std::size_t pass_index);
  void TestArcs(std::size_t pass_index);
  void TestPartial(std::size_t pass_index);

  void CollectCandidates(std::size_t pass_index);
  bool AddRay(const Eigen::Vector2d& pixel);
  void TestCandidate(const RingCandidate& candidate, std::size_t pass_index);
  std::optional<RingFit> FitToBorder(const RingCandidate& candidate, std::size_t pass_index);
  std::optional<RingFit> FitToOutline(const RingCandidate& candidate, const ImageRegion& region);

  bool StandsOut(const CirclePose& ring) const;
  static int ViewLevel(double diameter_px);
  Eigen::Vector2d DiametersPx(const CirclePose& ring) const;
  bool IsSmall(const Eigen::Vector2d& diameters_px) const;
  void TestRing(const RingFit& ring, const Eigen::Vector2d& diameters_px, double reach_px);
  void TestSmallRing(const RingFit& ring, const Eigen::Vector2d& diameters_px,
                     std::span<const double> scales);
  bool IsTooSmall(const Eigen::Vector2d& diameters_px) const;
  bool TestSmallPose(const CirclePose& pose, const Eigen::Vector2d& diameters_px,
                     std::span<const double> scales);
  std::optional<SmallPatternFitter::Fit> FitInShadows(const RigidTransform& pose,
                                                      const Eigen::Vector2d& diameters_px);
  SmallPatternFitter::Start FindStart(const CirclePose& pose, std::span<const double> scales);
  bool IsSmallPattern(const SmallPatternFitter::Fit& fit,
                      const Eigen::Vector2d& diameters_px) const;
  bool ShowsOtherSign(const RigidTransform& pose, double quality);
  std::optional<RingPlace> PlaceOf(const Eigen::Vector3d& center,
                                   const Eigen::Vector2d& diameters_px) const;
  std::optional<double> ArmAngleByQuadrants(const CirclePose& pose);
  std::array<bool, 2> LevelEnough(const RingFit& ring) const;
  std::optional<VerifiedCross> VerifyCross(const cv::Mat& image, const PatternView& view,
                                           double diameter_px);
  std::optional<Hypothesis> FindCross(const CirclePose& pose, double diameter_px);
  std::optional<Hypothesis> TestPose(const CirclePose& pose, double diameter_px);
  std::optional<RigidTransform> RefineRing(const CirclePose& pose, double reach_px, int iterations);
  std::optional<Hypothesis> TestRefinedPose(const RigidTransform& ring, double diameter_px);
  std::optional<Hypothesis> Compare(const RigidTransform& pose, CrossMethod method,
                                    double diameter_px);
  void Locate(const Hypothesis& hypothesis, const Eigen::Vector2d& diameters_px, double reach_px);
  void Keep(const PatternLocation& location, CrossMethod method, double quality,
            const Eigen::Vector2d& diameters_px);
  bool KeepBetter(const Found& found);
  static bool IsBetter(const Found& a, const Found& b);
  static bool IsBetterMirror(const Found& a, const Found& b);
  void ReportBest();
  void Reach(LandingStage stage, std::string_view reason_if_it_ends_here);

  const LandingModels& models_;
  const cv::Mat& image_;
  const LandingHint& hint_;
  LandingWorkspace::Buffers& buffers_;
  double focal_px_;
  std::optional<NormalPrior> level_;  // where it is known what is up
  cv::Mat searched_;                  // the part of the image that is searched
  cv::Point offset_{0, 0};            // of that part in the image
  double expected_ring_px_ = 0;       // diameter by the hint; 0 when it says nothing
  LandingReport report_;
  std::optional<Found> best_;
  std::optional<Found> mirror_;  // of the best, where it was found too
  bool is_sure_ = false;         // of where the best is
};

}  // namespace kestrel
