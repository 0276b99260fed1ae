// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/calibration/color_training/color_stroke.h"

namespace kestrel {

// The marked pixels of a frame (BGR) for one colour: those of the colour, and those of another
// colour or of none.
struct FrameMarks {
  std::size_t frame = 0;
  std::vector<cv::Vec3b> wanted;
  std::vector<cv::Vec3b> others;
};

// The marks of pixels in frames. Where strokes overlap the later one counts.
class MarkedPixels {
 public:
  // Returns the image of a frame, CV_8UC3 (BGR), as it was taken. Throws InputError when it cannot.
  using ReadFrame = std::function<cv::Mat(std::size_t frame)>;

  // Limit, as the marked frames stay in memory.
  static constexpr std::size_t kMaxFrames = 32;

  explicit MarkedPixels(ReadFrame read) : read_(std::move(read)) {}

  // Throws InputError when a frame cannot be read, a stroke is not inside of its image, or too many
  // frames have marks; the marks are then unchanged.
  void Set(std::span<const ColorStroke> strokes);

  // Returns for each pixel of the frame the number of its stroke, from 1, or 0: CV_16UC1. Empty
  // when the frame has no marks.
  cv::Mat StrokesOn(std::size_t frame) const;

  // Returns the marks by frame, in order; at most 10,000 pixels of each kind per frame, evenly
  // sampled.
  std::vector<FrameMarks> Of(const std::string& color) const;

 private:
  struct MarkedFrame {
    cv::Mat image;
    cv::Mat stroke;  // CV_16UC1: number of the pixel's stroke, from 1; 0: unmarked
  };

  MarkedFrame Open(std::size_t frame) const;

  ReadFrame read_;
  std::map<std::size_t, MarkedFrame> frames_;
  std::vector<std::string> colors_;  // colours of the strokes
};

}  // namespace kestrel
