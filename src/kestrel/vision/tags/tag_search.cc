// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/tags/tag_search.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "kestrel/vision/tags/board_reading.h"
#include "kestrel/vision/tags/tag_match.h"

namespace kestrel {
namespace {

// Logarithm of the odds against one of 'tags' tags in one of four turns where 'quads' quads of an
// image were tried. An image has a hundred more that were not traced, as a rule; the pad is not
// always in view.
double SearchOdds(std::size_t tags, int quads) {
  constexpr double kSceneOdds = 2;
  constexpr int kTurns = 4, kOtherQuads = 100;
  return kSceneOdds + std::log(static_cast<double>(tags) * kTurns * (quads + kOtherQuads));
}

// Returns the mean of the white cells minus that of the black ones, over the spread of all: how
// much gray values, negative where out of view, look like a tag. Negative when few are in view.
double LikenessOf(std::span<const float> gray, const TagGrid& grid) {
  constexpr int kFewest = 4;
  double sum[2] = {0, 0}, squares = 0;
  int count[2] = {0, 0};
  for (std::size_t i = 0; i < gray.size(); ++i) {
    if (grid.cells[i] == TagCell::kNone || gray[i] < 0) continue;
    const bool white = grid.cells[i] == TagCell::kWhite;
    sum[white] += gray[i];
    squares += gray[i] * gray[i];
    ++count[white];
  }
  if (count[0] < kFewest || count[1] < kFewest) return -1;
  const int all = count[0] + count[1];
  const double mean = (sum[0] + sum[1]) / all;
  const double spread = std::sqrt(std::max(1.0, squares / all - mean * mean));
  return (sum[1] / count[1] - sum[0] / count[0]) / spread;
}

}  // namespace

TagSearch::TagSearch(const TagSearchModels& models, const cv::Mat& image, const TargetHint& hint,
                     TagSearchBuffers* buffers)
    : PadSearch(models.search, image, hint, &buffers->pad), tags_(models), quads_(buffers->quads) {
  quads_.quads.clear();
}

// The largest tag of which enough is in view.
const TagModel* TagSearch::LeadingTag(const RigidTransform& pose) {
  const TagModel* leading = nullptr;
  for (const TagModel& tag : tags_.board.tags) {
    if (leading != nullptr && tag.size_m <= leading->size_m) continue;
    if (tag.StrokePx(models_.camera, pose) < PadPart::kLeastStrokePx) continue;
    buffers_.samples.Place(models_.camera, pose, tag.cell_centers);
    const std::span<const float> gray = buffers_.samples.Read(image_);
    const auto seen = std::count_if(gray.begin(), gray.end(), [](float g) { return g >= 0; });
    constexpr int kLeastShare = 6;  // a sixth of the cells
    if (kLeastShare * seen >= static_cast<std::ptrdiff_t>(gray.size())) leading = &tag;
  }
  return leading;
}

void TagSearch::Follow(const RigidTransform& expected) {
  const TagModel* const tag = LeadingTag(expected);
  if (tag == nullptr) return;
  constexpr double kStepCells = 0.4;
  const std::optional<RigidTransform> shifted =
      MostLike(expected, tag->cell_centers, kStepCells * tag->StrokePx(models_.camera, expected),
               [tag](std::span<const float> gray) { return LikenessOf(gray, tag->grid()); });
  if (shifted) Take(*shifted, *tag, kExpectedOdds, DetectionMethod::kFollowed);
}

void TagSearch::Begin(const cv::Rect& part) { tags_.finder.Begin(image_, part, &quads_); }

bool TagSearch::MayHaveSize(int pass, double distance_m, double error) const {
  return std::any_of(tags_.board.tags.begin(), tags_.board.tags.end(), [&](const TagModel& tag) {
    const double size_px = models_.camera.intrinsics().fx_px * tag.size_m / distance_m;
    constexpr double kSlant = 0.6;  // share of its extent that a tag shows when seen from aside
    return tags_.finder.Covers(pass, kSlant * size_px / (1 + error),
                               M_SQRT2 * size_px / (1 - error));
  });
}

// Gray values are searched where their logarithms show no tag.
int TagSearch::Steps() const { return 2 * PlaneBorders::kPasses; }

void TagSearch::SearchStep(const cv::Rect& part, int step) {
  std::span<const TagQuad> quads;
  {
    const SearchLog::Timer timer = log_.Time(LandingStage::kAreas);
    if (step >= PlaneBorders::kPasses && !is_linear_) {
      tags_.finder.BeginLinear(image_, part, &quads_);
      is_linear_ = true;
    }
    quads = tags_.finder.Find(part, step % PlaneBorders::kPasses, &quads_);
  }
  ExamineBorders(quads_.examined, "no border is a quadrangle");
  const SearchLog::Timer timer = log_.Time(LandingStage::kCross);
  for (const TagQuad& quad : quads) Try(quad);
}

void TagSearch::Try(const TagQuad& quad) {
  ++tried_;
  log_.Reach(LandingStage::kRing, "no quadrangle has the cells of a tag of the board");
  const std::optional<TagMatch> match =
      MatchTag(image_, models_.camera, tags_.board, quad, &buffers_.samples);
  if (!match) return;
  log_.Reach(LandingStage::kCross, "the edges of the cells are not where they should be");
  Take(match->camera_from_board, *match->tag, SearchOdds(tags_.board.tags.size(), tried_),
       DetectionMethod::kTags);
}

void TagSearch::Take(const RigidTransform& pose, const TagModel& tag, double prior,
                     DetectionMethod method) {
  // The pose is not good enough to find the edges of the other tags.
  std::optional<AlignedPad> by_tag;
  if (tags_.board.tags.size() > 1) by_tag = Align(pose, &tag);
  const std::optional<AlignedPad> aligned = Align(by_tag ? by_tag->camera_from_pad : pose);
  if (!aligned) return;
  log_.Reach(LandingStage::kMatch, "the cells do not look like the tag");
  const BoardReading reading =
      ReadBoard(image_, models_.camera, tags_.board, aligned->camera_from_pad, &buffers_.samples,
                DimSampleIn(method));
  const double quality = 1 / (1 + std::exp(prior - reading.evidence));
  if (quality < tags_.min_quality) return;
  if (is_found() && quality <= report_.detection->quality) return;
  log_.Reach(LandingStage::kLocate, "no pose explains the edges");
  Report(*aligned, reading.parts, quality, method);
}

void TagSearch::Report(AlignedPad aligned, const SeenParts& parts, double quality,
                       DetectionMethod method) {
  const std::optional<RigidTransform> mirror = ResolveMirror(&aligned);
  TargetDetection detection = DetectionOf(aligned, quality, method);
  detection.diagnostics.mirror_camera_from_target = mirror;
  double largest = 0;
  for (const SeenPart& part : parts.all()) largest = std::max(largest, part.size_px);
  const RigidTransform& pose = aligned.camera_from_pad;
  detection.semi_minor_px = 0.5 * largest;
  detection.semi_major_px =
      std::min(0.5 * largest / std::max(Slant(pose), 0.01),
               models_.camera.intrinsics().fx_px * models_.radius_m / pose.translation.norm());
  detection.semi_major_px = std::max(detection.semi_major_px, detection.semi_minor_px);
  detection.id = tags_.board.tags.front().id;
  detection.heading_symmetry = 1;
  detection.parts = parts;
  report_.detection = detection;
}

}  // namespace kestrel
