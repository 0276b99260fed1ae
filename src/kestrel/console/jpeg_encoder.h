// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <opencv2/core.hpp>

namespace kestrel {

// Images to JPEG, with memory that is used again. By one thread.
class JpegEncoder {
 public:
  // 'quality': 1 to 100. Throws InputError when the library has no memory.
  explicit JpegEncoder(int quality);
  ~JpegEncoder();
  JpegEncoder(const JpegEncoder&) = delete;
  JpegEncoder& operator=(const JpegEncoder&) = delete;

  // Appends the JPEG of an 8-bit gray or BGR image; false, and nothing, for any other.
  bool Append(const cv::Mat& image, std::string* output);

 private:
  int quality_;
  void* compressor_;
  std::string memory_;
};

}  // namespace kestrel
