// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/media/image_file.h"

#include <array>
#include <optional>
#include <string_view>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/core/codec/image_codec.h"

namespace kestrel {
namespace {

const char* DepthName(int depth) {
  constexpr std::array kNames = {"8-bit",  "signed 8-bit",    "16-bit",          "signed 16-bit",
                                 "32-bit", "32-bit floating", "64-bit floating", "16-bit floating"};
  return kNames[depth];
}

// Returns the code of cv::cvtColor from 'channels' to 'format'; nothing when they are the same.
std::optional<int> ConversionCode(int channels, PixelFormat format) {
  const bool is_gray = format == PixelFormat::kGray;
  if (channels == 1) return is_gray ? std::nullopt : std::optional<int>(cv::COLOR_GRAY2BGR);
  if (channels == 3) return is_gray ? std::optional<int>(cv::COLOR_BGR2GRAY) : std::nullopt;
  return is_gray ? cv::COLOR_BGRA2GRAY : cv::COLOR_BGRA2BGR;
}

}  // namespace

cv::Mat ReadImage(const std::string& path, PixelFormat format, std::size_t page) {
  return DecodeImageBytes(ReadFile(path), format, path, page);
}

cv::Mat DecodeImageBytes(std::string_view bytes, PixelFormat format, const std::string& name,
                         std::size_t page) {
  return ToFormat(DecodeImage(bytes, name, kMaxImagePixels, page), format, name);
}

cv::Mat ToFormat(const cv::Mat& image, PixelFormat format, const std::string& name) {
  if (image.depth() != CV_8U) {
    throw InputError(fmt::format("{}: is a {} image, expected 8 bits a channel", name,
                                 DepthName(image.depth())));
  }
  const int channels = image.channels();
  if (channels != 1 && channels != 3 && channels != 4) {
    throw InputError(fmt::format("{}: has {} channels, expected 1, 3 or 4", name, channels));
  }
  const std::optional<int> code = ConversionCode(channels, format);
  if (!code) return image;
  cv::Mat converted;
  cv::cvtColor(image, converted, *code);
  return converted;
}

}  // namespace kestrel
