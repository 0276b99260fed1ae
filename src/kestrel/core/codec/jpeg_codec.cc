// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/codec/jpeg_codec.h"

#include <memory>
#include <turbojpeg.h>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

struct HandleCloser {
  void operator()(void* handle) const { tjDestroy(handle); }
};
using Handle = std::unique_ptr<void, HandleCloser>;

// A JPEG ends with the marker EOI. Only after the last start of a scan (SOS) is it the image's own
// and not that of a thumbnail; within a scan the byte pair cannot occur. The decoder would fill
// missing parts with gray, and such a frame would be taken for a real one.
bool IsComplete(std::string_view bytes) {
  const std::size_t scan = bytes.rfind("\xff\xda");
  return scan != std::string_view::npos && bytes.find("\xff\xd9", scan) != std::string_view::npos;
}

[[noreturn]] void Fail(const EncodedImage& image, tjhandle handle) {
  FailToDecode(image, fmt::format("cannot be decoded as an image: {}", tjGetErrorStr2(handle)));
}

}  // namespace

bool IsJpeg(std::string_view bytes) { return bytes.starts_with("\xff\xd8\xff"); }

cv::Mat DecodeJpeg(const EncodedImage& image) {
  if (!IsComplete(image.bytes)) FailAsCutOff(image);
  const Handle handle(tjInitDecompress());
  if (!handle) FailToDecode(image, "no memory for a JPEG");
  const auto* bytes = reinterpret_cast<const unsigned char*>(image.bytes.data());
  int width = 0, height = 0, sampling = 0, colors = -1;
  const int error = tjDecompressHeader3(handle.get(), bytes, image.bytes.size(), &width, &height,
                                        &sampling, &colors);
  // An unnamed sampling is an error of TurboJPEG here, but not for the steps that follow.
  if (error != 0 && width == 0) Fail(image, handle.get());
  if (colors == TJCS_CMYK || colors == TJCS_YCCK) {
    FailToDecode(image, "is a JPEG in the colours of a printer, expected gray or RGB");
  }
  const bool is_gray = colors == TJCS_GRAY;
  cv::Mat pixels = NewPixels(image, width, height, is_gray ? CV_8UC1 : CV_8UC3);
  const bool is_whole =
      tjDecompress2(handle.get(), bytes, image.bytes.size(), pixels.data, width,
                    static_cast<int>(pixels.step), height, is_gray ? TJPF_GRAY : TJPF_BGR,
                    TJFLAG_ACCURATEDCT | TJFLAG_LIMITSCANS) == 0;
  if (!is_whole && tjGetErrorCode(handle.get()) == TJERR_FATAL) Fail(image, handle.get());
  return pixels;
}

JpegEncoder::JpegEncoder(int quality) : quality_(quality), compressor_(tjInitCompress()) {
  if (compressor_ == nullptr) throw InputError("no memory for JPEG images");
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
                                quality_, TJFLAG_NOREALLOC | TJFLAG_ACCURATEDCT);
  if (error != 0) return false;
  output->append(memory_, 0, size);
  return true;
}

std::string EncodeJpeg(const cv::Mat& image, int quality) {
  std::string jpeg;
  if (JpegEncoder(quality).Append(image, &jpeg)) return jpeg;
  throw InputError("the image cannot be encoded as JPEG, expected 8 bits, gray or BGR");
}

}  // namespace kestrel
