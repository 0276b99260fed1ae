// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/landing_pattern_detector.h"

#include <string_view>

#include "kestrel/core/base/error.h"
#include "kestrel/vision/landing/landing_search.h"

namespace kestrel {

std::vector<std::string> LandingPatternDetectorOptions::Validate() const {
  std::vector<std::string> violations;
  for (const std::string& violation : pattern.Validate()) {
    violations.push_back("pattern." + violation);
  }
  if (!(min_ring_px >= 4 && min_ring_px <= 1000)) {
    violations.push_back("min_ring_px: must be 4 to 1000");
  }
  if (!(min_quality >= 0 && min_quality <= 1)) {
    violations.push_back("min_quality: must be 0 to 1");
  }
  if (!(level_sigma_deg > 0 && level_sigma_deg <= 90)) {
    violations.push_back("level_sigma_deg: must be positive, 90 at most");
  }
  if (!(max_partial_altitude_m >= 0)) {
    violations.push_back("max_partial_altitude_m: must not be negative");
  }
  if (!(max_search_ms >= 0)) violations.push_back("max_search_ms: must not be negative");
  return violations;
}

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
                                               const LandingPatternDetectorOptions& options) {
  const std::vector<std::string> violations = options.Validate();
  if (!violations.empty()) {
    std::string message = "landing pattern detector: ";
    for (std::size_t i = 0; i < violations.size(); ++i) {
      message += (i == 0 ? "" : "; ") + violations[i];
    }
    throw InputError(message);
  }
  impl_ = std::make_unique<const Impl>(camera, options);
}
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

LandingReport LandingPatternDetector::Detect(const cv::Mat& image, const LandingHint& hint,
                                             TargetWorkspace& workspace) const {
  const auto failure = [](std::string_view reason) {
    LandingReport report;
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
