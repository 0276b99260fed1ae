// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/recording/image_file.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "kestrel/base/error.h"
#include "kestrel/base/read_file.h"

namespace kestrel {
namespace {

constexpr std::string_view kPngSignature = "\x89PNG\r\n\x1a\n";
constexpr std::string_view kJpegSignature = "\xff\xd8\xff";

std::uint32_t BigEndian32(std::string_view bytes) {
  std::uint32_t value = 0;
  for (const char byte : bytes.substr(0, 4)) value = value << 8 | static_cast<unsigned char>(byte);
  return value;
}

// A PNG is a chain of chunks (length, name, data, checksum) that ends with IEND.
bool IsCompletePng(std::string_view bytes) {
  constexpr std::size_t kFrame = 12;  // a chunk without its data
  bytes.remove_prefix(kPngSignature.size());
  while (bytes.size() >= kFrame) {
    if (bytes.substr(4, 4) == "IEND") return true;
    const std::size_t length = kFrame + BigEndian32(bytes);
    bytes.remove_prefix(std::min(length, bytes.size()));
  }
  return false;
}

// A JPEG ends with the marker EOI. Only behind the last start of a scan (SOS) it is the image's
// own and not that of a thumbnail; within a scan the byte pair cannot occur.
bool IsCompleteJpeg(std::string_view bytes) {
  const std::size_t scan = bytes.rfind("\xff\xda");
  return scan != std::string_view::npos && bytes.find("\xff\xd9", scan) != std::string_view::npos;
}

// The decoders give what they have of a file that was cut off, the rest black or gray: a frame
// that would pass for a real one.
bool IsComplete(std::string_view bytes) {
  if (bytes.starts_with(kPngSignature)) return IsCompletePng(bytes);
  if (bytes.starts_with(kJpegSignature)) return IsCompleteJpeg(bytes);
  return true;
}

cv::Mat Decode(std::string_view bytes) {
  if (bytes.empty() || bytes.size() > std::numeric_limits<int>::max()) return {};
  const cv::Mat view(1, static_cast<int>(bytes.size()), CV_8UC1, const_cast<char*>(bytes.data()));
  try {
    return cv::imdecode(view, cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception&) {
    return {};  // larger than OpenCV's limit, or broken
  }
}

const char* DepthName(int depth) {
  constexpr std::array kNames = {"8-bit",  "signed 8-bit",    "16-bit",          "signed 16-bit",
                                 "32-bit", "32-bit floating", "64-bit floating", "16-bit floating"};
  return kNames[depth];
}

// cv::cvtColor's code from 'channels' to 'format'; nothing where they are the same.
std::optional<int> ConversionCode(int channels, PixelFormat format) {
  const bool is_gray = format == PixelFormat::kGray;
  if (channels == 1) return is_gray ? std::nullopt : std::optional<int>(cv::COLOR_GRAY2BGR);
  if (channels == 3) return is_gray ? std::optional<int>(cv::COLOR_BGR2GRAY) : std::nullopt;
  return is_gray ? cv::COLOR_BGRA2GRAY : cv::COLOR_BGRA2BGR;
}

}  // namespace

cv::Mat ReadImage(const std::string& path, PixelFormat format) {
  return DecodeImageBytes(ReadFile(path), format, path);
}

cv::Mat DecodeImageBytes(std::string_view bytes, PixelFormat format, const std::string& name) {
  if (!IsComplete(bytes)) throw InputError(name + ": the image file is cut off");
  const cv::Mat image = Decode(bytes);
  if (image.empty()) throw InputError(name + ": cannot be decoded as an image");
  return ToFormat(image, format, name);
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
