// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/session/result_files.h"

#include <iostream>

namespace kestrel {

ResultFiles::ResultFiles(const OutputOptions& options, const char* table, const std::string& header)
    : table_(table) {
  if (!options.folder.empty()) {
    folder_.emplace(options.folder, options.force);
    file_ = folder_->OpenText(table);
  }
  if (options.annotate == "images") pictures_ = MakeImageWriter(*folder_);
  if (options.annotate == "video") pictures_ = MakeVideoWriter(*folder_, options.rate_hz);
  WriteRows(header);
}

void ResultFiles::WriteRows(const std::string& rows) {
  WriteAtOnce(rows, table_, folder_ ? &file_ : &std::cout);
}

void ResultFiles::WritePicture(const std::string& frame_name, const cv::Mat& picture) {
  pictures_->Write(frame_name, picture);
}

}  // namespace kestrel
