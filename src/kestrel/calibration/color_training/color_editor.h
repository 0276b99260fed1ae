// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/calibration/color_training/color_draft.h"
#include "kestrel/calibration/color_training/color_teaching.h"
#include "kestrel/calibration/color_training/marked_pixels.h"
#include "kestrel/vision/objects/color_grid.h"
#include "kestrel/vision/objects/color_samples.h"
#include "kestrel/vision/objects/object_model.h"

namespace kestrel {

// A model whose colours a person changes by marking pixels in the frames of a recording (paper,
// section 3.2). By one thread. What throws leaves everything as it was.
class ColorEditor {
 public:
  // 'model' is valid. Frames are numbered from 0 to frame_count - 1.
  ColorEditor(ObjectModel model, std::size_t frame_count, MarkedPixels::ReadFrame read);

  // There is one frame more.
  void AddFrame() { ++frame_count_; }

  // Throws InputError for a stroke that is not valid, of a frame that is not there, outside of the
  // image or of a colour that the model does not have, and for one too many.
  void Mark(const ColorStroke& stroke);
  // False: there is nothing to undo, to redo. Throw InputError when a frame cannot be read again.
  bool Undo();
  bool Redo();
  // In the place of all that is marked. Throws as Mark.
  void Restore(const ColorDraft& draft) { Replace(draft); }
  const ColorDraft& draft() const { return draft_; }

  // Teaches the model the colour. Throws InputError for one that the model does not have, fewer
  // than ten pixels that are marked so, and a colour that contradicts another one of the model or
  // cannot be told from it.
  void Teach(const std::string& color);

  // Of a colour of the model; throw InputError when it has none of that name.
  ColorScores Scores(const std::string& color) const;
  std::vector<std::string> Warnings(const std::string& color) const;
  HueSaturationHistogram Histogram(const std::string& color) const;  // of what is marked so

  // What ScoreColor needs beside model and grid, for who does that in a thread of its own.
  std::vector<FrameMarks> MarksFor(const std::string& color) const { return pixels_.Of(color); }
  std::size_t IndexOf(const std::string& color) const;

  // What the pixels of a frame are marked as: labels as of the grid, background where nothing is
  // marked, ambiguous where it is none of the colours. CV_8UC1; empty when nothing of the frame is
  // marked.
  cv::Mat Marks(std::size_t frame) const;

  // A valid model of the same colours, in the place of what was taught.
  void SetModel(ObjectModel model);

  // What the detector takes each pixel for: ColorLabel, CV_8UC1. 'image' is CV_8UC3.
  cv::Mat Labels(const cv::Mat& image) const;

  const ObjectModel& model() const { return model_; }
  const ColorGrid& grid() const { return grid_; }

 private:
  void Replace(ColorDraft draft);

  ObjectModel model_;
  ColorGrid grid_;  // of the model
  std::size_t frame_count_;
  ColorDraft draft_;
  MarkedPixels pixels_;  // of the draft
};

}  // namespace kestrel
