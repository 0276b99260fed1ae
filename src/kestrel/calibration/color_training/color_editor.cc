// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/color_training/color_editor.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"

namespace kestrel {

ColorEditor::ColorEditor(ObjectModel model, std::size_t frame_count, MarkedPixels::ReadFrame read)
    : model_(std::move(model)),
      grid_(model_.colors),
      frame_count_(frame_count),
      pixels_(std::move(read)) {}

void ColorEditor::Mark(const ColorStroke& stroke) {
  ColorDraft draft = draft_;
  draft.Add(stroke);
  Replace(std::move(draft));
}

bool ColorEditor::Undo() {
  ColorDraft draft = draft_;
  if (!draft.Undo()) return false;
  Replace(std::move(draft));
  return true;
}

bool ColorEditor::Redo() {
  ColorDraft draft = draft_;
  if (!draft.Redo()) return false;
  Replace(std::move(draft));
  return true;
}

void ColorEditor::Replace(ColorDraft draft) {
  for (const ColorStroke& stroke : draft.strokes()) {
    if (frame_count_ == 0) throw InputError("there is no frame to be marked");
    if (stroke.frame >= frame_count_) {
      throw InputError(
          fmt::format("frame {} is marked, expected 0 to {}", stroke.frame, frame_count_ - 1));
    }
    if (!stroke.color.empty()) IndexOf(stroke.color);
  }
  pixels_.Set(draft.strokes());
  draft_ = std::move(draft);
}

std::size_t ColorEditor::IndexOf(const std::string& color) const {
  const std::vector<ColorMixture>& colors = model_.colors.colors;
  const auto found = std::find_if(colors.begin(), colors.end(),
                                  [&](const ColorMixture& one) { return one.name == color; });
  if (found != colors.end()) return static_cast<std::size_t>(found - colors.begin());
  throw InputError(fmt::format("'{}' is none of the model's colors", color));
}

void ColorEditor::Teach(const std::string& color) {
  ObjectModel taught = model_;
  ColorModel& colors = taught.colors;
  const std::size_t index = IndexOf(color);
  colors.colors[index] = TeachColor(color, pixels_.Of(color), colors.max_distance);
  const std::vector<std::string> violations = taught.Validate();
  if (!violations.empty()) throw InputError(fmt::format("{}", fmt::join(violations, "; ")));
  RequireDistinct(colors, index);
  grid_ = ColorGrid(colors);
  model_ = std::move(taught);
}

ColorScores ColorEditor::Scores(const std::string& color) const {
  return ScoreColor(model_.colors, grid_, IndexOf(color), pixels_.Of(color));
}

std::vector<std::string> ColorEditor::Warnings(const std::string& color) const {
  IndexOf(color);
  return TeachingWarnings(pixels_.Of(color));
}

HueSaturationHistogram ColorEditor::Histogram(const std::string& color) const {
  IndexOf(color);
  HueSaturationHistogram histogram;
  for (const FrameMarks& marks : pixels_.Of(color)) {
    for (const cv::Vec3b& pixel : marks.wanted) {
      histogram.Add(HsvFromBgr(pixel[0], pixel[1], pixel[2]));
    }
  }
  return histogram;
}

cv::Mat ColorEditor::Marks(std::size_t frame) const {
  const cv::Mat strokes = pixels_.StrokesOn(frame);
  std::vector<ColorLabel> labels = {kBackgroundLabel};
  for (const ColorStroke& stroke : draft_.strokes()) {
    labels.push_back(stroke.color.empty() ? kAmbiguousLabel
                                          : static_cast<ColorLabel>(IndexOf(stroke.color) + 1));
  }
  cv::Mat marks(strokes.size(), CV_8UC1);
  for (int v = 0; v < strokes.rows; ++v) {
    const auto* stroke = strokes.ptr<std::uint16_t>(v);
    auto* mark = marks.ptr<ColorLabel>(v);
    for (int u = 0; u < strokes.cols; ++u) mark[u] = labels[stroke[u]];
  }
  return marks;
}

void ColorEditor::SetModel(ObjectModel model) {
  grid_ = ColorGrid(model.colors);
  model_ = std::move(model);
}

cv::Mat ColorEditor::Labels(const cv::Mat& image) const {
  cv::Mat labels(image.size(), CV_8UC1);
  for (int v = 0; v < image.rows; ++v) {
    const auto* pixel = image.ptr<cv::Vec3b>(v);
    auto* label = labels.ptr<ColorLabel>(v);
    for (int u = 0; u < image.cols; ++u) label[u] = grid_.At(pixel[u].val);
  }
  return labels;
}

}  // namespace kestrel
