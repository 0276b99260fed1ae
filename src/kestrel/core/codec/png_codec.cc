// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/codec/png_codec.h"

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <png.h>
#include <vector>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

constexpr int kBitsPerByte = 8;
constexpr int kDeepBits = 16;
constexpr const char kCutOff[] = "cut off";
using Fault = std::array<char, 128>;

// libpng leaves its functions by longjmp. No object with a destructor may be on the stack between
// such a function and the setjmp of libpng's caller.
[[noreturn]] void Fail(png_structp png, png_const_charp message) {
  auto* fault = static_cast<Fault*>(png_get_error_ptr(png));
  std::snprintf(fault->data(), fault->size(), "%s", message);
  png_longjmp(png, 1);
}

void IgnoreWarning(png_structp /*png*/, png_const_charp /*message*/) {}

void TakeBytes(png_structp png, png_bytep output, std::size_t size) {
  auto* rest = static_cast<std::string_view*>(png_get_io_ptr(png));
  if (size > rest->size()) png_error(png, kCutOff);
  std::memcpy(output, rest->data(), size);
  rest->remove_prefix(size);
}

void GiveBytes(png_structp png, png_bytep bytes, std::size_t size) {
  static_cast<std::string*>(png_get_io_ptr(png))
      ->append(reinterpret_cast<const char*>(bytes), size);
}

std::vector<png_bytep> RowsOf(const cv::Mat& image) {
  std::vector<png_bytep> rows(static_cast<std::size_t>(image.rows));
  for (int v = 0; v < image.rows; ++v) rows[v] = const_cast<png_bytep>(image.ptr(v));
  return rows;
}

// Reads a file. The Read functions return false on a fault.
class PngReader {
 public:
  explicit PngReader(std::string_view bytes)
      : rest_(bytes),
        png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, &fault_, Fail, IgnoreWarning)),
        info_(png_ == nullptr ? nullptr : png_create_info_struct(png_)) {
    if (info_ != nullptr) png_set_read_fn(png_, &rest_, TakeBytes);
  }
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  bool ReadHead() {
    if (info_ == nullptr || setjmp(png_jmpbuf(png_)) != 0) return false;
    png_read_info(png_, info_);
    return true;
  }
  bool ReadPixels(std::size_t row_bytes, png_bytepp rows) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    SetConversions();
    if (png_get_rowbytes(png_, info_) != row_bytes) png_error(png_, "rows of another size");
    png_read_image(png_, rows);
    png_read_end(png_, nullptr);  // reads to the last chunk, which a truncated file lacks
    return true;
  }

  png_uint_32 width() const { return png_get_image_width(png_, info_); }
  png_uint_32 height() const { return png_get_image_height(png_, info_); }
  int type() const {
    const int depth = png_get_bit_depth(png_, info_) == kDeepBits ? CV_16U : CV_8U;
    return CV_MAKETYPE(depth, channels());
  }
  const char* fault() const { return fault_.data(); }

 private:
  bool IsColor() const { return (png_get_color_type(png_, info_) & PNG_COLOR_MASK_COLOR) != 0; }
  int channels() const {
    if ((png_get_color_type(png_, info_) & PNG_COLOR_MASK_ALPHA) != 0) return 4;
    if (!IsColor()) return 1;
    return png_get_valid(png_, info_, PNG_INFO_tRNS) != 0 ? 4 : 3;
  }
  void SetConversions() {
    if (channels() == 4) png_set_tRNS_to_alpha(png_);
    if (IsColor()) {
      png_set_palette_to_rgb(png_);
      png_set_bgr(png_);
    } else {
      png_set_expand_gray_1_2_4_to_8(png_);
      if (channels() > 1) png_set_gray_to_rgb(png_);
    }
    png_set_swap(png_);
    png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
  }

  std::string_view rest_;
  Fault fault_{};
  png_structp png_;
  png_infop info_;
};

class PngWriter {
 public:
  explicit PngWriter(std::string* output)
      : png_(png_create_write_struct(PNG_LIBPNG_VER_STRING, &fault_, Fail, IgnoreWarning)),
        info_(png_ == nullptr ? nullptr : png_create_info_struct(png_)) {
    if (info_ != nullptr) png_set_write_fn(png_, output, GiveBytes, nullptr);
  }
  ~PngWriter() { png_destroy_write_struct(&png_, &info_); }
  PngWriter(const PngWriter&) = delete;
  PngWriter& operator=(const PngWriter&) = delete;

  // Returns false on a fault.
  bool Write(const cv::Mat& image, int level, png_bytepp rows) {
    if (info_ == nullptr || setjmp(png_jmpbuf(png_)) != 0) return false;
    constexpr std::array kColorTypes{PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_RGB, PNG_COLOR_TYPE_RGBA};
    SetCompression(level);
    png_set_IHDR(png_, info_, image.cols, image.rows,
                 static_cast<int>(kBitsPerByte * image.elemSize1()),
                 kColorTypes[image.channels() / 2], PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png_, info_);
    png_set_bgr(png_);
    png_set_swap(png_);
    png_write_image(png_, rows);
    png_write_end(png_, info_);
    return true;
  }
  const char* fault() const { return fault_.data(); }

 private:
  // The differences of neighbouring pixels contain runs of equal bytes.
  void SetCompression(int level) {
    constexpr int kFastest = 1, kDefaultStrategy = 0, kRunLengths = 3;  // zlib's
    if (level == kFastPng) png_set_filter(png_, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
    png_set_compression_level(png_, level == kFastPng ? kFastest : level);
    png_set_compression_strategy(png_, level == kFastPng ? kRunLengths : kDefaultStrategy);
  }

  Fault fault_{};
  png_structp png_;
  png_infop info_;
};

[[noreturn]] void FailAs(const EncodedImage& image, const char* fault) {
  if (std::string_view(fault) == kCutOff) FailAsCutOff(image);
  FailToDecode(image, fmt::format("cannot be decoded as an image: PNG: {}", fault));
}

}  // namespace

bool IsPng(std::string_view bytes) { return bytes.starts_with("\x89PNG\r\n\x1a\n"); }

cv::Mat DecodePng(const EncodedImage& image) {
  PngReader reader(image.bytes);
  if (!reader.ReadHead()) FailAs(image, reader.fault());
  cv::Mat pixels = NewPixels(image, reader.width(), reader.height(), reader.type());
  if (!reader.ReadPixels(pixels.step, RowsOf(pixels).data())) FailAs(image, reader.fault());
  return pixels;
}

void AppendPng(const cv::Mat& image, int level, std::string* output) {
  const int channels = image.channels();
  const bool has_depth = image.depth() == CV_8U || image.depth() == CV_16U;
  if (image.empty() || !has_depth || (channels != 1 && channels != 3 && channels != 4)) {
    throw InputError(
        "the image cannot be encoded as PNG, expected 8 or 16 bits and 1, 3 or 4 "
        "channels");
  }
  PngWriter writer(output);
  if (!writer.Write(image, level, RowsOf(image).data())) {
    throw InputError(fmt::format("the image cannot be encoded as PNG: {}", writer.fault()));
  }
}

std::string EncodePng(const cv::Mat& image, int level) {
  std::string png;
  AppendPng(image, level, &png);
  return png;
}

}  // namespace kestrel
