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

// The marked pixels of a frame (BGR) for one colour: those that are of it, and those that are of
// another one or of none.
struct FrameMarks {
  std::size_t frame = 0;
  std::vector<cv::Vec3b> wanted;
  std::vector<cv::Vec3b> others;
};

// Which pixels of which frames are marked as what. Where strokes overlap the later one holds.
class MarkedPixels {
 public:
  // Gives the image of a frame, CV_8UC3 (BGR), as it was taken. Throws InputError when it cannot.
  using ReadFrame = std::function<cv::Mat(std::size_t frame)>;

  // Frames stay in memory while they are marked.
  static constexpr std::size_t kMaxFrames = 32;

  explicit MarkedPixels(ReadFrame read) : read_(std::move(read)) {}

  // Throws InputError when a frame cannot be read, a stroke is not inside of it, or there are marks
  // on too many frames; what was marked is then as it was.
  void Set(std::span<const ColorStroke> strokes);

  // Of the frame's pixels the number of their stroke, from 1, or 0: CV_16UC1; empty when nothing of
  // the frame is marked.
  cv::Mat StrokesOn(std::size_t frame) const;

  // By frame, in order; of a frame at most 10,000 pixels of each kind, evenly taken.
  std::vector<FrameMarks> Of(const std::string& color) const;

 private:
  struct MarkedFrame {
    cv::Mat image;
    cv::Mat stroke;  // CV_16UC1: number of the pixel's stroke, from 1; 0: unmarked
  };

  MarkedFrame Open(std::size_t frame) const;

  ReadFrame read_;
  std::map<std::size_t, MarkedFrame> frames_;
  std::vector<std::string> colors_;  // of the strokes
};

}  // namespace kestrel
