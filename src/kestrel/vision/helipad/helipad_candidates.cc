// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/helipad/helipad_candidates.h"

#include <array>
#include <cmath>
#include <span>

namespace kestrel {
namespace {

constexpr PlaneBorders::Passes kHelipadPasses{{
    {.image_level = 3, .tile_level = 5, .min_px = 150, .max_px = 1 << 13, .least_extent = 9},
    {.image_level = 2, .tile_level = 5, .min_px = 60, .max_px = 500, .least_extent = 7},
    {.image_level = 1, .tile_level = 4, .min_px = 28, .max_px = 240, .least_extent = 7},
    {.image_level = 0, .tile_level = 3, .min_px = 7, .max_px = 110, .least_extent = 4},
}};

constexpr std::size_t kMostCandidates = 64;

// Levels of the image at which a pass looks for narrow strokes, from 'first' down to 'last'.
struct NarrowLevels {
  int first, last;
};
constexpr std::array<NarrowLevels, PlaneBorders::kPasses> kNarrowLevels{
    {{5, 3}, {2, 2}, {1, 1}, {0, 0}}};

// True when a border may be an H's or a frame's by its area: the H fills about half of its box when
// that is upright, and less when it is turned; a frame fills at most all of it.
bool FillsItsBox(const Border& border) {
  const double box =
      static_cast<double>(border.max.x - border.min.x) * (border.max.y - border.min.y);
  constexpr double kLeastFill = 0.2, kMostFill = 1;
  const double fill = std::abs(border.signed_area) / box;
  return fill >= kLeastFill && fill <= kMostFill;
}

}  // namespace

HelipadFinder::HelipadFinder(const CameraModel& camera, const HelipadModel& model)
    : borders_(camera, kHelipadPasses), model_(model) {}

void HelipadFinder::Begin(const cv::Mat& image, const cv::Rect& part,
                          HelipadCandidateBuffers* buffers) const {
  buffers->candidates.reserve(kMostCandidates);
  BorderBuffers& borders = buffers->borders;
  if (borders.width_px != image.cols || borders.height_px != image.rows) {
    buffers->narrow.Reserve(image, &borders);
  }
  borders_.Begin(image, part, &borders);
}

void HelipadFinder::Find(const cv::Rect& part, int pass, HelipadCandidateBuffers* buffers) const {
  const auto borders = borders_.Trace(part, pass, &buffers->borders);
  buffers->candidates.clear();
  buffers->examined = 0;
  // A border goes clockwise around a dark area, and anticlockwise around a hole in it.
  Add(borders, !model_.samples.white(), part, kHelipadPasses[pass].image_level, buffers);
}

void HelipadFinder::FindNarrow(const cv::Rect& part, int pass,
                               HelipadCandidateBuffers* buffers) const {
  constexpr int kLeastExtent = 6, kMostExtent = 64;  // pixels of a level
  buffers->candidates.clear();
  buffers->examined = 0;
  for (int level = kNarrowLevels[pass].first; level >= kNarrowLevels[pass].last; --level) {
    BorderLimits limits;
    limits.min_extent = level == 0 ? kLeastExtent : 2 * kLeastExtent;
    limits.min_count = 4 * static_cast<std::size_t>(limits.min_extent);
    limits.max_extent = kMostExtent;
    limits.narrow = true;
    Add(TraceNarrow(level, model_.samples.white(), limits, &buffers->borders, &buffers->narrow),
        true, part, level, buffers);
  }
}

void HelipadFinder::Add(std::span<const Border> borders, bool around_ink, const cv::Rect& part,
                        int level, HelipadCandidateBuffers* buffers) const {
  for (const Border& border : borders) {
    if ((border.signed_area > 0) != around_ink) continue;
    ++buffers->examined;
    if (buffers->candidates.size() == kMostCandidates) return;
    HelipadCandidate candidate;
    if (Examine(border, part, level, &buffers->borders, &candidate)) {
      buffers->candidates.push_back(candidate);
    }
  }
}

bool HelipadFinder::Examine(const Border& border, const cv::Rect& part, int level,
                            BorderBuffers* buffers, HelipadCandidate* candidate) const {
  if (!FillsItsBox(border)) return false;
  if (!borders_.OnPlane(border, part, level, &candidate->camera_from_plane, buffers)) {
    return false;
  }
  candidate->moments = MomentsOf(buffers->points);
  const auto is_like = [candidate](const FigureMoments& printed, double tolerance) {
    const double ratio = candidate->moments.Compactness() / printed.Compactness();
    candidate->printed = &printed;
    return std::abs(ratio - 1) <= tolerance;
  };
  constexpr double kLetterTolerance = 0.3, kFrameTolerance = 0.08;
  return is_like(model_.letter_moments, kLetterTolerance) ||
         (model_.frame_moments.area > 0 && is_like(model_.frame_moments, kFrameTolerance));
}

}  // namespace kestrel
