// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/object_overlay.h"

#include <cmath>
#include <numbers>
#include <string>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

namespace kestrel {
namespace {

const cv::Scalar kWhite(255, 255, 255);
const cv::Scalar kGray(170, 170, 170);
const cv::Scalar kBlack(0, 0, 0);

std::string Label(const ObjectDetection& detection, const ObjectModel& model) {
  std::string text = model.classes[detection.class_index].name;
  if (detection.completeness != Completeness::kWhole) {
    text += fmt::format(", {}", ToString(detection.completeness));
  }
  if (detection.digits) text += fmt::format(" {}", LikeliestDigit(*detection.digits).digit);
  if (detection.location) text += fmt::format(" {:.2f} m", detection.location->position.norm());
  return text;
}

void DrawDetection(const ObjectDetection& detection, const ObjectModel& model, cv::Mat* image) {
  const Ellipse& ellipse = detection.ellipse;
  const double margin_px = 4;
  const cv::RotatedRect box(
      cv::Point2f(static_cast<float>(ellipse.center.x()), static_cast<float>(ellipse.center.y())),
      cv::Size2f(static_cast<float>(2 * (ellipse.semi_major + margin_px)),
                 static_cast<float>(2 * (ellipse.semi_minor + margin_px))),
      static_cast<float>(ellipse.angle * 180 / std::numbers::pi));
  const bool is_whole = detection.completeness == Completeness::kWhole;
  const cv::Scalar& color = is_whole ? kWhite : kGray;
  cv::ellipse(*image, box, kBlack, 3, cv::LINE_AA);
  cv::ellipse(*image, box, color, 1, cv::LINE_AA);
  const cv::Point center(static_cast<int>(std::lround(detection.center_px.x())),
                         static_cast<int>(std::lround(detection.center_px.y())));
  cv::drawMarker(*image, center, kBlack, cv::MARKER_CROSS, 7, 1, cv::LINE_AA);
  const cv::Point text(center.x + static_cast<int>(ellipse.semi_major) + 8, center.y);
  for (const auto& [thickness, ink] : {std::pair(3, kBlack), std::pair(1, color)}) {
    cv::putText(*image, Label(detection, model), text, cv::FONT_HERSHEY_SIMPLEX, 0.5, ink,
                thickness, cv::LINE_AA);
  }
}

}  // namespace

cv::Mat DrawObjectOverlay(const cv::Mat& image, const ObjectModel& model,
                          const HuntObservation& observation) {
  cv::Mat drawn = image.clone();
  for (const ObjectDetection& detection : observation.report.detections) {
    DrawDetection(detection, model, &drawn);
  }
  return drawn;
}

}  // namespace kestrel
