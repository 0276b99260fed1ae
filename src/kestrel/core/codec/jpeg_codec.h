// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include <opencv2/core.hpp>

#include "kestrel/core/codec/encoded_image.h"

namespace kestrel {

bool IsJpeg(std::string_view bytes);

// See DecodeImage. Gray or BGR.
cv::Mat DecodeJpeg(const EncodedImage& image);

// Encodes images as JPEG and reuses its memory. For use by one thread.
class JpegEncoder {
 public:
  // 'quality': 1 to 100. Throws InputError when memory is exhausted.
  explicit JpegEncoder(int quality);
  ~JpegEncoder();
  JpegEncoder(const JpegEncoder&) = delete;
  JpegEncoder& operator=(const JpegEncoder&) = delete;

  // Appends the JPEG (colours at half the resolution) of an 8-bit gray or BGR image. Returns false
  // and appends nothing for any other image.
  bool Append(const cv::Mat& image, std::string* output);

 private:
  int quality_;
  void* compressor_;
  std::string memory_;
};

// Encodes one image. Throws InputError where Append returns false.
std::string EncodeJpeg(const cv::Mat& image, int quality);

}  // namespace kestrel
