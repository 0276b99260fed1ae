// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/session/result_files.h"

#include <filesystem>
#include <iostream>

namespace kestrel {

namespace {

// "table.csv" and "_cam1" give "table_cam1.csv".
std::string WithSuffix(const std::string& file, const std::string& suffix) {
  const std::filesystem::path path(file);
  return path.stem().string() + suffix + path.extension().string();
}

}  // namespace

ResultFiles::ResultFiles(const OutputOptions& options, const std::string& table,
                         const std::string& header, const std::string& suffix)
    : table_(WithSuffix(table, suffix)), stream_(options.stream ? options.stream : &std::cout) {
  if (!options.folder.empty()) {
    folder_.emplace(options.folder, options.force);
    file_ = folder_->OpenText(table_);
    stream_ = &file_;
  }
  if (options.annotate == "images") pictures_ = MakeImageWriter(*folder_);
  if (options.annotate == "video") {
    pictures_ = MakeVideoWriter(*folder_, options.rate_hz, "annotated" + suffix);
  }
  WriteRows(header);
}

void ResultFiles::WriteRows(const std::string& rows) { WriteAtOnce(rows, table_.c_str(), stream_); }

void ResultFiles::WritePicture(const std::string& frame_name, const cv::Mat& picture) {
  pictures_->Write(frame_name, picture);
}

}  // namespace kestrel
