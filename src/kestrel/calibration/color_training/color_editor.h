// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/calibration/color_training/color_draft.h"
#include "kestrel/calibration/color_training/color_teaching.h"
#include "kestrel/calibration/color_training/marked_pixels.h"
#include "kestrel/vision/objects/color/color_grid.h"
#include "kestrel/vision/objects/color/color_samples.h"
#include "kestrel/vision/objects/object_model.h"

namespace kestrel {

// A model whose colours a person changes by marking pixels in the frames of a recording (paper,
// section 3.2). Used by one thread. A function that throws changes nothing.
class ColorEditor {
 public:
  // 'model' is valid. Frames are numbered from 0 to frame_count - 1.
  ColorEditor(ObjectModel model, std::size_t frame_count, MarkedPixels::ReadFrame read);

  // Announces one more frame.
  void AddFrame() { ++frame_count_; }

  // Throws InputError for a stroke that is not valid, belongs to a frame that does not exist, lies
  // outside of the image or has a colour that is not in the model, and when there are too many.
  void Mark(const ColorStroke& stroke);
  // Return false when there is nothing to undo or to redo. Throw InputError when a frame cannot be
  // read again.
  bool Undo();
  bool Redo();
  // Replaces all marks. Throws as Mark does.
  void Restore(const ColorDraft& draft) { Replace(draft); }
  const ColorDraft& draft() const { return draft_; }

  // Fits the model's colour to the marks. Throws InputError for a colour that the model does not
  // have, for fewer than ten marked pixels, and for a colour that contradicts another one of the
  // model or cannot be distinguished from it.
  void Teach(const std::string& color);

  // For a colour of the model; throw InputError when it has none with this name.
  ColorScores Scores(const std::string& color) const;
  std::vector<std::string> Warnings(const std::string& color) const;
  HueSaturationHistogram Histogram(const std::string& color) const;  // its marked pixels

  // Inputs of ScoreColor besides model and grid, for callers that score in a thread of their own.
  std::vector<FrameMarks> MarksFor(const std::string& color) const { return pixels_.Of(color); }
  std::size_t IndexOf(const std::string& color) const;

  // Returns the marks of a frame's pixels, CV_8UC1: labels as in the grid, background where nothing
  // is marked, ambiguous where the mark excludes all colours. Empty when the frame has no
  // marks.
  cv::Mat Marks(std::size_t frame) const;

  // Replaces the model by another valid one with the same colours.
  void SetModel(ObjectModel model);

  // Returns how the detector labels each pixel: ColorLabel, CV_8UC1. 'image' is CV_8UC3.
  cv::Mat Labels(const cv::Mat& image) const;

  const ObjectModel& model() const { return model_; }
  const ColorGrid& grid() const { return grid_; }

 private:
  void Replace(ColorDraft draft);

  ObjectModel model_;
  ColorGrid grid_;  // grid of the model
  std::size_t frame_count_;
  ColorDraft draft_;
  MarkedPixels pixels_;  // pixels of the draft
};

}  // namespace kestrel
