// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fstream>
#include <memory>
#include <optional>
#include <string>

#include <opencv2/core.hpp>

#include "kestrel/io/recording/annotated_writer.h"
#include "kestrel/io/recording/output_folder.h"

namespace kestrel {

// Where the results of a run go.
struct OutputOptions {
  std::string folder;    // empty: the table to stdout, and nothing else
  bool force = false;    // replace files that exist
  std::string annotate;  // "video", "images" or empty
  double rate_hz = 0;    // of the video
};

// What every run writes: a table, row by row, and annotated frames. All throw InputError when that
// is not possible.
class ResultSink {
 public:
  // 'table': the name of its file, 'header' its first line.
  ResultSink(const OutputOptions& options, const char* table, const std::string& header);
  ResultSink(const ResultSink&) = delete;  // the writer of pictures knows the folder in it
  ResultSink& operator=(const ResultSink&) = delete;

  void WriteRows(const std::string& rows);

  bool wants_pictures() const { return pictures_ != nullptr; }
  void WritePicture(const std::string& frame_name, const cv::Mat& picture);

  // For further files; null where all goes to stdout.
  const OutputFolder* folder() const { return folder_ ? &*folder_ : nullptr; }

 private:
  const char* table_;
  std::optional<OutputFolder> folder_;
  std::ofstream file_;
  std::unique_ptr<AnnotatedWriter> pictures_;
};

}  // namespace kestrel
