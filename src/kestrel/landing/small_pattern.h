// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/camera/ray_table.h"
#include "kestrel/geometry/cone.h"
#include "kestrel/geometry/rigid_transform.h"
#include "kestrel/landing/landing_pattern.h"
#include "kestrel/landing/pattern_locator.h"
#include "kestrel/landing/pattern_match.h"

namespace kestrel {

// Memory of SmallPatternFitter, which does not allocate once it is reserved.
struct SmallPatternWorkspace {
  struct Pixel {
    Eigen::Vector3d ray;
    Eigen::Vector3d d_ray_du;  // per pixel
    Eigen::Vector3d d_ray_dv;
    double gray;
  };
  std::vector<Pixel> pixels;
  struct PlanePoint {
    double x, y;
    Eigen::Matrix2d by_pixel;  // d(x, y) / d(u, v), metres per pixel
    double ring = 0;           // darkness of the ring there
    double dark = 0;           // of the whole print
    double expected = 0;       // gray value by the fitted print
    double gray = 0;           // in the image

    double radius() const { return std::sqrt(x * x + y * y); }
  };
  std::vector<PlanePoint> points;  // of the pixels, under one pose
  std::vector<float> magnitudes;   // of the residuals

  void Reserve();
};

// Verifies and locates a pattern whose strokes are no wider than the blur of the image, so that
// their edges cannot be found one by one: fits the blurred print itself to the gray values (direct
// alignment, after Lucas and Kanade 1981). Unknowns are the pose, the blur, and the gray values of
// black and white.
class SmallPatternFitter {
 public:
  // 'camera' must outlive the fitter.
  SmallPatternFitter(const CameraModel& camera, const RayTable& rays,
                     const LandingPattern& pattern);

  // What tells other signs from the print. Darkness is a share of the print's contrast.
  struct OtherSigns {
    double spokes;             // second darkest of the lines between the arms, one a quadrant
    double frame_corners;      // beyond the ends of the arms, against between them
    double cross_correlation;  // of image and print inside of the ring: low for a blot
    double board_darkness;     // around the ring: 0 white, 1 as dark as the ring
  };

  struct Fit {
    PatternLocation location;  // without edges
    PatternMatch match;        // amplitudes of arms, white quadrants and ring instead of shares
    double correlation;        // of the image with the fitted print, -1 to 1
    // Share of the image's variance that the print explains beyond what so many unknowns explain
    // of noise (adjusted R^2): low where few pixels are fitted well, by chance.
    double explained;
    // Residuals (root of their mean square, outliers bounded; share of the contrast) inside of the
    // ring but for the worst quadrant, on the ring, and on the white around it.
    double inside_residual;
    double ring_residual;
    double white_residual;
    OtherSigns others;
  };

  struct Start {
    RigidTransform camera_from_pattern;
    double correlation;  // -1 to 1, of the image with the print blurred by a good lens
  };
  // The size at which ring and white fit the image best: the ring lies as 'ring' in all of them,
  // and is 'scales' times smaller. Nothing when they fit at none. Does not allocate.
  std::optional<double> FindScale(const cv::Mat& image, const CirclePose& ring,
                                  std::span<const double> scales,
                                  SmallPatternWorkspace* workspace) const;

  // The best start for Refine among the directions of an arm (as for PatternPose), of a ring at the
  // scale that FindScale said last. Does not allocate.
  Start FindStart(const CirclePose& ring, double scale, std::span<const double> arm_angles,
                  const SmallPatternWorkspace& workspace) const;

  // The light on a print: even but for a slope, or with the edge of a shadow across it, which is
  // taken out of the image first.
  enum class Light { kEven, kShadowEdge };

  // Refines 'initial', which must be within about a stroke's width. Nothing when the image shows
  // too little of the print, the fit does not converge or the light has no edge. Does not allocate.
  std::optional<Fit> Refine(const cv::Mat& image, const RigidTransform& initial, Light light,
                            int iterations, SmallPatternWorkspace* workspace,
                            const std::optional<NormalPrior>& prior = {}) const;

  // What there is of other signs in a print that was located in another way; nothing when the image
  // shows too little of it or the light has no edge. Does not allocate.
  std::optional<OtherSigns> Inspect(const cv::Mat& image, const RigidTransform& pose, Light light,
                                    SmallPatternWorkspace* workspace) const;

 private:
  struct Darkness;
  struct ShadowEdge;
  struct State;
  struct System;
  bool Gather(const cv::Mat& image, const RigidTransform& pose, int enough_pixels,
              SmallPatternWorkspace* workspace) const;
  Darkness Evaluate(double x, double y, const Eigen::Matrix2d& d_plane, double blur_px) const;
  double CorrelateRing(const RigidTransform& unturned, SmallPatternWorkspace* workspace) const;
  double CorrelatePrint(double angle, const SmallPatternWorkspace& workspace) const;
  double ArmDarkness(double along, double across, double blur_along, double blur_across) const;
  void Predict(const State& state, SmallPatternWorkspace* workspace) const;
  void MeasureLevels(const SmallPatternWorkspace& workspace, State* state) const;
  std::optional<ShadowEdge> FitShadowEdge(const State& state,
                                          const SmallPatternWorkspace& workspace) const;
  bool EvenOut(SmallPatternWorkspace* workspace, State* state) const;
  System Linearize(const State& state, double limit, SmallPatternWorkspace* workspace) const;
  bool Improve(const System& system, const std::optional<NormalPrior>& prior, State* state) const;
  void MeasureParts(const SmallPatternWorkspace& workspace, const State& state,
                    PatternMatch* match) const;
  OtherSigns MeasureOthers(const cv::Mat& image, const State& state,
                           SmallPatternWorkspace* workspace) const;
  double OtherSpokes(const SmallPatternWorkspace& workspace, const State& state) const;
  double FrameCorners(const SmallPatternWorkspace& workspace, const State& state) const;
  double CrossCorrelation(const SmallPatternWorkspace& workspace) const;
  double BoardDarkness(const cv::Mat& image, const State& state) const;

  const CameraModel& camera_;
  const RayTable& rays_;
  LandingPattern pattern_;
  double extent_m_;        // radius of what is fitted
  double board_radius_m_;  // of a circle on the board, beyond that
};

}  // namespace kestrel
