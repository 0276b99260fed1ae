// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/app/console/messages/color_request.h"
#include "kestrel/app/console/messages/color_state.h"
#include "kestrel/app/console/messages/export_request.h"
#include "kestrel/calibration/color_training/color_editor.h"
#include "kestrel/core/codec/jpeg_codec.h"

namespace kestrel {

// The frames and the model that a session of teaching works on.
struct ColorSource {
  std::string recording;    // name that identifies it
  std::size_t frame_count;  // at least 1; 0 for a live camera
  // Returns the frame's image as it was taken, CV_8UC3. Throws InputError when it cannot.
  MarkedPixels::ReadFrame read;
  ObjectModel model;  // initial model
  // Folder for the model, its versions and the draft; created when something is saved.
  std::string folder;
  // For a live camera only: keeps its newest image as an additional frame for 'read' and returns a
  // sentence that confirms it; throws InputError when it cannot.
  std::function<std::string()> keep = {};
  // For a live camera only: returns what the camera adjusts by itself, one sentence each.
  std::function<std::vector<std::string>()> warn = {};
};

// Teaches the colours of a model on request: a ColorEditor whose draft is saved to a file after
// every change. Call it from one thread.
class ColorSession {
 public:
  // Continues the recording's draft if the folder has one. Throws InputError when that file is not
  // a valid draft.
  explicit ColorSession(ColorSource source);

  // Executes a request. A refused request changes nothing; state() has the reason.
  void Obey(const ColorRequest& request);
  const ConsoleColors& state() const { return state_; }
  bool is_live() const { return source_.keep != nullptr; }

  // Returns the picture of a frame, or its labels and marks as PNG: red is the label of the grid,
  // green the mark (ColorEditor::Marks). Without content when there is no such frame.
  ExportAnswer Answer(const ExportRequest& request);

  const ColorEditor& editor() const { return editor_; }

 private:
  void Do(const ColorRequest& request);
  void Keep();
  void Save();
  void LookAtFile();
  void KeepDraft() const;
  void Notify();
  const cv::Mat& Image(std::size_t frame);

  ColorSource source_;
  std::string draft_file_;
  std::string model_file_;
  std::string saved_;  // content of the model's file, or what it would be
  ColorEditor editor_;
  ConsoleColors state_;
  JpegEncoder encoder_;
  std::size_t frame_ = 0;  // index of image_, when there is one
  cv::Mat image_;          // the image that was read last
};

}  // namespace kestrel
