// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/overlays/object_overlay.h"

#include <cmath>
#include <numbers>
#include <string>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "kestrel/io/recording/overlays/map_inset.h"

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

void DrawDetection(const ObjectDetection& detection, const std::string& label,
                   const cv::Scalar& color, cv::Mat* image) {
  const Ellipse& ellipse = detection.ellipse;
  const double margin_px = 4;
  const cv::RotatedRect box(
      cv::Point2f(static_cast<float>(ellipse.center.x()), static_cast<float>(ellipse.center.y())),
      cv::Size2f(static_cast<float>(2 * (ellipse.semi_major + margin_px)),
                 static_cast<float>(2 * (ellipse.semi_minor + margin_px))),
      static_cast<float>(ellipse.angle * 180 / std::numbers::pi));
  cv::ellipse(*image, box, kBlack, 3, cv::LINE_AA);
  cv::ellipse(*image, box, color, 1, cv::LINE_AA);
  const cv::Point center(static_cast<int>(std::lround(detection.center_px.x())),
                         static_cast<int>(std::lround(detection.center_px.y())));
  cv::drawMarker(*image, center, kBlack, cv::MARKER_CROSS, 7, 1, cv::LINE_AA);
  const cv::Point text(center.x + static_cast<int>(ellipse.semi_major) + 8, center.y);
  for (const auto& [thickness, ink] : {std::pair(3, kBlack), std::pair(1, color)}) {
    cv::putText(*image, label, text, cv::FONT_HERSHEY_SIMPLEX, 0.5, ink, thickness, cv::LINE_AA);
  }
}

cv::Rect BoxOf(const ObjectDetection& detection) {
  const auto radius = static_cast<int>(detection.ellipse.semi_major) + 8;
  const cv::Point center(static_cast<int>(detection.center_px.x()),
                         static_cast<int>(detection.center_px.y()));
  return {center - cv::Point(radius, radius), cv::Size(2 * radius, 2 * radius)};
}

}  // namespace

cv::Mat DrawObjectOverlay(const cv::Mat& image, const ObjectModel& model,
                          const HuntObservation& observation,
                          const std::vector<MappedObject>& mapped) {
  cv::Mat drawn = image.clone();
  std::vector<cv::Rect> seen;
  for (const ObjectDetection& detection : observation.report.detections) {
    const bool is_whole = detection.completeness == Completeness::kWhole;
    DrawDetection(detection, Label(detection, model), is_whole ? kWhite : kGray, &drawn);
    seen.push_back(BoxOf(detection));
  }
  for (const ObjectDetection& decoy : observation.report.elsewhere) {
    DrawDetection(decoy, Label(decoy, model) + ": by its size not on the ground", kGray, &drawn);
    seen.push_back(BoxOf(decoy));
  }
  if (const auto& pose = observation.world_from_camera) {
    DrawMapInset(mapped, model, pose->translation.head<2>(), seen, &drawn);
  }
  return drawn;
}

}  // namespace kestrel
