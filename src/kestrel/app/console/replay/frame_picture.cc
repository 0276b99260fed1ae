// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/replay/frame_picture.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace kestrel {
namespace {

// OpenCV draws lines in fixed point; here to a sixteenth of a pixel.
constexpr int kFractionBits = 4;
constexpr float kFraction = 1 << kFractionBits;
constexpr int kMark_px = 7;

// Colours of the page (web/src/overlay.ts); BGR.
cv::Scalar ColorOf(OverlayLayer layer) {
  switch (layer) {
    case OverlayLayer::kDetection:
      return {110, 255, 61};
    case OverlayLayer::kPrediction:
      return {255, 200, 92};
    case OverlayLayer::kRejected:
      return {92, 122, 255};
    case OverlayLayer::kTruth:
      return {255, 255, 255};
    case OverlayLayer::kSecond:
      return {74, 216, 255};
  }
  return {};
}

// Layers of a second run that are drawn over the first run's shapes.
bool IsFound(OverlayLayer layer) {
  return layer == OverlayLayer::kDetection || layer == OverlayLayer::kRejected;
}

// Limits points far outside of the image; lines to them keep nearly their direction.
cv::Point FixedPoint(const cv::Point2f& point) {
  constexpr float kFar = 1e4F;
  const auto fixed = [&](float value) {
    return cvRound(kFraction * std::clamp(std::isfinite(value) ? value : kFar, -kFar, kFar));
  };
  return {fixed(point.x), fixed(point.y)};
}

void Draw(const OverlayShape& shape, const std::string& label, const cv::Scalar& color,
          cv::Mat* picture) {
  if (shape.outline.empty()) return;
  std::vector<cv::Point> outline;
  for (const cv::Point2f& point : shape.outline) outline.push_back(FixedPoint(point));
  if (outline.size() == 1) {
    const cv::Point center(outline[0].x >> kFractionBits, outline[0].y >> kFractionBits);
    cv::drawMarker(*picture, center, color, cv::MARKER_CROSS, 2 * kMark_px, 1);
  } else {
    cv::polylines(*picture, outline, shape.is_closed, color, 1, cv::LINE_AA, kFractionBits);
  }
  if (label.empty()) return;
  const cv::Point corner = cv::boundingRect(outline).tl();
  constexpr int kLineHeight_px = 14;
  const cv::Point at(std::max(corner.x >> kFractionBits, 2),
                     std::max((corner.y >> kFractionBits) - kMark_px, kLineHeight_px));
  constexpr double kFontScale = 0.45;
  cv::putText(*picture, label, at, cv::FONT_HERSHEY_SIMPLEX, kFontScale, cv::Scalar(0, 0, 0), 3,
              cv::LINE_AA);
  cv::putText(*picture, label, at, cv::FONT_HERSHEY_SIMPLEX, kFontScale, color, 1, cv::LINE_AA);
}

}  // namespace

cv::Mat WithShapes(const cv::Mat& image, const std::vector<OverlayShape>& shapes) {
  cv::Mat picture;
  if (image.channels() == 1) {
    cv::cvtColor(image, picture, cv::COLOR_GRAY2BGR);
  } else {
    picture = image.clone();
  }
  for (const OverlayShape& shape : shapes) {
    if (shape.run == 1) Draw(shape, shape.label, ColorOf(shape.layer), &picture);
    if (shape.run == 1 || !IsFound(shape.layer)) continue;
    const std::string label = shape.label.empty() ? "" : "second: " + shape.label;
    Draw(shape, label, ColorOf(OverlayLayer::kSecond), &picture);
  }
  return picture;
}

}  // namespace kestrel
