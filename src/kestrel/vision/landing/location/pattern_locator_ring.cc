// SPDX-License-Identifier: BSD-3-Clause
// The pose of a ring by its edges alone.
#include <algorithm>
#include <span>
#include <utility>

#include "kestrel/vision/landing/location/pattern_locator_equations.h"
#include "kestrel/vision/landing/print_places.h"

namespace kestrel {
namespace {

constexpr double kRingSettledPx = 0.2;
constexpr double kMaxRingScatterPx = 1.5;  // standard deviation, after two iterations
constexpr double kGathering = 0.6;  // edges still gather when a step scales their scatter by less

}  // namespace

std::optional<RingLocation> PatternLocator::LocateRing(
    const cv::Mat& image, const RigidTransform& initial, double reach_px, double min_step,
    int iterations, const std::optional<NormalPrior>& prior) const {
  State state{initial};
  double scale = std::max(1.0, 0.5 * reach_px);
  double reach = reach_px;
  const std::span<const PrintOutline::Place> places = outline_.ring();
  const auto whole =
      static_cast<std::size_t>(PrintPlaces::kWhole * places.size() / EdgeFit::kCoarseStride);
  bool is_whole = false;
  PrintEdges found;
  EdgeColumns edges;
  Linearized linearized(edges);
  const auto measure = [&](std::size_t stride) {
    const PlaneWarp warp(camera_, state.pose, outline_.radius_m());
    FindPrintEdges(image, {}, warp, places, {reach, min_step, stride}, &found);
    edges = EdgeColumns(found, 1);
    Linearize(state, scale, kPoseUnknowns, &linearized);
  };
  for (int i = 0; i < iterations; ++i) {
    measure(EdgeFit::kCoarseStride);
    is_whole = linearized.used >= whole;
    if (!is_whole) {
      measure(1);
      is_whole = linearized.used >= EdgeFit::kCoarseStride * whole;
    }
    if (linearized.used < EdgeFit::kLeastEdges) return std::nullopt;
    // A ring does not determine the turn in its plane, and a short arc hardly its far side.
    Matrix& h = linearized.equations.h;
    h.diagonal() *= 1 + 1e-4;
    const double weight = 1e-6 * h.diagonal().segment<3>(kPoseRotation).maxCoeff();
    for (int k = kPoseRotation; k < kPoseUnknowns; ++k) h(k, k) += weight;
    const Vector step = WithPrior(linearized, state, prior).PoseStep();
    if (!state.Move(step)) return std::nullopt;
    const double before =
        std::exchange(scale, std::clamp(linearized.RobustScale(), EdgeFit::kLeastScalePx, scale));
    reach = std::clamp(3 * scale, 1.5, reach);
    // Edges of anything but a ring stay scattered.
    const bool gathers = scale < kGathering * before && i + 1 < iterations;
    if (i > 0 && scale > kMaxRingScatterPx && !gathers) return std::nullopt;
    if (i > 0 && linearized.Movement(step) < kRingSettledPx) break;
  }
  return RingLocation{state.pose, is_whole};
}

}  // namespace kestrel
