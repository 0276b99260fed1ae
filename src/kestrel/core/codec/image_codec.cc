// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/codec/image_codec.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/core/base/write_file.h"
#include "kestrel/core/codec/bmp_codec.h"
#include "kestrel/core/codec/encoded_image.h"
#include "kestrel/core/codec/jpeg_codec.h"
#include "kestrel/core/codec/png_codec.h"
#include "kestrel/core/codec/pnm_codec.h"
#include "kestrel/core/codec/tiff_codec.h"
#include "kestrel/core/codec/webp_codec.h"

namespace kestrel {
namespace {

struct Format {
  bool (*is_it)(std::string_view bytes);
  cv::Mat (*decode)(const EncodedImage& image);
};

constexpr std::array kFormats{Format{IsPng, DecodePng},   Format{IsJpeg, DecodeJpeg},
                              Format{IsTiff, DecodeTiff}, Format{IsWebp, DecodeWebp},
                              Format{IsBmp, DecodeBmp},   Format{IsPnm, DecodePnm}};

std::string Encode(const std::string& path, const cv::Mat& image) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  if (extension == ".png") return EncodePng(image);
  constexpr int kQuality = 95;
  if (extension == ".jpg" || extension == ".jpeg") return EncodeJpeg(image, kQuality);
  throw InputError(path + ": cannot be written, expected a name with .png or .jpg");
}

}  // namespace

cv::Mat DecodeImage(std::string_view bytes, const std::string& name, std::size_t max_pixels,
                    std::size_t page) {
  const EncodedImage image{bytes, name, max_pixels, page};
  for (const Format& format : kFormats) {
    if (format.is_it(bytes)) return format.decode(image);
  }
  FailToDecode(image,
               "cannot be decoded as an image, expected PNG, JPEG, TIFF, WebP, BMP, PGM or PPM");
}

std::size_t CountPages(std::string_view bytes) { return IsTiff(bytes) ? CountTiffPages(bytes) : 1; }

cv::Mat ReadImage(const std::string& path) { return DecodeImage(ReadFile(path), path); }

void WriteImage(const std::string& path, const cv::Mat& image) {
  WriteFile(path, Encode(path, image));
}

void FailToDecode(const EncodedImage& image, std::string_view fault) {
  throw InputError(fmt::format("{}: {}", image.name, fault));
}

void FailAsCutOff(const EncodedImage& image) { FailToDecode(image, "the image file is cut off"); }

cv::Mat NewPixels(const EncodedImage& image, std::uint64_t width, std::uint64_t height, int type) {
  constexpr std::uint64_t kMaxSide = std::uint64_t{1} << 20;
  if (width == 0 || height == 0 || width > kMaxSide || height > kMaxSide ||
      width * height > image.max_pixels) {
    FailToDecode(image, fmt::format("cannot be decoded as an image: it has {} x {} px, expected "
                                    "at least 1 and at most {} in all",
                                    width, height, image.max_pixels));
  }
  try {
    return cv::Mat(static_cast<int>(height), static_cast<int>(width), type);
  } catch (const cv::Exception&) {
    FailToDecode(image, fmt::format("no memory for {} x {} px", width, height));
  }
}

}  // namespace kestrel
