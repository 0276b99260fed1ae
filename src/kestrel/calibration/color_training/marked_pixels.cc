// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/color_training/marked_pixels.h"

#include <cstdint>
#include <utility>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

void ThinOut(std::vector<cv::Vec3b>* pixels) {
  constexpr std::size_t kMaxPixels = 10'000;
  if (pixels->size() <= kMaxPixels) return;
  for (std::size_t i = 0; i < kMaxPixels; ++i) {
    (*pixels)[i] = (*pixels)[i * pixels->size() / kMaxPixels];
  }
  pixels->resize(kMaxPixels);
}

}  // namespace

MarkedPixels::MarkedFrame MarkedPixels::Open(std::size_t frame) const {
  const auto known = frames_.find(frame);
  MarkedFrame opened;
  opened.image = known == frames_.end() ? read_(frame) : known->second.image;
  opened.stroke = cv::Mat::zeros(opened.image.size(), CV_16UC1);
  return opened;
}

void MarkedPixels::Set(std::span<const ColorStroke> strokes) {
  std::map<std::size_t, MarkedFrame> frames;
  std::vector<std::string> colors;
  for (const ColorStroke& stroke : strokes) {
    colors.push_back(stroke.color);
    if (!frames.contains(stroke.frame)) {
      if (frames.size() >= kMaxFrames) {
        throw InputError(fmt::format("{} frames are marked, at most as many", kMaxFrames));
      }
      frames.emplace(stroke.frame, Open(stroke.frame));
    }
    MarkedFrame& marked = frames.at(stroke.frame);
    marked.stroke.setTo(static_cast<double>(colors.size()), StrokeMask(stroke, marked.image));
  }
  frames_ = std::move(frames);
  colors_ = std::move(colors);
}

cv::Mat MarkedPixels::StrokesOn(std::size_t frame) const {
  const auto found = frames_.find(frame);
  return found == frames_.end() ? cv::Mat() : found->second.stroke;
}

std::vector<FrameMarks> MarkedPixels::Of(const std::string& color) const {
  std::vector<FrameMarks> marks;
  for (const auto& [number, frame] : frames_) {
    FrameMarks& of_frame = marks.emplace_back();
    of_frame.frame = number;
    for (int v = 0; v < frame.image.rows; ++v) {
      const auto* stroke = frame.stroke.ptr<std::uint16_t>(v);
      const auto* pixel = frame.image.ptr<cv::Vec3b>(v);
      for (int u = 0; u < frame.image.cols; ++u) {
        if (stroke[u] == 0) continue;
        const bool is_wanted = colors_[stroke[u] - 1] == color;
        (is_wanted ? of_frame.wanted : of_frame.others).push_back(pixel[u]);
      }
    }
    ThinOut(&of_frame.wanted);
    ThinOut(&of_frame.others);
  }
  return marks;
}

}  // namespace kestrel
