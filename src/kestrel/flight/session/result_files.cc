// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/session/result_files.h"

#include <iostream>

namespace kestrel {

ResultFiles::ResultFiles(const OutputOptions& options, const char* table, const std::string& header)
    : table_(table), stream_(options.stream ? options.stream : &std::cout) {
  if (!options.folder.empty()) {
    folder_.emplace(options.folder, options.force);
    file_ = folder_->OpenText(table);
    stream_ = &file_;
  }
  if (options.annotate == "images") pictures_ = MakeImageWriter(*folder_);
  if (options.annotate == "video") pictures_ = MakeVideoWriter(*folder_, options.rate_hz);
  WriteRows(header);
}

void ResultFiles::WriteRows(const std::string& rows) { WriteAtOnce(rows, table_, stream_); }

void ResultFiles::WritePicture(const std::string& frame_name, const cv::Mat& picture) {
  pictures_->Write(frame_name, picture);
}

}  // namespace kestrel
