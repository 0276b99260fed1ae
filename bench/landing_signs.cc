// SPDX-License-Identifier: BSD-3-Clause
#include "landing_signs.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/camera/paper_camera.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/simulation/scene/direction.h"
#include "kestrel/simulation/scene/landing_drawings.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

const LandingPattern kPattern;
constexpr double kRightAngle = 0.5 * kPi;

Mark OnCircle(double radius_m, double least_share) {
  constexpr int kPoints = 32;
  Mark mark{{}, least_share};
  for (int i = 0; i < kPoints; ++i) {
    mark.points.emplace_back(radius_m * Direction(2 * kPi * i / kPoints));
  }
  return mark;
}

// Returns points on an arm of the pattern.
Mark OnArm(double angle) {
  Mark mark;
  for (const double along_m : {0.12, 0.18, 0.24, 0.3}) {
    mark.points.emplace_back(along_m * Direction(angle));
  }
  return mark;
}

// Signs that are none of the pattern's in any of their parts.
std::vector<Mark> InTheMiddle() { return {OnCircle(0.25, 0.7)}; }

Drawing::Ring Ring(double outer_m, double inner_m) { return {{0, 0}, outer_m, inner_m}; }

Drawing::Bar Spoke(double angle, double length_m) {
  return {0.5 * length_m * Direction(angle), Direction(angle), 0.5 * length_m,
          0.5 * kPattern.arm_width_m};
}

Drawing OuterRing(Random* random) {
  return Drawing().Add(Ring(kPattern.outer_radius_m(), random->Uniform(0.39, 0.41)));
}

// Arms as on boards of the pattern: some touch the ring.
double ArmLength(Random* random) { return random->Uniform(0.37, 0.41); }

Sign RingWithArms(std::initializer_list<int> arms, Random* random) {
  Sign sign{OuterRing(random), {}};
  const double length_m = ArmLength(random);
  std::array<bool, LandingPattern::kArms> has_arm{};
  for (const int arm : arms) has_arm[arm] = true;
  for (int arm = 0; arm < LandingPattern::kArms; ++arm) {
    const double angle = arm * kRightAngle;
    if (has_arm[arm]) {
      sign.ink.Add(Spoke(angle, length_m));
    } else {
      sign.marks.push_back(OnArm(angle));
    }
  }
  // The hub of the cross, as wide as an arm.
  sign.ink.Add(Drawing::Bar{{0, 0}, {1, 0}, 0.05, 0.05});
  return sign;
}

Sign Wheel(int spokes, double hub_m, Random* random) {
  Sign sign{OuterRing(random), InTheMiddle()};
  for (int i = 0; i < spokes; ++i) sign.ink.Add(Spoke(2 * kPi * i / spokes, 0.42));
  if (hub_m > 0) sign.ink.Add(Ring(hub_m, 0));
  return sign;
}

double Hub(Random* random) { return random->Uniform(0.08, 0.15); }

Sign ThePattern(Random* random) {
  LandingPattern pattern = kPattern;
  pattern.arm_half_length_m = ArmLength(random);
  return {LandingPatternInk(pattern), {OnCircle(0.5, 0.35)}};
}

Sign CrossWithoutRing(Random* random) {
  Sign sign{{}, {OnCircle(0.45, 0.3)}};
  const double length_m = ArmLength(random);
  for (int arm = 0; arm < LandingPattern::kArms; ++arm) {
    sign.ink.Add(Spoke(arm * kRightAngle, length_m));
  }
  return sign;
}

// The pattern with another ring, inside or outside of its own.
Sign DoubledRing(Random* random) {
  Sign sign = ThePattern(random);
  const bool is_inside = random->Chance(0.5);
  const double outer_m = is_inside ? random->Uniform(0.26, 0.3) : random->Uniform(0.64, 0.68);
  sign.ink.Add(Ring(outer_m, outer_m - random->Uniform(0.05, 0.1)));
  sign.marks = {OnCircle(outer_m, 0.3)};
  return sign;
}

Sign ShortArm(Random* random) {
  Sign sign = RingWithArms({1, 2, 3}, random);
  sign.ink.Add(Spoke(0, random->Uniform(0.1, 0.18)));
  sign.marks = {{{{0.22, 0}, {0.26, 0}, {0.3, 0}, {0.34, 0}}, 0.75}};
  return sign;
}

Sign OfLookalikes(LookalikeSet set, std::string_view name, Random* random) {
  for (const Lookalike& lookalike : Lookalikes(set)) {
    if (name != lookalike.name) continue;
    return {lookalike.draw({0, 0}, kPattern.outer_radius_m(), 0, random), InTheMiddle()};
  }
  throw InputError(fmt::format("there is no look-alike {}", name));
}

Sign HeldOut(Random* random) {
  const auto kinds = Lookalikes(LookalikeSet::kHeldOut);
  const Lookalike& kind = kinds[random->Integer(0, static_cast<int>(kinds.size()) - 1)];
  return {kind.draw({0, 0}, kPattern.outer_radius_m(), 0, random), InTheMiddle()};
}

constexpr std::array kKinds = {
    SignKind{"the pattern", ThePattern, true},
    SignKind{"ring", [](Random* r) { return RingWithArms({}, r); }},
    SignKind{"one arm", [](Random* r) { return RingWithArms({0}, r); }},
    SignKind{"two arms in line",
             [](Random* r) {
               return RingWithArms({0, 2}, r);
             }},
    SignKind{"two arms at a right angle",
             [](Random* r) {
               return RingWithArms({0, 1}, r);
             }},
    SignKind{"T of three arms",
             [](Random* r) {
               return RingWithArms({0, 1, 2}, r);
             }},
    SignKind{"a short arm", ShortArm},
    SignKind{"Y", [](Random* r) { return Wheel(3, 0, r); }},
    SignKind{"five spokes", [](Random* r) { return Wheel(5, 0, r); }},
    SignKind{"six spokes", [](Random* r) { return Wheel(6, 0, r); }},
    SignKind{"hub and three spokes", [](Random* r) { return Wheel(3, Hub(r), r); }},
    SignKind{"hub and five spokes", [](Random* r) { return Wheel(5, Hub(r), r); }},
    SignKind{"hub and six spokes", [](Random* r) { return Wheel(6, Hub(r), r); }},
    SignKind{"steering wheel",
             [](Random* r) {
               return OfLookalikes(LookalikeSet::kWithCounterfeits, "steering wheel", r);
             }},
    SignKind{"X without ring", CrossWithoutRing},
    SignKind{"doubled ring", DoubledRing},
    SignKind{"letter in a ring",
             [](Random* r) {
               return OfLookalikes(LookalikeSet::kWithCounterfeits, "letter in a ring", r);
             }},
    SignKind{"held-out kinds", HeldOut, false, true},
};

// Shares of the circle around a sign in view: all of it, or cut off.
constexpr double kLeastInView = 0.3, kMostInView = 0.9;
constexpr double kMostVeil = 0.5;       // of white, through which the eye sees ink
constexpr double kRenderedWhite = 100;  // leaves room for highlights above white

double ShareIf(const std::vector<Vector2d>& points, const auto& holds) {
  const auto count = std::count_if(points.begin(), points.end(), holds);
  return static_cast<double>(count) / static_cast<double>(points.size());
}

double VeilAt(const Scene& scene, const Vector2d& point) {
  double veil = 0;
  for (const Glare& glare : scene.glares) {
    const double distance = (point - glare.center).norm() / glare.sigma_m;
    veil += glare.strength * std::exp(-0.5 * distance * distance);
  }
  return veil;
}

void SetLight(SignLight light, Random* random, Scene* scene) {
  scene->shadows.clear();
  scene->glares.clear();
  if (light == SignLight::kShadow) {
    constexpr double kHalfSize_m = 100;
    const Vector2d outward = RandomDirection(random);
    const double distance_m = random->Uniform(-0.3, 0.3) + kHalfSize_m;
    scene->shadows.push_back(
        {Drawing().Add(Drawing::Bar{distance_m * outward, outward, kHalfSize_m, kHalfSize_m}),
         random->Uniform(0.3, 0.6), random->Uniform(0.005, 0.06)});
  } else if (light == SignLight::kGlare) {
    scene->glares.push_back({random->Uniform(0, 0.5) * RandomDirection(random),
                             random->Uniform(0.08, 0.3), random->Uniform(0.5, 1.4)});
  }
}

class SignCamera {
 public:
  SignCamera() : renderer_(CameraModel(PaperCamera()), {.half_angle_deg = 85}) {}

  // Lights the scene and returns a pose, so that the eye sees enough of the sign.
  RigidTransform RandomView(const Sign& sign, SignLight light, bool cut_off, Random* random,
                            Scene* scene) const {
    constexpr int kMaxTries = 100'000;
    for (int i = 0; i < kMaxTries; ++i) {
      SetLight(light, random, scene);
      const RigidTransform pose = AnyPose(cut_off, random);
      const auto is_seen = [&](const Vector2d& p) {
        return renderer_.lens().Sees(pose * Vector3d(p.x(), p.y(), 0));
      };
      const double in_view = ShareIf(OnCircle(0.55, 0).points, is_seen);
      if (cut_off ? in_view < kLeastInView || in_view > kMostInView : in_view < 1) continue;
      const bool marks = std::any_of(sign.marks.begin(), sign.marks.end(), [&](const Mark& mark) {
        return ShareIf(mark.points, [&](const Vector2d& p) {
                 return is_seen(p) && VeilAt(*scene, p) < kMostVeil;
               }) >= mark.least_share;
      });
      if (marks) return pose;
    }
    throw InputError("no pose shows the sign");
  }

  const SceneRenderer& renderer() const { return renderer_; }

 private:
  static RigidTransform AnyPose(bool cut_off, Random* random) {
    const double height_m = cut_off ? random->Uniform(0.4, 1.6) : random->Uniform(0.8, 5);
    const double tilt = Radians(random->Uniform(0, 35));
    const Vector2d axis = RandomDirection(random);
    RigidTransform pose;
    pose.rotation = Eigen::AngleAxisd(tilt, Vector3d(axis.x(), axis.y(), 0)) *
                    Eigen::AngleAxisd(kPi, Vector3d::UnitX()) *
                    Eigen::AngleAxisd(random->Uniform(0, 2 * kPi), Vector3d::UnitZ());
    const Vector2d aside = height_m * random->Uniform(0, 1.5) * RandomDirection(random);
    pose.translation = pose.rotation * Vector3d(aside.x(), aside.y(), -height_m);
    return pose;
  }

  SceneRenderer renderer_;
};

cv::Mat Expose(const cv::Mat& rendered, double white, double noise, Random* random) {
  cv::Mat image(rendered.size(), CV_8UC1);
  const double gain = white / kRenderedWhite;
  for (int v = 0; v < image.rows; ++v) {
    for (int u = 0; u < image.cols; ++u) {
      const double gray = gain * rendered.at<std::uint8_t>(v, u) + noise * random->Normal();
      image.at<std::uint8_t>(v, u) =
          static_cast<std::uint8_t>(std::lround(std::clamp(gray, 0.0, 255.0)));
    }
  }
  return image;
}

}  // namespace

std::span<const SignKind> SignKinds() { return kKinds; }

std::vector<LandingFrame> RenderSign(const SignKind& kind, SignLight light, bool cut_off,
                                     std::uint64_t seed) {
  static const SignCamera camera;
  Random random(seed);
  Sign sign = kind.draw(&random);
  Scene scene;
  scene.ground_reflectance = random.Uniform(0.15, 0.45);
  scene.texture_seed = random.Bits();
  scene.layers = {{SquareBoard({0, 0}, kPattern.board_size_m, kPi / 4), 0.9, 0.03},
                  {sign.ink, random.Uniform(0.04, 0.12), 0.03}};
  const RigidTransform pose = camera.RandomView(sign, light, cut_off, &random, &scene);
  ImagingOptions imaging;
  imaging.black_level = 0;
  imaging.white_level = kRenderedWhite / 0.9;
  imaging.blur_sigma_px = random.Uniform(0.4, 0.9);
  const cv::Mat rendered = camera.renderer().Render(scene, pose, imaging);
  const double noise = random.Uniform(0.5, 2);

  LandingFrame frame;
  frame.truth = kind.is_pattern ? PatternTruth::kWhole : PatternTruth::kNone;
  frame.camera_from_target = pose;
  frame.up_in_camera = pose.rotation * Vector3d::UnitZ();
  frame.altitude_m = pose.Inverse().translation.z();
  frame.ring_radius_px = PaperCamera().fx_px * kPattern.outer_radius_m() / pose.translation.norm();
  if (camera.renderer().camera().Project(pose.translation, &frame.center_px) ==
      ProjectionStatus::kOutsideModel) {
    frame.truth = kind.is_pattern ? PatternTruth::kUnknown : frame.truth;
  }
  std::vector<LandingFrame> frames;
  for (const double white : kSignWhites) {
    frame.name = fmt::format("{}, white {}, {}", kind.name, white, seed);
    frame.image = Expose(rendered, white, noise, &random);
    frames.push_back(frame);
  }
  return frames;
}

}  // namespace kestrel
