// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/core/camera/ray_table.h"
#include "kestrel/core/geometry/cone.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/vision/landing/landing_pattern.h"
#include "kestrel/vision/landing/pattern_locator.h"
#include "kestrel/vision/landing/pattern_match.h"

namespace kestrel {

// Memory of SmallPatternFitter, which does not allocate. Columns of one value a pixel of the print,
// so that many are computed at once.
struct SmallPatternWorkspace {
  static constexpr std::size_t kUnknowns = 11;
  using Column = std::vector<float>;

  struct Pixels {
    std::array<Column, 3> ray;       // unit vector
    std::array<Column, 3> ray_by_u;  // its change over a pixel
    std::array<Column, 3> ray_by_v;
    Column gray;
  };
  struct Points {
    Column x, y;                            // where the ray meets the plane of a pose, m
    Column x_by_u, x_by_v, y_by_u, y_by_v;  // m per pixel
    Column dark;                            // 0 white to 1 black
    Column ring, arm_x, arm_y;              // the same of parts
    Column dark_by_x, dark_by_y;            // per metre
    Column dark_by_log_blur;
    Column expected;     // gray value by the print
    Column seen;         // in the image, without highlights and as expected where it is cut off
    Column residual;     // of the image, highlights in it
    Column weight;       // of that, 0 to 1
    Column root_weight;  // root of that, 0 where the image is cut off
  };

  // The pixels of the box around a print, in rows: every 'stride'-th of every such row.
  struct Patch {
    int left = 0, top = 0;  // of its first pixel in the image
    int stride = 1;
    int width = 0, height = 0;
    std::vector<std::uint8_t> is_print;  // whether a pixel is one of the print's
    Column gray;
    Column print;  // the same in even light, white 1
    Column dilated;

    std::size_t IndexOf(float x, float y) const {
      const auto column = static_cast<std::size_t>((static_cast<int>(x) - left) / stride);
      const auto row = static_cast<std::size_t>((static_cast<int>(y) - top) / stride);
      return row * static_cast<std::size_t>(width) + column;
    }
  };

  std::size_t count = 0;  // of the pixels
  Pixels pixels;
  Points points;
  Patch patch;
  Column light;  // on the pixels
  std::array<Column, kUnknowns + 1>
      jacobian;       // and the residual, both times the root of the weight
  Column u, v;        // of the pixels that are gathered
  Column magnitudes;  // of the residuals

  SmallPatternWorkspace();
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

  struct Fit {
    PatternLocation location;  // without edges
    PatternMatch match;        // amplitudes of arms, white quadrants and ring instead of shares
    // Of the image with the fitted print, noise left aside; 0 to 1.
    double correlation;
    // Share of the image's variance that the print explains beyond what so many unknowns explain
    // of noise (adjusted R^2): low where few pixels are fitted well, by chance.
    double explained;
    // Residuals (root of their mean square, outliers bounded; share of the contrast) inside of the
    // ring but for the worst quadrant, and on the ring.
    double inside_residual;
    double ring_residual;
    double frame_corners;      // darkness beyond the ends of the arms, against between them
    double cross_correlation;  // of image and print inside of the ring, noise left aside: low for
                               // a blot
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
                  SmallPatternWorkspace* workspace) const;

  // The light on a print: even but for a slope, or with shadows on it, which are taken out of the
  // image first.
  enum class Light { kEven, kShadows };

  // Refines 'initial', which must be within about a stroke's width. Nothing when the image shows
  // too little of the print, the fit does not converge or there are no shadows. Does not allocate.
  std::optional<Fit> Refine(const cv::Mat& image, const RigidTransform& initial, Light light,
                            int iterations, SmallPatternWorkspace* workspace,
                            const std::optional<NormalPrior>& prior = {}) const;

 private:
  struct State;
  struct System;
  bool Gather(const cv::Mat& image, const RigidTransform& pose, int enough_pixels,
              SmallPatternWorkspace* workspace) const;
  void Predict(const RigidTransform& pose, double blur_px, SmallPatternWorkspace* workspace) const;
  void MeasureLevels(const SmallPatternWorkspace& workspace, State* state) const;
  void MeasureLight(const State& state, SmallPatternWorkspace* workspace) const;
  bool EvenOut(SmallPatternWorkspace* workspace, State* state) const;
  System Linearize(const State& state, double limit, SmallPatternWorkspace* workspace) const;
  bool Improve(const System& system, const std::optional<NormalPrior>& prior,
               const SmallPatternWorkspace& workspace, double limit, State* state) const;
  void MeasureParts(const SmallPatternWorkspace& workspace, const State& state,
                    PatternMatch* match) const;
  double FrameCorners(const SmallPatternWorkspace& workspace, const State& state) const;
  double CrossCorrelation(const SmallPatternWorkspace& workspace, const State& state) const;
  const CameraModel& camera_;
  const RayTable& rays_;
  LandingPattern pattern_;
  double extent_m_;  // radius of what is fitted
};

}  // namespace kestrel
