// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/app/console/color_request.h"
#include "kestrel/app/console/color_state.h"
#include "kestrel/app/console/export_request.h"
#include "kestrel/calibration/color_training/color_editor.h"
#include "kestrel/core/codec/jpeg_codec.h"

namespace kestrel {

// What colours are taught by.
struct ColorSource {
  std::string recording;    // that tells it from others
  std::size_t frame_count;  // at least 1; of a live camera 0
  // Gives the frame's image as it was taken, CV_8UC3. Throws InputError when it cannot.
  MarkedPixels::ReadFrame read;
  ObjectModel model;  // to begin with
  // For the model, its versions and the draft; made when something is to be kept.
  std::string folder;
  // Of a live camera, else empty: keeps its newest image as one frame more, which 'read' then
  // gives, and says so in words; throws InputError when it cannot.
  std::function<std::string()> keep = {};
  // Of a live camera, else empty: what it changes by itself, a sentence each.
  std::function<std::vector<std::string>()> warn = {};
};

// Teaching the colours of a model, as users ask for it: a ColorEditor whose draft is kept in a file
// after every change. By one thread.
class ColorSession {
 public:
  // Goes on with the draft of the recording, where the folder has one. Throws InputError when that
  // is not a draft any more.
  explicit ColorSession(ColorSource source);

  // What is refused changes nothing; state() says why.
  void Obey(const ColorRequest& request);
  const ConsoleColors& state() const { return state_; }
  bool is_live() const { return source_.keep != nullptr; }

  // The picture of a frame, or what its pixels are taken for and marked as: PNG, red the grid's
  // label, green the mark's (ColorEditor::Marks). Without content where there is none.
  ExportAnswer Answer(const ExportRequest& request);

  const ColorEditor& editor() const { return editor_; }

 private:
  void Do(const ColorRequest& request);
  void Keep();
  void Save();
  void LookAtFile();
  void KeepDraft() const;
  void Tell();
  const cv::Mat& Image(std::size_t frame);

  ColorSource source_;
  std::string draft_file_;
  std::string model_file_;
  std::string saved_;  // what the model's file holds, or would
  ColorEditor editor_;
  ConsoleColors state_;
  JpegEncoder encoder_;
  std::size_t frame_ = 0;  // of the image, when there is one
  cv::Mat image_;          // that was read last
};

}  // namespace kestrel
