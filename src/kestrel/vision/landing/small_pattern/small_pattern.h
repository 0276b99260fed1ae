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
#include "kestrel/vision/landing/alignment/part_shares.h"
#include "kestrel/vision/landing/landing_pattern.h"
#include "kestrel/vision/landing/location/pattern_locator.h"

namespace kestrel {

// Memory of SmallPatternFitter, which does not allocate. Holds one column per quantity with one
// value per pixel of the print, so that vector instructions compute many pixels at once.
struct SmallPatternWorkspace {
  // The unknowns after those of the pose, and the column of the residual after them.
  static constexpr int kLogBlur = kPoseUnknowns;
  static constexpr int kWhite = kLogBlur + 1;
  static constexpr int kContrast = kWhite + 1;
  static constexpr int kSlope = kContrast + 1;  // slope of the light along both axes of the print
  static constexpr int kUnknowns = kSlope + 2;
  static constexpr int kResidual = kUnknowns;
  using Column = std::vector<float>;

  struct Pixels {
    std::array<Column, 3> ray;       // unit vector
    std::array<Column, 3> ray_by_u;  // change of the ray over one pixel
    std::array<Column, 3> ray_by_v;
    Column gray;
  };
  struct Points {
    Column x, y;                            // intersection of the ray with the plane of a pose, m
    Column x_by_u, x_by_v, y_by_u, y_by_v;  // m per pixel
    Column dark;                            // 0 white to 1 black
    Column ring, arm_x, arm_y;              // the same of the parts
    Column dark_by_x, dark_by_y;            // derivatives per metre
    Column dark_by_log_blur;
    Column expected;  // gray value that the print predicts
    Column seen;      // gray value of the image, without highlights; as expected where it saturates
    Column residual;  // residual of the image with highlights
    Column weight;    // weight of the residual, 0 to 1
    Column root_weight;  // root of that; 0 where the image saturates
  };

  // The pixels of a box around a print: every stride-th pixel of every stride-th row.
  struct Patch {
    int left = 0, top = 0;  // first pixel in the image
    int stride = 1;
    int width = 0, height = 0;
    std::vector<std::uint8_t> is_print;  // true for the pixels of the print
    Column gray;
    Column print;  // the print in even light, white 1
    Column dilated;

    std::size_t IndexOf(float x, float y) const {
      const auto column = static_cast<std::size_t>((static_cast<int>(x) - left) / stride);
      const auto row = static_cast<std::size_t>((static_cast<int>(y) - top) / stride);
      return row * static_cast<std::size_t>(width) + column;
    }
  };

  std::size_t count = 0;  // number of pixels
  Pixels pixels;
  Points points;
  Patch patch;
  Column light;  // light on each pixel
  std::array<Column, kUnknowns + 1>
      jacobian;       // derivatives and the residual, all times the root of the weight
  Column u, v;        // positions of the gathered pixels
  Column magnitudes;  // magnitudes of the residuals

  SmallPatternWorkspace();
};

// Verifies and locates a pattern whose strokes are no wider than the blur of the image, so that
// single edges cannot be found. Fits the blurred print itself to the gray values (direct alignment,
// after Lucas and Kanade 1981). Unknowns are the pose, the blur, the gray values of black and
// white, and the slope of the light.
class SmallPatternFitter {
 public:
  // 'camera' must outlive the fitter.
  SmallPatternFitter(const CameraModel& camera, const RayTable& rays,
                     const LandingPattern& pattern);

  struct Fit {
    PatternLocation location;  // without edges
    PartShares shares;         // amplitudes, as shares of the print's contrast
    // Correlation of the image with the fitted print, corrected for noise; 0 to 1.
    double correlation;
    // Share of the image's variance that the print explains beyond what so many unknowns explain of
    // noise (adjusted R^2). Low where few pixels fit well by chance.
    double explained;
    // Residuals inside of the ring, without the worst quadrant, and on the ring (root mean square,
    // outliers bounded; share of the contrast).
    double inside_residual;
    double ring_residual;
    double frame_corners;  // darkness beyond the arms' ends minus that between them, in contrasts
    double cross_correlation;  // inside of the ring, corrected for noise; low for a blot
  };

  struct Start {
    RigidTransform camera_from_target;
    double correlation;  // correlation of image and print under a good lens's blur, -1 to 1
  };
  // Returns the element of 'scales' at which ring and white fit the image best. The ring lies as
  // 'ring', that many times smaller. Nothing when none fits. Does not allocate.
  std::optional<double> FindScale(const cv::Mat& image, const CirclePose& ring,
                                  std::span<const double> scales,
                                  SmallPatternWorkspace* workspace) const;

  // Returns the best start for Refine among the directions of an arm (as in PatternPose), for a
  // ring of the scale that FindScale returned last. Does not allocate.
  Start FindStart(const CirclePose& ring, double scale, std::span<const double> arm_angles,
                  SmallPatternWorkspace* workspace) const;

  // The light on a print: even but for a slope, or with shadows, which are removed from the image
  // first.
  enum class Light { kEven, kShadows };

  // Refines 'initial', which must be right to about a stroke's width. Returns nothing when too
  // little of the print is in view, when the fit does not converge, or, with kShadows, when there
  // are no shadows. Does not allocate.
  std::optional<Fit> Refine(const cv::Mat& image, const RigidTransform& initial, Light light,
                            int iterations, SmallPatternWorkspace* workspace,
                            const std::optional<NormalPrior>& prior = {}) const;

 private:
  static constexpr int kLogBlur = SmallPatternWorkspace::kLogBlur;
  static constexpr int kWhite = SmallPatternWorkspace::kWhite;
  static constexpr int kContrast = SmallPatternWorkspace::kContrast;
  static constexpr int kSlope = SmallPatternWorkspace::kSlope;
  static constexpr int kUnknowns = SmallPatternWorkspace::kUnknowns;

  struct State;
  struct System;
  struct Parts;
  // The first and the last pixel of a box, both within it.
  struct PixelBox {
    int left, top, right, bottom;
  };
  std::optional<PixelBox> BoxAround(const RigidTransform& pose, const cv::Size& image) const;
  bool Gather(const cv::Mat& image, const RigidTransform& pose, int enough_pixels,
              SmallPatternWorkspace* workspace) const;
  void KeepPixelsOfPrint(const cv::Mat& image, const RigidTransform& pose,
                         SmallPatternWorkspace* workspace) const;
  void FindRays(SmallPatternWorkspace* workspace,
                std::array<SmallPatternWorkspace::Column, 3>* columns) const;
  void DifferentiateRays(SmallPatternWorkspace* workspace) const;
  void Predict(const RigidTransform& pose, double blur_px, SmallPatternWorkspace* workspace) const;
  void MeasureLevels(const SmallPatternWorkspace& workspace, State* state) const;
  void MeasureLight(const State& state, SmallPatternWorkspace* workspace) const;
  bool EvenOut(SmallPatternWorkspace* workspace, State* state) const;
  System Linearize(const State& state, double limit, SmallPatternWorkspace* workspace) const;
  bool Improve(const System& system, const std::optional<NormalPrior>& prior,
               const SmallPatternWorkspace& workspace, double limit, State* state) const;
  PartShares MeasureParts(const SmallPatternWorkspace& workspace, const State& state) const;
  Parts SumParts(const SmallPatternWorkspace& workspace, const State& state) const;
  double FrameCorners(const SmallPatternWorkspace& workspace, const State& state) const;
  double CrossCorrelation(const SmallPatternWorkspace& workspace, const State& state) const;
  const CameraModel& camera_;
  const RayTable& rays_;
  LandingPattern pattern_;
  double extent_m_;  // radius of the area that is fitted
};

}  // namespace kestrel
