// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/io/recording/output_folder.h"
#include "kestrel/io/recording/overlays/annotated_writer.h"

namespace kestrel {

// Destination of a run's results.
struct OutputOptions {
  std::string folder = {};                    // empty: only the table, to 'stream'
  bool force = false;                         // replace existing files
  std::string annotate = {};                  // "video", "images" or empty
  double rate_hz = 0;                         // frame rate of the video
  std::vector<double> further_rates_hz = {};  // for the videos of further cameras
  // The lens is not known: distances and positions are left out.
  bool only_in_image = false;
  std::ostream* stream = nullptr;  // null: stdout
};

// Writes the results that all runs have: a table, row by row, and annotated frames. All functions
// throw InputError when they cannot write.
class ResultFiles {
 public:
  // 'table': name of the table's file. 'header': its first line. 'suffix': of the names of table
  // and video.
  ResultFiles(const OutputOptions& options, const std::string& table, const std::string& header,
              const std::string& suffix = "");
  ResultFiles(const ResultFiles&) = delete;  // the writer of pictures points to the folder in it
  ResultFiles& operator=(const ResultFiles&) = delete;

  void WriteRows(const std::string& rows);

  bool wants_pictures() const { return pictures_ != nullptr; }
  void WritePicture(const std::string& frame_name, const cv::Mat& picture);

  // Folder for further files; null where the table goes to a stream.
  const OutputFolder* folder() const { return folder_ ? &*folder_ : nullptr; }

 private:
  std::string table_;
  std::ostream* stream_;
  std::optional<OutputFolder> folder_;
  std::ofstream file_;
  std::unique_ptr<AnnotatedWriter> pictures_;
};

}  // namespace kestrel
