// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/tags/tag_search.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <span>

#include "kestrel/core/geometry/angles.h"
#include "kestrel/vision/tags/tag_match.h"

namespace kestrel {
namespace {

constexpr double kSearchOdds = 8;    // against a tag in any quad of an image, natural logarithm
constexpr double kFollowedOdds = 4;  // against it near the expected place
constexpr double kSigmas = 3;        // of the expected place that are searched
constexpr double kMostShiftPx = 30;  // of a board that is followed
constexpr int kMostShiftSteps = 10;  // to either side
constexpr double kMirrorCost = 4.5;  // below it the image cannot tell two poses apart: 3 sigma
constexpr double kMisfitBoundPx = 1;

std::int64_t Now() {
  return std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

// Adds the time from its construction to its end.
class StageTimer {
 public:
  StageTimer(LandingReport* report, LandingStage stage)
      : total_(report->stage_ns[static_cast<std::size_t>(stage)]), start_(Now()) {}
  ~StageTimer() { total_ += Now() - start_; }
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  std::int64_t& total_;
  std::int64_t start_;
};

void AddCells(const TagModel& tag, const RigidTransform& pose, BoardSamples* samples) {
  samples->Clear();
  for (const Eigen::Vector2d& center : tag.cell_centers) {
    samples->Add(pose * Eigen::Vector3d(center.x(), center.y(), 0));
  }
}

// Mean of the white cells minus mean of the black ones, over the spread of all: how much gray
// values look like a tag's cells; negative when there are few.
double Likeness(const TagModel& tag, std::span<const float> gray) {
  double sum[2] = {0, 0}, squares = 0;
  int count[2] = {0, 0};
  for (std::size_t i = 0; i < gray.size(); ++i) {
    if (tag.grid().cells[i] == TagCell::kNone || gray[i] < 0) continue;
    const bool white = tag.grid().cells[i] == TagCell::kWhite;
    sum[white] += gray[i];
    squares += gray[i] * gray[i];
    ++count[white];
  }
  if (count[0] < 4 || count[1] < 4) return -1;
  const int all = count[0] + count[1];
  const double mean = (sum[0] + sum[1]) / all;
  const double spread = std::sqrt(std::max(1.0, squares / all - mean * mean));
  return (sum[1] / count[1] - sum[0] / count[0]) / spread;
}

}  // namespace

TagSearch::TagSearch(const TagSearchModels& models, const cv::Mat& image, const LandingHint& hint,
                     TagSearchBuffers* buffers)
    : models_(models),
      image_(image),
      hint_(hint),
      buffers_(*buffers),
      prior_{hint.up_in_camera, Radians(models.options.level_sigma_deg)} {}

LandingReport TagSearch::Run() {
  report_.reason = "the image has no contrast";
  if (hint_.center_in_camera && hint_.rotation_in_camera) Follow();
  if (!is_found()) Search();
  if (is_found()) {
    report_.reached = LandingStage::kFound;
    report_.reason = {};
  }
  return report_;
}

void TagSearch::Reached(LandingStage stage, std::string_view reason) {
  ++report_.candidates[static_cast<std::size_t>(stage)];
  if (stage < report_.reached) return;
  report_.reached = stage;
  report_.reason = reason;
}

// The largest tag of which enough is in view.
const TagModel* TagSearch::LeadingTag(const RigidTransform& pose) {
  const TagModel* leading = nullptr;
  for (const TagModel& tag : models_.board.tags) {
    if (leading != nullptr && tag.size_m <= leading->size_m) continue;
    if (CellPx(models_.camera, pose, tag) < kLeastCellPx) continue;
    AddCells(tag, pose, &buffers_.cells);
    buffers_.cells.Project(models_.camera);
    const std::span<const float> gray = buffers_.cells.Read(image_);
    const auto seen = std::count_if(gray.begin(), gray.end(), [](float g) { return g >= 0; });
    constexpr int kLeastShare = 6;  // a sixth of the cells
    if (kLeastShare * seen >= static_cast<std::ptrdiff_t>(gray.size())) leading = &tag;
  }
  return leading;
}

// Moves a pose across the line of sight to where the image looks most like the tag.
std::optional<RigidTransform> TagSearch::ShiftedPose(const RigidTransform& expected,
                                                     const TagModel& tag) {
  const double distance = expected.translation.norm();
  const double focal_px = models_.camera.intrinsics().fx_px;
  const double radius =
      std::min(kMostShiftPx, kSigmas * hint_.center_sigma_m * focal_px / distance);
  constexpr double kStepCells = 0.4;
  const double step =
      std::max(kStepCells * CellPx(models_.camera, expected, tag), radius / kMostShiftSteps);
  const int steps = static_cast<int>(std::ceil(radius / step));
  AddCells(tag, expected, &buffers_.cells);
  buffers_.cells.Project(models_.camera);
  double best = 0, best_x = 0, best_y = 0;
  for (int y = -steps; y <= steps; ++y) {
    for (int x = -steps; x <= steps; ++x) {
      const double here = Likeness(tag, buffers_.cells.Read(image_, static_cast<float>(x * step),
                                                            static_cast<float>(y * step)));
      if (here <= best) continue;
      best = here;
      best_x = x * step;
      best_y = y * step;
    }
  }
  // The cell nearest to the image's middle carries the shift into space.
  const Eigen::Vector2d middle(0.5 * image_.cols, 0.5 * image_.rows);
  double nearest = 1e18;
  std::size_t cell = 0;
  for (std::size_t i = 0; i < buffers_.cells.count(); ++i) {
    const double away =
        (Eigen::Vector2d(buffers_.cells.u(i), buffers_.cells.v(i)) - middle).squaredNorm();
    if (away < nearest) {
      nearest = away;
      cell = i;
    }
  }
  const Eigen::Vector2d pixel(buffers_.cells.u(cell), buffers_.cells.v(cell));
  const Eigen::Vector2d moved = pixel + Eigen::Vector2d(best_x, best_y);
  Eigen::Vector3d from, to;
  const auto sees = [this](const Eigen::Vector2d& place, Eigen::Vector3d* ray) {
    return models_.camera.Unproject(place, ray) != ProjectionStatus::kOutsideModel;
  };
  if (best <= 0 || !sees(pixel, &from) || !sees(moved, &to)) return std::nullopt;
  const Eigen::Vector2d& center = tag.cell_centers[cell];
  const double range = (expected * Eigen::Vector3d(center.x(), center.y(), 0)).norm();
  return RigidTransform{expected.rotation, expected.translation + range * (to - from)};
}

void TagSearch::Follow() {
  const StageTimer timer(&report_, LandingStage::kMatch);
  const RigidTransform expected{*hint_.rotation_in_camera, *hint_.center_in_camera};
  const TagModel* const tag = LeadingTag(expected);
  if (tag == nullptr) return;
  const std::optional<RigidTransform> shifted = ShiftedPose(expected, *tag);
  if (shifted) Take(*shifted, kFollowedOdds, DetectionMethod::kFollowed);
}

cv::Rect TagSearch::SearchedPart() const {
  const cv::Rect whole(0, 0, image_.cols, image_.rows);
  Eigen::Vector2d center;
  if (!hint_.center_in_camera ||
      models_.camera.Project(*hint_.center_in_camera, &center) == ProjectionStatus::kOutsideModel) {
    return whole;
  }
  constexpr double kMargin = 1.3;  // lenses that magnify towards the edge
  const double reach = models_.board.radius_m + kSigmas * hint_.center_sigma_m;
  const double radius_px = kMargin * models_.camera.intrinsics().fx_px * reach /
                               std::max(0.1, hint_.center_in_camera->norm()) +
                           8;
  const double most = image_.cols + image_.rows;
  if (!(radius_px < most)) return whole;
  const cv::Rect part =
      whole & cv::Rect(static_cast<int>(center.x() - radius_px),
                       static_cast<int>(center.y() - radius_px), static_cast<int>(2 * radius_px),
                       static_cast<int>(2 * radius_px));
  return part.empty() ? whole : part;
}

bool TagSearch::MayHaveSize(int pass) const {
  if (!hint_.center_in_camera) return true;
  const double distance = hint_.center_in_camera->norm();
  const double error = std::min(0.5, kSigmas * hint_.center_sigma_m / distance);
  return std::any_of(
      models_.board.tags.begin(), models_.board.tags.end(), [&](const TagModel& tag) {
        const double size_px = models_.camera.intrinsics().fx_px * tag.size_m / distance;
        constexpr double kSlant = 0.6;  // of the extent of a tag that is seen from aside
        return TagQuadFinder::Covers(pass, kSlant * size_px / (1 + error),
                                     M_SQRT2 * size_px / (1 - error));
      });
}

void TagSearch::Search() {
  const cv::Rect part = SearchedPart();
  {
    const StageTimer timer(&report_, LandingStage::kBinarize);
    models_.finder.Begin(image_, part, &buffers_.quads);
  }
  const std::int64_t start = Now();
  for (int pass = hint_.first_step; pass < TagQuadFinder::kPasses && !is_found(); ++pass) {
    constexpr double kNsPerMs = 1e6;
    const bool late = hint_.max_search_ms > 0 && pass > hint_.first_step &&
                      static_cast<double>(Now() - start) > hint_.max_search_ms * kNsPerMs;
    if (late) {
      report_.next_step = pass;
      return;
    }
    if (MayHaveSize(pass)) SearchPass(part, pass);
  }
}

void TagSearch::SearchPass(const cv::Rect& part, int pass) {
  {
    const StageTimer timer(&report_, LandingStage::kAreas);
    models_.finder.Find(part, pass, &buffers_.quads);
  }
  report_.candidates[static_cast<std::size_t>(LandingStage::kAreas)] +=
      static_cast<std::int32_t>(buffers_.quads.borders);
  if (buffers_.quads.borders > 0 && report_.reached < LandingStage::kAreas) {
    report_.reached = LandingStage::kAreas;
    report_.reason = "no border is a quadrangle";
  }
  const StageTimer timer(&report_, LandingStage::kCross);
  for (const TagQuad& quad : buffers_.quads.quads) {
    Reached(LandingStage::kRing, "no quadrangle has the cells of a tag of the board");
    const std::optional<TagMatch> match =
        MatchTag(image_, models_.camera, models_.board, quad, &buffers_.cells);
    if (!match) continue;
    Reached(LandingStage::kCross, "the edges of the cells are not where they should be");
    // A pose by one tag of several is not good enough to find the edges of the others.
    std::optional<AlignedBoard> by_tag;
    if (models_.board.tags.size() > 1) {
      by_tag = models_.alignment.Align(image_, match->camera_from_board, prior_, match->tag,
                                       &buffers_.alignment);
    }
    Take(by_tag ? by_tag->camera_from_board : match->camera_from_board, kSearchOdds,
         DetectionMethod::kTags);
  }
}

TagSearch::Finding TagSearch::Judge(const AlignedBoard& aligned) {
  Finding finding;
  finding.aligned = aligned;
  for (const TagModel& tag : models_.board.tags) {
    const double cell_px = CellPx(models_.camera, aligned.camera_from_board, tag);
    if (cell_px < kLeastCellPx) continue;
    AddCells(tag, aligned.camera_from_board, &buffers_.cells);
    buffers_.cells.Project(models_.camera);
    const TagAgreement agreement =
        CompareCells(tag, buffers_.cells.ReadCells(image_, tag.grid().width, cell_px));
    if (agreement.wrong > tag.most_wrong || agreement.evidence <= 0) continue;
    finding.evidence += agreement.evidence;
    finding.parts.Add({"tag", tag.id, cell_px * tag.grid().border_width});
  }
  return finding;
}

void TagSearch::Take(const RigidTransform& pose, double prior, DetectionMethod method) {
  const std::optional<AlignedBoard> aligned =
      models_.alignment.Align(image_, pose, prior_, nullptr, &buffers_.alignment);
  if (!aligned) return;
  Reached(LandingStage::kMatch, "the cells do not look like the tag");
  const Finding finding = Judge(*aligned);
  const double logit = finding.evidence - prior;
  const double quality = 1 / (1 + std::exp(-logit));
  if (quality < models_.options.min_quality) return;
  if (is_found() && quality <= report_.detection->quality) return;
  Reached(LandingStage::kLocate, "no pose explains the edges");
  Report(finding, quality, method);
}

void TagSearch::ResolveMirror(Finding* finding, std::optional<RigidTransform>* mirror) {
  AlignedBoard& best = finding->aligned;
  std::optional<AlignedBoard> other = models_.alignment.Align(
      image_, MirrorPose(best.camera_from_board), prior_, nullptr, &buffers_.alignment);
  if (!other) return;
  const double apart =
      best.camera_from_board.rotation.angularDistance(other->camera_from_board.rotation);
  constexpr double kApart = Radians(0.5);  // else both starts led to the same pose
  if (apart < kApart) return;
  double cost = CostAbove(best, *other);
  if (cost < 0) {
    std::swap(best, *other);
    cost = -cost;
  }
  if (cost < kMirrorCost) *mirror = other->camera_from_board;
}

void TagSearch::Report(const Finding& judged, double quality, DetectionMethod method) {
  Finding finding = judged;
  LandingDetection detection{};
  ResolveMirror(&finding, &detection.mirror_camera_from_pattern);
  const AlignedBoard& aligned = finding.aligned;
  detection.camera_from_pattern = aligned.camera_from_board;
  const Eigen::Vector3d& center = aligned.camera_from_board.translation;
  if (models_.camera.Project(center, &detection.center_px) == ProjectionStatus::kOutsideModel) {
    detection.center_px.setConstant(NAN);
  }
  detection.covariance = aligned.covariance;
  detection.method = method;
  detection.quality = quality;
  const double focal_px = models_.camera.intrinsics().fx_px;
  double largest = 0;
  for (const SeenPart& part : finding.parts.all()) largest = std::max(largest, part.size_px);
  const Eigen::Vector3d face = aligned.camera_from_board.rotation * Eigen::Vector3d::UnitZ();
  const double slant = std::abs(face.dot(center)) / center.norm();
  detection.semi_minor_px = 0.5 * largest;
  detection.semi_major_px = std::min(0.5 * largest / std::max(slant, 0.01),
                                     focal_px * models_.board.radius_m / center.norm());
  detection.semi_major_px = std::max(detection.semi_major_px, detection.semi_minor_px);
  detection.id = models_.board.tags.front().id;
  detection.heading_symmetry = 1;
  detection.parts = finding.parts;
  detection.misfit_px = aligned.rms_px;
  detection.misfit_bound_px = kMisfitBoundPx;
  report_.detection = detection;
}

}  // namespace kestrel
