// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/labelled_images/landing_stills.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/options.h"
#include "kestrel/core/base/random.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/simulation/labelled_images/random_scene.h"
#include "kestrel/simulation/rendering/pattern_visibility.h"
#include "kestrel/simulation/scene/direction.h"
#include "kestrel/simulation/scene/landing_drawings.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kMaxTries = 2000;

Vector3d OnPlane(const Vector2d& point) { return {point.x(), point.y(), 0}; }

Vector3d UpInCamera(const RigidTransform& camera_from_target) {
  return camera_from_target.rotation * Vector3d::UnitZ();
}

struct ImageExtent {
  double major_px;
  double minor_px;
};

// Returns the largest and smallest width of the image of a circle on the plane; nothing when the
// camera model does not cover all of it.
std::optional<ImageExtent> ExtentOfCircle(const CameraModel& camera,
                                          const RigidTransform& camera_from_target,
                                          const Vector2d& center, double radius) {
  constexpr int kPoints = 90;
  std::vector<Vector2d> pixels(kPoints);
  for (int i = 0; i < kPoints; ++i) {
    const double angle = 2 * kPi * i / kPoints;
    const Vector2d point = center + radius * Vector2d(std::cos(angle), std::sin(angle));
    if (camera.Project(camera_from_target * OnPlane(point), &pixels[i]) ==
        ProjectionStatus::kOutsideModel) {
      return std::nullopt;
    }
  }
  ImageExtent extent{0, std::numeric_limits<double>::infinity()};
  for (int i = 0; i < kPoints; ++i) {
    const Vector2d direction(std::cos(kPi * i / kPoints), std::sin(kPi * i / kPoints));
    const auto [low, high] = std::minmax_element(
        pixels.begin(), pixels.end(), [&direction](const Vector2d& a, const Vector2d& b) {
          return direction.dot(a) < direction.dot(b);
        });
    const double width = direction.dot(*high - *low);
    extent.major_px = std::max(extent.major_px, width);
    extent.minor_px = std::min(extent.minor_px, width);
  }
  return extent;
}

Vector2d RandomPixel(const CameraModel& camera, double margin_px, Random* random) {
  return {random->Uniform(-margin_px, camera.width_px() - 1 + margin_px),
          random->Uniform(-margin_px, camera.height_px() - 1 + margin_px)};
}

// Returns a random tilt and yaw at 'altitude_m', with the plane's origin somewhere in view or up to
// 'margin_px' beside it. Nothing when the chosen pixel does not see the plane.
std::optional<RigidTransform> RandomPose(const CameraModel& camera, double altitude_m,
                                         double max_tilt_deg, double margin_px, Random* random) {
  const double tilt = Radians(random->Uniform(0, max_tilt_deg));
  const Vector2d tilt_axis = RandomDirection(random);
  const double yaw = random->Uniform(0, 2 * kPi);
  // Level means that the camera looks straight down: half a turn about x.
  const Eigen::Quaterniond rotation = Eigen::AngleAxisd(tilt, OnPlane(tilt_axis)) *
                                      Eigen::AngleAxisd(kPi, Vector3d::UnitX()) *
                                      Eigen::AngleAxisd(yaw, Vector3d::UnitZ());
  Vector3d ray;
  if (camera.Unproject(RandomPixel(camera, margin_px, random), &ray) ==
      ProjectionStatus::kOutsideModel) {
    return std::nullopt;
  }
  const double fall = -ray.dot(rotation * Vector3d::UnitZ());
  constexpr double kFlattestView = 0.05;  // sine of the angle to the plane
  if (fall < kFlattestView) return std::nullopt;
  return RigidTransform{rotation, ray * (altitude_m / fall)};
}

// Returns a point of the plane that the camera sees or that lies up to 'margin_px' beside its
// image, or nothing.
std::optional<Vector2d> RandomPlacePoint(const CameraModel& camera,
                                         const RigidTransform& camera_from_target, double margin_px,
                                         Random* random) {
  Vector3d ray;
  if (camera.Unproject(RandomPixel(camera, margin_px, random), &ray) ==
      ProjectionStatus::kOutsideModel) {
    return std::nullopt;
  }
  const RigidTransform pattern_from_camera = camera_from_target.Inverse();
  const Vector3d direction = pattern_from_camera.rotation * ray;
  if (direction.z() > -0.05) return std::nullopt;
  const Vector3d& camera_in_pattern = pattern_from_camera.translation;
  const double range = -camera_in_pattern.z() / direction.z();
  return Vector2d((camera_in_pattern + range * direction).head<2>());
}

LensOptions LensOf(const LandingStillOptions& options, bool legs) {
  LensOptions lens;
  lens.half_angle_deg = options.lens_half_angle_deg;
  if (legs) lens.airframe = LandingLegs(options.camera, /*four=*/false);
  return lens;
}

// Adds, in every second image, a motion across the view of up to two pixels, less for small
// patterns.
void AddRandomMotion(const CameraModel& camera, const RigidTransform& camera_from_target,
                     double size_px, Random* random, ImagingOptions* imaging) {
  if (!random->Chance(0.5)) return;
  const double range = camera_from_target.translation.norm();
  const double motion_px = random->Uniform(0, std::min(2.0, 0.06 * size_px));
  const double angle = motion_px / camera.intrinsics().fx_px;
  const Vector3d ray = camera_from_target.translation / range;
  const Vector3d across = ray.unitOrthogonal();
  const double direction = random->Uniform(0, 2 * kPi);
  const Vector3d motion = std::cos(direction) * across + std::sin(direction) * ray.cross(across);
  imaging->velocity_in_camera = motion * (range * angle / imaging->exposure_s);
}

// Adds a motion across the view during the read-out: it shifts the image by 'skew' px per row.
void AddRollingShutter(const CameraModel& camera, const RigidTransform& camera_from_target,
                       double skew, Random* random, ImagingOptions* imaging) {
  if (skew == 0) return;
  imaging->readout_s = 0.033;
  imaging->exposure_s = 0.001;  // causes hardly any blur
  const double range = camera_from_target.translation.norm();
  const double rate = skew * camera.height_px() / imaging->readout_s / camera.intrinsics().fx_px;
  const Vector3d ray = camera_from_target.translation / range;
  const Vector3d across = ray.unitOrthogonal();
  const double direction = random->Uniform(0, 2 * kPi);
  imaging->velocity_in_camera =
      range * rate * (std::cos(direction) * across + std::sin(direction) * ray.cross(across));
}

// Returns the pixel of the print's middle: on the sheet's relief, at its row's time.
Vector2d CenterPx(const CameraModel& camera, const RigidTransform& camera_from_target,
                  const Relief& relief, const ImagingOptions& imaging) {
  const Vector3d center(0, 0, relief.HeightAt({0, 0}));
  Vector2d pixel(0, 0.5 * (camera.height_px() - 1));
  constexpr int kSteps = 5;
  for (int i = 0; i < kSteps; ++i) {
    const double time = RowTime(imaging, pixel.y(), camera.height_px());
    camera.Project(PoseAt(camera_from_target, imaging, time) * center, &pixel);
  }
  return pixel;
}

struct LookalikePlace {
  Vector2d center;
  double radius;
  double minor_px;  // smallest diameter of its circle's image
};

// Returns the part of a circle that is in view.
double SeenShare(const Vector2d& center, double radius, const Lens& lens,
                 const RigidTransform& camera_from_target) {
  constexpr int kPoints = 24;
  int seen = 0;
  for (int i = 0; i < kPoints; ++i) {
    const double angle = 2 * kPi * i / kPoints;
    const Vector2d point = center + radius * Vector2d(std::cos(angle), std::sin(angle));
    seen += lens.Sees(camera_from_target * OnPlane(point));
  }
  return static_cast<double>(seen) / kPoints;
}

// Returns a place where the eye can distinguish a look-alike from the pattern and where it covers
// no other one, or nothing when the chosen place is not good.
std::optional<LookalikePlace> RandomPlace(const LandingStillOptions& options,
                                          const SceneRenderer& renderer,
                                          const RigidTransform& camera_from_target,
                                          const std::vector<LookalikePlace>& taken,
                                          Random* random) {
  const double radius = 0.15 * std::pow(8, random->Uniform());  // 0.15 to 1.2 m
  const CameraModel& camera = renderer.camera();
  const bool whole = options.min_lookalike_visible == 1;
  const double margin_px = whole ? 0 : 0.2 * camera.height_px();
  const auto center = RandomPlacePoint(camera, camera_from_target, margin_px, random);
  if (!center) return std::nullopt;
  const auto overlaps = [&](const LookalikePlace& other) {
    return (*center - other.center).norm() < 2.2 * (radius + other.radius);
  };
  if (std::any_of(taken.begin(), taken.end(), overlaps)) return std::nullopt;
  const double seen = SeenShare(*center, 1.1 * radius, renderer.lens(), camera_from_target);
  if (whole ? seen < 1 : seen == 1 || seen < options.min_lookalike_visible) return std::nullopt;
  const auto extent = ExtentOfCircle(camera, camera_from_target, *center, radius);
  if (!extent || extent->major_px < options.min_lookalike_major_px ||
      extent->minor_px < options.min_lookalike_minor_px ||
      extent->minor_px > options.max_lookalike_minor_px) {
    return std::nullopt;
  }
  return LookalikePlace{*center, radius, extent->minor_px};
}

std::vector<LookalikePlace> RandomPlaces(const LandingStillOptions& options,
                                         const SceneRenderer& renderer,
                                         const RigidTransform& camera_from_target, int wanted,
                                         Random* random) {
  constexpr int kTriesPerPose = 40;
  std::vector<LookalikePlace> places;
  for (int i = 0; i < kTriesPerPose && std::ssize(places) < wanted; ++i) {
    const auto place = RandomPlace(options, renderer, camera_from_target, places, random);
    if (place) places.push_back(*place);
  }
  return places;
}

const LandingStillOptions& Valid(const LandingStillOptions& options) {
  RequireValid(options);
  return options;
}

// Returns the truth of a still for a pose, or nothing when it shows too little of the pattern.
std::optional<LandingStill> TruthOf(const LandingStillOptions& options,
                                    const SceneRenderer& renderer, const LandingPattern& pattern,
                                    const RigidTransform& camera_from_target) {
  const CameraModel& camera = renderer.camera();
  const auto ring = ExtentOfCircle(camera, camera_from_target, {0, 0}, pattern.outer_radius_m());
  if (!ring || ring->major_px < options.min_ring_major_px ||
      ring->minor_px < options.min_ring_minor_px) {
    return std::nullopt;
  }
  Vector2d center_px;
  if (camera.Project(camera_from_target.translation, &center_px) ==
      ProjectionStatus::kOutsideModel) {
    return std::nullopt;
  }
  const double visible_fraction =
      VisibleFraction(PrintOf(pattern), camera_from_target, renderer.lens());
  if (visible_fraction < options.min_visible_fraction ||
      visible_fraction > options.max_visible_fraction) {
    return std::nullopt;
  }
  return LandingStill{.image = {},
                      .pattern = pattern,
                      .camera_from_target = camera_from_target,
                      .center_px = center_px,
                      .altitude_m = camera_from_target.Inverse().translation.z(),
                      .up_in_camera = UpInCamera(camera_from_target),
                      .visible_fraction = visible_fraction,
                      .ring_major_px = ring->major_px,
                      .ring_minor_px = ring->minor_px};
}

// Returns the pattern with a random length of the arms, as it varies between boards.
LandingPattern RandomPattern(const LandingPattern& nominal, Random* random) {
  LandingPattern pattern = nominal;
  const double change = nominal.outer_diameter_m * random->Uniform(-0.02, 0.04);
  pattern.arm_half_length_m =
      std::min(nominal.arm_half_length_m + change, nominal.outer_radius_m());
  return pattern;
}

LandingStill RandomTruth(const LandingStillOptions& options, const SceneRenderer& renderer,
                         Random* random) {
  const double altitude = random->Uniform(options.min_altitude_m, options.max_altitude_m);
  const LandingPattern pattern = RandomPattern(options.pattern, random);
  const CameraModel& camera = renderer.camera();
  // The pattern's middle may lie outside of the image while a part of the pattern is in view.
  const double margin_px = std::min(
      0.4 * camera.height_px(), camera.intrinsics().fx_px * pattern.outer_radius_m() / altitude);
  for (int i = 0; i < kMaxTries; ++i) {
    const auto pose = RandomPose(camera, altitude, options.max_tilt_deg, margin_px, random);
    if (!pose) continue;
    const auto still = TruthOf(options, renderer, pattern, *pose);
    if (still) return *still;
  }
  throw InputError(
      fmt::format("no pose at an altitude of {:.2f} m shows a ring of {} x {} px and {} of the "
                  "pattern, expected a lower altitude or weaker limits",
                  altitude, options.min_ring_major_px, options.min_ring_minor_px,
                  options.min_visible_fraction));
}

}  // namespace

std::vector<std::string> LandingStillOptions::Validate() const {
  std::vector<std::string> violations = camera.Validate();
  AddViolations("pattern", ViolationsOf(pattern), &violations);
  Require(lens_half_angle_deg, Range{1, 180}, "lens_half_angle_deg", &violations);
  Require(min_altitude_m, MoreThan(0), "min_altitude_m", &violations);
  Require(max_altitude_m, AtLeast(min_altitude_m), "max_altitude_m", &violations);
  Require(max_tilt_deg, Range{0, 80}, "max_tilt_deg", &violations);
  Require(min_visible_fraction, Range{0, 1}, "min_visible_fraction", &violations);
  Require(max_visible_fraction, AtLeast(min_visible_fraction), "max_visible_fraction", &violations);
  Require(min_ring_minor_px, AtLeast(0), "min_ring_minor_px", &violations);
  Require(min_ring_major_px, AtLeast(0), "min_ring_major_px", &violations);
  Require(min_lookalike_minor_px, AtLeast(0), "min_lookalike_minor_px", &violations);
  Require(min_lookalike_visible, Range{0, 1, false}, "min_lookalike_visible", &violations);
  Require(max_lookalike_minor_px, MoreThan(min_lookalike_minor_px), "max_lookalike_minor_px",
          &violations);
  Require(min_lookalike_major_px, AtLeast(min_lookalike_minor_px), "min_lookalike_major_px",
          &violations);
  Require(bulge, Range{-0.2, 0.2}, "bulge", &violations);
  Require(fold, Range{-0.2, 0.2}, "fold", &violations);
  Require(rolling_skew, Range{-0.2, 0.2}, "rolling_skew", &violations);
  Require(wear, Range{0, 1}, "wear", &violations);
  return violations;
}

const char* ToString(StillCondition condition) {
  switch (condition) {
    case StillCondition::kMixed:
      return "mixed";
    case StillCondition::kUavShadow:
      return "shadow of a UAV";
    case StillCondition::kOtherShadow:
      return "other shadows";
    case StillCondition::kHeldOutShadow:
      return "held-out shadows";
    case StillCondition::kGlare:
      return "glare";
    case StillCondition::kDark:
      return "dark";
    case StillCondition::kDust:
      return "dust";
    case StillCondition::kBlur:
      return "blur";
    case StillCondition::kNight:
      return "night";
  }
  return "";
}

LandingStillMaker::LandingStillMaker(const LandingStillOptions& options)
    : options_(Valid(options)),
      camera_(options.camera),
      plain_(camera_, LensOf(options, /*legs=*/false)),
      with_legs_(camera_, LensOf(options, /*legs=*/true)) {}

LandingStill LandingStillMaker::PreparePattern(std::uint64_t seed, View* view) const {
  Random random(seed);
  LandingStill still = RandomTruth(options_, plain_, &random);
  const double radius = still.pattern.outer_radius_m();
  view->scene = RandomGround(&random);
  AddRandomPattern(still.pattern, &random, &view->scene);
  AddRandomWear({0, 0}, radius, options_.wear, &random, &view->scene);
  const StillLight light{.condition = options_.condition,
                         .shadow_caster = options_.shadow_caster,
                         .center = {0, 0},
                         .radius_m = radius,
                         .shadow_reach_m = radius,
                         .height_m = still.altitude_m,
                         .size_px = still.ring_minor_px};
  AddRandomShadows(light, &random, &view->scene);
  AddRandomGlares(light, &random, &view->scene);
  still.has_shadow = !view->scene.shadows.empty();
  still.has_highlight = !view->scene.glares.empty();
  view->imaging = RandomImaging(light, &random);
  AddRandomMotion(camera_, still.camera_from_target, still.ring_minor_px, &random, &view->imaging);
  const double board_m = still.pattern.board_size_m;
  view->scene.relief = {board_m, options_.bulge * board_m, options_.fold * board_m};
  AddRollingShutter(camera_, still.camera_from_target, options_.rolling_skew, &random,
                    &view->imaging);
  still.center_px = CenterPx(camera_, still.camera_from_target, view->scene.relief, view->imaging);

  const double beside_legs =
      VisibleFraction(PrintOf(still.pattern), still.camera_from_target, with_legs_.lens());
  const bool legs = random.Chance(0.3) && beside_legs > 0.9 * still.visible_fraction;
  if (legs) still.visible_fraction = beside_legs;
  view->renderer = legs ? &with_legs_ : &plain_;
  return still;
}

LandingStill LandingStillMaker::PlacePattern(std::uint64_t seed) const {
  View view;
  return PreparePattern(seed, &view);
}

LandingStill LandingStillMaker::MakePattern(std::uint64_t seed) const {
  View view;
  LandingStill still = PreparePattern(seed, &view);
  still.image = view.renderer->Render(view.scene, still.camera_from_target, view.imaging);
  return still;
}

LookalikeStill LandingStillMaker::PlaceLookalikes(std::uint64_t seed) const {
  View view;
  return PrepareLookalikes(seed, &view);
}

LookalikeStill LandingStillMaker::MakeLookalikes(std::uint64_t seed) const {
  View view;
  LookalikeStill still = PrepareLookalikes(seed, &view);
  still.image = view.renderer->Render(view.scene, still.camera_from_target, view.imaging);
  return still;
}

LookalikeStill LandingStillMaker::PrepareLookalikes(std::uint64_t seed, View* view) const {
  Random random(seed);
  view->renderer = random.Chance(0.3) ? &with_legs_ : &plain_;
  const int wanted = random.Integer(1, 5);
  std::vector<LookalikePlace> places;
  LookalikeStill still;
  for (int i = 0; i < kMaxTries && places.empty(); ++i) {
    still.altitude_m = random.Uniform(options_.min_altitude_m, options_.max_altitude_m);
    const auto pose = RandomPose(camera_, still.altitude_m, options_.max_tilt_deg, 0, &random);
    if (!pose) continue;
    still.camera_from_target = *pose;
    places = RandomPlaces(options_, *view->renderer, *pose, wanted, &random);
  }
  if (places.empty()) {
    throw InputError(fmt::format(
        "no look-alike can be seen from {} to {} m, expected a lower altitude or a wider image",
        options_.min_altitude_m, options_.max_altitude_m));
  }
  still.up_in_camera = UpInCamera(still.camera_from_target);
  view->scene = RandomGround(&random);
  for (const LookalikePlace& place : places) {
    still.names.emplace_back(
        AddRandomLookalike(place.center, place.radius, options_.lookalikes, &random, &view->scene));
    AddRandomWear(place.center, place.radius, options_.wear, &random, &view->scene);
  }
  const double size_px = places.front().minor_px;
  const StillLight light{.condition = options_.condition,
                         .shadow_caster = options_.shadow_caster,
                         .center = places.front().center,
                         .radius_m = places.front().radius,
                         .shadow_reach_m = 2,
                         .height_m = still.altitude_m,
                         .size_px = size_px};
  AddRandomShadows(light, &random, &view->scene);
  if (options_.condition == StillCondition::kGlare) AddRandomGlares(light, &random, &view->scene);
  view->imaging = RandomImaging(light, &random);
  AddRandomMotion(camera_, still.camera_from_target, size_px, &random, &view->imaging);
  return still;
}

}  // namespace kestrel
