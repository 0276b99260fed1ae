// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/objects/object_detector.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/options.h"
#include "kestrel/vision/objects/examination/object_examiner.h"

namespace kestrel {
namespace {

// Initial room for a frame's detections, so that a report seldom grows.
constexpr std::size_t kUsualDetections = 64;

const CameraModel& Checked(const CameraModel& camera) {
  if (std::max(camera.width_px(), camera.height_px()) > kMaxImageSide) {
    throw InputError(fmt::format("the image has {} x {} px, expected sides up to {}",
                                 camera.width_px(), camera.height_px(), kMaxImageSide));
  }
  return camera;
}

}  // namespace

const char* ToString(Completeness completeness) {
  switch (completeness) {
    case Completeness::kWhole:
      return "whole";
    case Completeness::kCutOff:
      return "cut off";
    case Completeness::kMerged:
      return "merged";
  }
  return "";
}

const char* ToString(ObjectStage stage) {
  constexpr std::array<const char*, kObjectStageCount> kNames = {
      "segmentation", "size", "roundness", "shape", "outline or digit", "position"};
  return kNames[static_cast<std::size_t>(stage)];
}

ObjectWorkspace::ObjectWorkspace() : buffers_(std::make_unique<Buffers>()) {}
ObjectWorkspace::~ObjectWorkspace() = default;
ObjectWorkspace::ObjectWorkspace(ObjectWorkspace&&) noexcept = default;
ObjectWorkspace& ObjectWorkspace::operator=(ObjectWorkspace&&) noexcept = default;

ObjectDetector::ObjectDetector(const CameraModel& camera, const ObjectModel& model,
                               const ObjectDetectorOptions& options)
    : ObjectDetector(camera, Checked(model), ColorGrid(model.colors), options) {}

ObjectDetector::ObjectDetector(const CameraModel& camera, const ObjectModel& model,
                               const ColorGrid& grid, const ObjectDetectorOptions& options) {
  Impl impl{.camera = Checked(camera),
            .rays = RayTable(camera),
            .model = Checked(model),
            .grid = grid,
            .options = Checked(options),
            .digits = DigitClassifier(DefaultDigitModel()),
            .focal_px = 0.5 * (camera.intrinsics().fx_px + camera.intrinsics().fy_px),
            .search_step = SearchStep(options.min_pixels)};
  for (const ObjectClass& object : model.classes) {
    if (object.shape == ObjectShape::kCuboid) impl.has_digit[object.color + 1] = true;
  }
  impl_ = std::make_unique<const Impl>(std::move(impl));
}
ObjectDetector::~ObjectDetector() = default;
ObjectDetector::ObjectDetector(ObjectDetector&&) noexcept = default;
ObjectDetector& ObjectDetector::operator=(ObjectDetector&&) noexcept = default;

const CameraModel& ObjectDetector::camera() const { return impl_->camera; }
const ObjectModel& ObjectDetector::model() const { return impl_->model; }
const ColorGrid& ObjectDetector::grid() const { return impl_->grid; }
const ObjectDetectorOptions& ObjectDetector::options() const { return impl_->options; }

void ObjectDetector::Detect(const cv::Mat& image, const ObjectHint& hint,
                            ObjectWorkspace& workspace, ObjectReport* report) const {
  using Clock = std::chrono::steady_clock;
  for (auto* detections : {&report->detections, &report->elsewhere}) {
    detections->reserve(kUsualDetections);
    detections->clear();
  }
  report->passed.fill(0);
  report->segmentation_time = report->test_time = Duration::zero();
  const Impl& impl = *impl_;
  SegmentSearch search(image, impl.grid, &workspace.buffers_->segmentation);
  ObjectExaminer examiner(impl, image, hint, workspace.buffers_.get(), report);
  Segment segment;
  Clock::time_point last = Clock::now();
  const auto add_time = [&](Duration* time) {
    const Clock::time_point now = Clock::now();
    *time += now - last;
    last = now;
  };
  // Small segments are counted without reading the clock, which would take longer than the count.
  const auto examine = [&] {
    if (static_cast<int>(segment.pixels.size()) < impl.options.min_pixels)
      return examiner.Run(segment);
    if (impl.has_digit[segment.label]) search.JoinAmbiguous(&segment);
    add_time(&report->segmentation_time);
    const bool is_object = examiner.Run(segment);
    add_time(&report->test_time);
    return is_object;
  };
  if (hint.track.empty()) {
    search.SearchAll(impl.search_step);
    while (search.Next(&segment)) examine();
  }
  for (const TrackedObject& object : hint.track) {
    const Eigen::Vector2i at = object.expected_px.array().round().matrix().cast<int>();
    const auto label = static_cast<ColorLabel>(impl.model.classes[object.class_index].color + 1);
    while (search.FindNear(at.x(), at.y(), impl.options.track_radius_px, label, &segment)) {
      if (examine()) break;
    }
  }
  add_time(&report->segmentation_time);
}

}  // namespace kestrel
