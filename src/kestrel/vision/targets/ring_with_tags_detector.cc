// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/targets/ring_with_tags_detector.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

#include "kestrel/core/base/options.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/vision/tags/board_model.h"
#include "kestrel/vision/tags/board_reading.h"
#include "kestrel/vision/tags/tag_search.h"

namespace kestrel {
namespace {

constexpr int kHeadings = LandingPattern::kArms;  // under which the ring looks the same

struct RingWithTagsWorkspace final : TagSearchBuffers {
  RingWithTagsWorkspace(TagSearchBuffers&& tags, std::unique_ptr<TargetWorkspace> of_ring)
      : TagSearchBuffers(std::move(tags)), ring(std::move(of_ring)) {}

  std::unique_ptr<TargetWorkspace> ring;
};

RigidTransform Turned(const RigidTransform& camera_from_target, int quarters) {
  if (quarters == 0) return camera_from_target;
  const Eigen::AngleAxisd turn(quarters * kPi / 2, Eigen::Vector3d::UnitZ());
  return {camera_from_target.rotation * turn, camera_from_target.translation};
}

// Adds the work of a search to that of another one in the same image.
void AddWork(const TargetReport& other, TargetReport* report) {
  for (int stage = 0; stage < kLandingStageCount; ++stage) {
    report->diagnostics.candidates[stage] += other.diagnostics.candidates[stage];
    report->diagnostics.stage_ns[stage] += other.diagnostics.stage_ns[stage];
  }
}

// The tags in one of the ring's headings.
struct Heading {
  int quarters = 0;  // turns from the ring's pose
  SeenParts tags;
};

}  // namespace

TargetShape ShapeOf(const LandingPattern& ring, const TagBoard& board) {
  TargetShape shape = ShapeOf(ring);
  TargetShape tags = ShapeOf(board);
  shape.board_size_m = std::max(shape.board_size_m, tags.board_size_m);
  shape.tags = std::move(tags.tags);
  return shape;
}

struct RingWithTagsDetector::Impl {
  Impl(const CameraModel& camera, const LandingPatternDetectorOptions& of_ring,
       const TagBoard& of_board, const TagBoardDetectorOptions& of_tags)
      : ring(camera, of_ring),
        tags(camera, of_board, of_tags),
        min_quality(of_tags.min_quality),
        board(of_board),
        others(of_board),
        shape(ShapeOf(of_ring.pattern, of_board)) {}

  // Returns the heading in which tags are read; nothing where none is likely enough.
  std::optional<Heading> ReadHeading(const cv::Mat& image, const RigidTransform& ring_pose,
                                     PadSamples* samples) const;
  // Returns whether another pad's tags are in the place of tags that are not read.
  bool IsAnotherPad(const cv::Mat& image, const RigidTransform& ring_pose,
                    const std::optional<Heading>& heading, PadSamples* samples) const;
  // Completes the report of a ring that was found.
  void Identify(const cv::Mat& image, PadSamples* samples, TargetReport* report) const;

  LandingPatternDetector ring;
  TagBoardDetector tags;
  double min_quality;
  BoardModel board;
  OtherTags others;
  TargetShape shape;
};

std::optional<Heading> RingWithTagsDetector::Impl::ReadHeading(const cv::Mat& image,
                                                               const RigidTransform& ring_pose,
                                                               PadSamples* samples) const {
  Heading best;
  double most = 0;
  double sum = std::exp(kExpectedOdds);  // sum of the likelihoods, that of no tag included
  for (int quarters = 0; quarters < kHeadings; ++quarters) {
    const BoardReading reading =
        ReadBoard(image, ring.camera(), board, Turned(ring_pose, quarters), samples);
    const double likelihood = std::exp(reading.evidence);
    sum += likelihood;
    if (likelihood <= most) continue;
    most = likelihood;
    best = {quarters, reading.parts};
  }
  if (best.tags.all().empty() || most / sum < min_quality) return std::nullopt;
  return best;
}

bool RingWithTagsDetector::Impl::IsAnotherPad(const cv::Mat& image, const RigidTransform& ring_pose,
                                              const std::optional<Heading>& heading,
                                              PadSamples* samples) const {
  if (heading) {
    return others.IsRead(image, ring.camera(), board, Turned(ring_pose, heading->quarters),
                         heading->tags, samples);
  }
  for (int quarters = 0; quarters < kHeadings; ++quarters) {
    if (others.IsRead(image, ring.camera(), board, Turned(ring_pose, quarters), {}, samples)) {
      return true;
    }
  }
  return false;
}

void RingWithTagsDetector::Impl::Identify(const cv::Mat& image, PadSamples* samples,
                                          TargetReport* report) const {
  TargetDetection& detection = *report->detection;
  const RigidTransform ring_pose = detection.camera_from_target;
  const std::optional<Heading> heading = ReadHeading(image, ring_pose, samples);
  if (IsAnotherPad(image, ring_pose, heading, samples)) {
    report->detection.reset();
    report->reached = LandingStage::kMatch;
    report->is_another_pad = true;
    report->reason = "the ring is another pad's: it has another tag of the family";
    return;
  }
  if (!heading) return;
  // The outlines of the ring in 'seen' are the same in all headings.
  detection.camera_from_target = Turned(ring_pose, heading->quarters);
  if (detection.diagnostics.mirror_camera_from_target) {
    detection.diagnostics.mirror_camera_from_target =
        Turned(*detection.diagnostics.mirror_camera_from_target, heading->quarters);
  }
  detection.id = board.tags.front().id;
  detection.heading_symmetry = 1;
  for (const SeenPart& tag : heading->tags.all()) detection.parts.Add(tag);
}

RingWithTagsDetector::RingWithTagsDetector(const CameraModel& camera,
                                           const LandingPatternDetectorOptions& ring,
                                           const TagBoard& board,
                                           const TagBoardDetectorOptions& tags)
    : impl_(std::make_unique<const Impl>(camera, ring, Checked(board), tags)) {}
RingWithTagsDetector::~RingWithTagsDetector() = default;
RingWithTagsDetector::RingWithTagsDetector(RingWithTagsDetector&&) noexcept = default;
RingWithTagsDetector& RingWithTagsDetector::operator=(RingWithTagsDetector&&) noexcept = default;

TargetReport RingWithTagsDetector::Detect(const cv::Mat& image, const TargetHint& hint,
                                          TargetWorkspace& workspace) const {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  auto& memory = dynamic_cast<RingWithTagsWorkspace&>(workspace);
  TargetReport by_ring = impl_->ring.Detect(image, hint, *memory.ring);
  if (by_ring.detection) impl_->Identify(image, &memory.pad.samples, &by_ring);
  if (by_ring.detection) return by_ring;

  // The tags' search gets the time that is left, and always makes its first step.
  constexpr double kLeastMs = 0.1;
  TargetHint of_tags = hint;
  of_tags.first_step = 0;
  const std::chrono::duration<double, std::milli> spent = Clock::now() - start;
  if (hint.max_search_ms > 0) {
    of_tags.max_search_ms = std::max(kLeastMs, hint.max_search_ms - spent.count());
  }
  TargetReport by_tags = impl_->tags.Detect(image, of_tags, memory);
  if (!by_tags.detection) {
    AddWork(by_tags, &by_ring);
    return by_ring;
  }
  AddWork(by_ring, &by_tags);
  return by_tags;
}

std::unique_ptr<TargetWorkspace> RingWithTagsDetector::MakeWorkspace() const {
  const std::unique_ptr<TargetWorkspace> tags = impl_->tags.MakeWorkspace();
  return std::make_unique<RingWithTagsWorkspace>(std::move(dynamic_cast<TagSearchBuffers&>(*tags)),
                                                 impl_->ring.MakeWorkspace());
}

const CameraModel& RingWithTagsDetector::camera() const { return impl_->ring.camera(); }
const TargetShape& RingWithTagsDetector::shape() const { return impl_->shape; }

}  // namespace kestrel
