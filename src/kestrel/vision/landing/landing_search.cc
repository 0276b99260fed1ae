// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/landing_search.h"

#include <algorithm>

namespace kestrel {
namespace {

// A predicted ring up to this factor below the limit of small rings is still tested by its edges
// first, which give more information than the fit as a whole. Areas seem larger by this factor.
constexpr double kNearlyLarge = 1.1;

RingSize SizeOf(const SearchStep& step) {
  const bool is_small =
      kPasses[step.pass].image_level == 0 || step.method == SearchMethod::kCutAreas;
  return is_small ? RingSize::kSmall : RingSize::kNear;
}

cv::Rect AllOf(const cv::Mat& image) { return {0, 0, image.cols, image.rows}; }

}  // namespace

void LandingWorkspace::Buffers::Reserve(const cv::Mat& image_of_that_size) {
  if (!image.Reserve(image_of_that_size)) return;
  rings.Reserve(image.most_points());
  crosses.Reserve(image.most_points());
  near_prints.Reserve();
  small_prints.Reserve();
}

LandingSearch::LandingSearch(const LandingModels& models, const cv::Mat& image,
                             const TargetHint& hint, LandingWorkspace::Buffers* buffers,
                             const FindingObserver* observer)
    : models_(models),
      hint_(hint),
      buffers_(*buffers),
      start_(models.now()),
      log_(&report_),
      prior_(hint, models.options, models.camera),
      image_(image, &buffers->image, &log_),
      choice_(models.options.min_quality, observer, &log_),
      rings_(models, &buffers->rings, &log_),
      near_prints_({models, prior_, image_, choice_, log_}, &buffers->near_prints),
      small_prints_({models, prior_, image_, choice_, log_}, &buffers->small_prints) {
  buffers_.Reserve(image);
  buffers_.near_prints.tested.Clear();
  buffers_.near_prints.refused.Clear();
  buffers_.small_prints.tested.Clear();
}

TargetReport LandingSearch::Run() {
  report_.reason = "not in view";
  TestPrediction();
  if (!choice_.IsSure()) TakeSteps();
  report_.detection = choice_.Detection();
  if (report_.detection) report_.diagnostics.next_step = 0;
  return report_;
}

// A good prediction finds the ring without a search. A wrong one finds no ring there and costs
// little.
void LandingSearch::TestPrediction() {
  const std::optional<CirclePose> ring = prior_.PredictedRing();
  const std::optional<cv::Rect> part = prior_.PartOfImage(0);
  if (!ring || !part) return;
  const Eigen::Vector2d diameters_px =
      RingDiametersPx(models_.camera, models_.options.pattern.outer_radius_m(), *ring);
  if (!IsSmallRing(kNearlyLarge * diameters_px)) {
    image_.Choose(*part, RingSize::kNear);
    near_prints_.TestPredicted(*ring, diameters_px);
  }
  if (!choice_.IsSure() && IsSmallRing(diameters_px)) {
    image_.Choose(*part, RingSize::kSmall);
    small_prints_.TestPredicted(*ring, diameters_px);
  }
}

// Takes the likely steps in the likely part of the image, then all others.
void LandingSearch::TakeSteps() {
  const cv::Rect all = prior_.PartBelowHorizon().value_or(AllOf(image_.whole()));
  const cv::Rect likely = prior_.PartOfImage(hint_.center_sigma_m).value_or(all);
  const bool is_likely_all = likely == all;
  const int first = std::clamp(hint_.first_step, 0, 2 * static_cast<int>(kSearchSteps) - 1);
  for (int i = 0; i < 2 * static_cast<int>(kSearchSteps); ++i) {
    const int index = (first + i) % (2 * static_cast<int>(kSearchSteps));
    const bool is_first_round = index < static_cast<int>(kSearchSteps);
    const SearchStep& step = kSteps[index % kSearchSteps];
    if ((models_.skipped_steps >> (index % kSearchSteps)) & 1) continue;
    if (is_first_round ? !prior_.Suits(step) : is_likely_all && prior_.Suits(step)) continue;
    const cv::Rect& part = is_first_round ? likely : all;
    image_.Choose(part, SizeOf(step));
    image_.Prepare();
    Take(step);
    if (choice_.IsSure()) return;
    if (IsOutOfTime()) {
      report_.diagnostics.next_step = (index + 1) % (2 * static_cast<int>(kSearchSteps));
      return;
    }
  }
}

void LandingSearch::Take(const SearchStep& step) {
  if (step.method == SearchMethod::kCross) return TestCrosses(step.pass);
  const std::span<const RingCandidate> candidates =
      step.method == SearchMethod::kAreas      ? rings_.FindInAreas(&image_, step.pass)
      : step.method == SearchMethod::kCutAreas ? rings_.FindInCutAreas(&image_, step.pass)
                                               : rings_.FindInArcs(&image_, step.pass);
  for (const RingCandidate& candidate : candidates) {
    if (candidate.is_small) {
      small_prints_.Test(candidate);
    } else {
      near_prints_.Test(candidate);
    }
  }
}

// Tests the cross alone: low above the pattern no ring is in view.
void LandingSearch::TestCrosses(std::size_t pass) {
  const ImageRegion region = image_.RegionAt(kPasses[pass].image_level);
  const BorderTracer& tracer = image_.Borders(pass);
  {
    const SearchLog::Timer timer = log_.Time(LandingStage::kCross);
    FindPartialPatterns(tracer, models_.rays, region, models_.options.pattern, prior_.Up(),
                        &buffers_.crosses);
  }
  for (const RigidTransform& pose : buffers_.crosses.poses) {
    if (pose.translation.norm() > models_.options.max_partial_altitude_m) continue;
    near_prints_.TestCross(pose, region);
  }
}

bool LandingSearch::IsOutOfTime() const {
  const double configured_ms = models_.options.max_search_ms;
  const double limit_ms = configured_ms > 0 ? configured_ms : hint_.max_search_ms;
  if (limit_ms == 0) return false;
  const std::chrono::duration<double, std::milli> spent = models_.now() - start_;
  return spent.count() > limit_ms;
}

}  // namespace kestrel
