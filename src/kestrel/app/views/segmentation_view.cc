// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/views/segmentation_view.h"

#include <algorithm>

#include <opencv2/imgproc.hpp>

namespace kestrel {
namespace {

// Brightness of background pixels and of ambiguous ones, relative to the image's.
constexpr double kBackgroundLight = 0.3, kAmbiguousLight = 0.6;

// The colour of the heaviest component at full brightness.
cv::Vec3b ShownColor(const ColorMixture& color) {
  const auto heaviest = std::max_element(
      color.components.begin(), color.components.end(),
      [](const ColorComponent& a, const ColorComponent& b) { return a.weight < b.weight; });
  const Hsv& mean = heaviest->mean;
  const cv::Mat hsv(1, 1, CV_32FC3, cv::Scalar(mean.hue_deg, mean.saturation, 1));
  cv::Mat bgr;
  cv::cvtColor(hsv, bgr, cv::COLOR_HSV2BGR);
  return 255 * bgr.at<cv::Vec3f>(0, 0);
}

// True when the detector looks for the white digit of a cuboid of this colour.
bool HasDigit(const ObjectModel& model, std::size_t color) {
  return std::any_of(model.classes.begin(), model.classes.end(), [&](const ObjectClass& object) {
    return object.color == color && object.shape == ObjectShape::kCuboid;
  });
}

}  // namespace

SegmentationView::SegmentationView(const ObjectModel& model, const ObjectDetectorOptions& options)
    : model_(model), grid_(model.colors), min_pixels_(options.min_pixels) {
  for (const ColorMixture& color : model.colors.colors) colors_.push_back(ShownColor(color));
}

cv::Mat SegmentationView::Draw(const cv::Mat& image) {
  if (image.empty() || image.type() != CV_8UC3) return {};
  cv::Mat gray, view;
  cv::cvtColor(image, gray, cv::COLOR_BGR2GRAY);
  cv::cvtColor(gray, view, cv::COLOR_GRAY2BGR);
  DrawLabels(image, &view);
  DrawSegments(image, &view);
  return view;
}

void SegmentationView::DrawLabels(const cv::Mat& image, cv::Mat* view) const {
  for (int v = 0; v < image.rows; ++v) {
    const auto* const pixel = image.ptr<cv::Vec3b>(v);
    auto* const drawn = view->ptr<cv::Vec3b>(v);
    for (int u = 0; u < image.cols; ++u) {
      const ColorLabel label = grid_.At(pixel[u].val);
      if (label == kAmbiguousLabel) {
        drawn[u] *= kAmbiguousLight;
      } else if (label == kBackgroundLabel) {
        drawn[u] *= kBackgroundLight;
      } else {
        drawn[u] = 0.5 * colors_[label - 1];
      }
    }
  }
}

void SegmentationView::DrawSegments(const cv::Mat& image, cv::Mat* view) {
  SegmentSearch search(image, grid_, &workspace_);
  search.SearchAll(SearchStep(static_cast<int>(min_pixels_)));
  Segment segment;
  while (search.Next(&segment)) {
    if (segment.pixels.size() < min_pixels_) continue;
    const std::size_t color = segment.label - 1;
    if (HasDigit(model_, color)) search.JoinAmbiguous(&segment);
    for (const PixelPosition& at : segment.pixels) {
      view->at<cv::Vec3b>(at.v, at.u) = colors_[color];
    }
  }
}

}  // namespace kestrel
