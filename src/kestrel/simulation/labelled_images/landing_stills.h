// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/camera/paper_camera.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/simulation/labelled_images/scene_renderer.h"
#include "kestrel/simulation/scene/landing_drawings.h"
#include "kestrel/vision/landing/landing_pattern.h"

namespace kestrel {

// Condition that makes a still difficult.
enum class StillCondition {
  kMixed,          // a little of everything
  kUavShadow,      // sun, and the shadow of a UAV on the pattern
  kOtherShadow,    // sun, and shadows of trees, masts, people, fences, parts of the vehicle
  kHeldOutShadow,  // sun, and shadows of things in neither of them
  kGlare,          // a low sun, mirrored by a wet or glossy print
  kDark,           // little light and much noise
  kDust,
  kBlur,   // out of focus, or moving
  kNight,  // so little light that the noise is a tenth to a third of the contrast
};
inline constexpr int kStillConditions = 9;
const char* ToString(StillCondition condition);  // "mixed", "shadow of a UAV", ...

struct LandingStillOptions {
  CameraIntrinsics camera = PaperCamera();
  // Radius of the lens circle as an angle to the optical axis, degrees. With PaperCamera(), 85
  // degrees put its rim where the paper's real frames have it.
  double lens_half_angle_deg = 85;
  LandingPattern pattern;  // the arm's half length varies by 0.04 outer radii to both sides
  // Height of the camera above the pattern, m, uniform.
  double min_altitude_m = 2;
  double max_altitude_m = 6;
  // Largest angle between the optical axis and straight down, degrees, 0 to 80.
  double max_tilt_deg = 40;
  // The least part of the pattern (see LandingStill) that a still must show to be scored. A landing
  // leg may hide another tenth of it.
  double min_visible_fraction = 0.25;
  double max_visible_fraction = 1;
  double min_ring_minor_px = 6;
  double min_ring_major_px = 13;
  // Smallest axes of a look-alike's circle in the image: by default those from which the eye can
  // distinguish each of them from the pattern. And the largest minor axis: look-alikes seen from
  // the side.
  double min_lookalike_major_px = 26;
  double min_lookalike_minor_px = 15;
  double max_lookalike_minor_px = 1e9;
  LookalikeSet lookalikes = LookalikeSet::kPlain;
  // At least this part of each look-alike's circle is in view. If it is less than 1, no look-alike
  // is whole.
  double min_lookalike_visible = 1;
  StillCondition condition = StillCondition::kMixed;
  // Index of the caster of shadows among those of the condition; negative: any.
  int shadow_caster = -1;
  // Deviations of the print from a flat, rigid one. Parts of the board's size: height of the middle
  // of a board that bulges (negative: sags), and height of the creases of a folded sheet. Part of
  // the ring's size: its skew by a rolling shutter.
  double bulge = 0;
  double fold = 0;
  double rolling_skew = 0;
  // Amount of dirt and scratches on a print: from 0, none, to 1, the most that the eye can still
  // read through.
  double wear = 0;

  // Returns every violation in words; empty when stills can be made.
  std::vector<std::string> Validate() const;
};

// One rendered image of the landing pattern with its truth.
struct LandingStill {
  cv::Mat image;                      // CV_8UC1
  LandingPattern pattern;             // as drawn
  RigidTransform camera_from_target;  // true pose in the middle of the exposure
  Eigen::Vector2d center_px;          // projection of the pattern's origin; may be outside
  double altitude_m;                  // height of the camera above the pattern's plane
  Eigen::Vector3d up_in_camera;       // unit vector away from the ground
  double visible_fraction;            // visible share of ring and cross, see VisibleFraction
  bool has_shadow = false;  // shadow of the UAV, or the edge of a larger one, on or near the ring
  bool has_highlight = false;  // a mirror image of the sun on or near the ring
  double ring_major_px;        // largest and smallest width of the outer ring's image,
  double ring_minor_px;        // as if the image had no border
};

// One rendered image without the landing pattern.
struct LookalikeStill {
  cv::Mat image;                      // CV_8UC1
  RigidTransform camera_from_target;  // pose of the plane
  double altitude_m;
  Eigen::Vector3d up_in_camera;
  std::vector<std::string> names;  // names of its look-alikes, at least one
};

// Makes random stills: any yaw, tilt and place in the lens circle, random ground, light, shadow,
// glare, haze, wear, blur, motion and noise, each up to the strength that the eye can still see
// through. The same options and seed give the same bytes. Immutable and thread-safe.
class LandingStillMaker {
 public:
  // Throws InputError when the options are not valid.
  explicit LandingStillMaker(const LandingStillOptions& options);

  // Throws InputError when no pose within the options shows enough of the pattern.
  LandingStill MakePattern(std::uint64_t seed) const;

  // Makes a still with one to five look-alikes of random kinds, visible and large as set in the
  // options. Throws InputError when none can be placed.
  LookalikeStill MakeLookalikes(std::uint64_t seed) const;

  // The same without the images, which are left empty: fast.
  LandingStill PlacePattern(std::uint64_t seed) const;
  LookalikeStill PlaceLookalikes(std::uint64_t seed) const;

  const CameraModel& camera() const { return camera_; }
  const LandingStillOptions& options() const { return options_; }

 private:
  // Everything but the pose that an image is rendered from.
  struct View {
    Scene scene;
    ImagingOptions imaging;
    const SceneRenderer* renderer = nullptr;
  };
  LandingStill PreparePattern(std::uint64_t seed, View* view) const;
  LookalikeStill PrepareLookalikes(std::uint64_t seed, View* view) const;

  LandingStillOptions options_;
  CameraModel camera_;
  SceneRenderer plain_;      // nothing in front of the lens
  SceneRenderer with_legs_;  // landing legs at the rim
};

}  // namespace kestrel
