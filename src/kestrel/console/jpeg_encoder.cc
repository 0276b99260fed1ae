// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/console/jpeg_encoder.h"

#include <turbojpeg.h>

#include "kestrel/base/error.h"

namespace kestrel {

JpegEncoder::JpegEncoder(int quality) : quality_(quality), compressor_(tjInitCompress()) {
  if (compressor_ == nullptr) throw InputError("no memory for the console's images");
}

JpegEncoder::~JpegEncoder() { tjDestroy(compressor_); }

bool JpegEncoder::Append(const cv::Mat& image, std::string* output) {
  const bool is_gray = image.type() == CV_8UC1;
  if (image.empty() || (!is_gray && image.type() != CV_8UC3)) return false;
  const int sampling = is_gray ? TJSAMP_GRAY : TJSAMP_420;
  const unsigned long bound = tjBufSize(image.cols, image.rows, sampling);
  if (memory_.size() < bound) memory_.resize(bound);
  auto* jpeg = reinterpret_cast<unsigned char*>(memory_.data());
  unsigned long size = memory_.size();
  const int error = tjCompress2(compressor_, image.data, image.cols, static_cast<int>(image.step),
                                image.rows, is_gray ? TJPF_GRAY : TJPF_BGR, &jpeg, &size, sampling,
                                quality_, TJFLAG_NOREALLOC | TJFLAG_FASTDCT);
  if (error != 0) return false;
  output->append(memory_, 0, size);
  return true;
}

}  // namespace kestrel
