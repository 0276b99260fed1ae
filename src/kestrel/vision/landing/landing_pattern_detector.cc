// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/landing_pattern_detector.h"

#include <string_view>

#include "kestrel/core/base/options.h"
#include "kestrel/vision/landing/landing_search.h"

namespace kestrel {

LandingWorkspace::LandingWorkspace() : buffers_(std::make_unique<Buffers>()) {}
LandingWorkspace::~LandingWorkspace() = default;
LandingWorkspace::LandingWorkspace(LandingWorkspace&&) noexcept = default;
LandingWorkspace& LandingWorkspace::operator=(LandingWorkspace&&) noexcept = default;

struct LandingPatternDetector::Impl : LandingModels {
  Impl(const CameraModel& camera_model, const LandingPatternDetectorOptions& all_options)
      : LandingModels(camera_model, all_options), shape(ShapeOf(all_options.pattern)) {}

  TargetShape shape;
};

LandingPatternDetector::LandingPatternDetector(const CameraModel& camera,
                                               const LandingPatternDetectorOptions& options)
    : impl_(std::make_unique<const Impl>(camera, Checked(options))) {}
LandingPatternDetector::~LandingPatternDetector() = default;
LandingPatternDetector::LandingPatternDetector(LandingPatternDetector&&) noexcept = default;
LandingPatternDetector& LandingPatternDetector::operator=(LandingPatternDetector&&) noexcept =
    default;
const CameraModel& LandingPatternDetector::camera() const { return impl_->camera; }
const TargetShape& LandingPatternDetector::shape() const { return impl_->shape; }
const LandingPatternDetectorOptions& LandingPatternDetector::options() const {
  return impl_->options;
}

std::unique_ptr<TargetWorkspace> LandingPatternDetector::MakeWorkspace() const {
  return std::make_unique<LandingWorkspace>();
}

TargetReport LandingPatternDetector::Detect(const cv::Mat& image, const TargetHint& hint,
                                            TargetWorkspace& workspace) const {
  const auto failure = [](std::string_view reason) {
    TargetReport report;
    report.reason = reason;
    return report;
  };
  auto* const memory = dynamic_cast<LandingWorkspace*>(&workspace);
  if (memory == nullptr) return failure("the workspace is another detector's");
  if (image.type() != CV_8UC1 || image.cols != camera().width_px() ||
      image.rows != camera().height_px()) {
    return failure("the image is not 8-bit gray or not of the camera's size");
  }
  return LandingSearch(*impl_, image, hint, memory->buffers_.get()).Run();
}

}  // namespace kestrel
