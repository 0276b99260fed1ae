// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/ros_messages/image_message.h"

#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/shown.h"
#include "kestrel/io/recording/media/image_file.h"

namespace kestrel {
namespace {

constexpr int kAsItIs = -1;
constexpr std::uint32_t kMaxSide_px = 1 << 15;

// OpenCV's conversions from an encoding to gray and to BGR.
struct Encoding {
  std::string_view name;
  int channels;
  int to_gray;
  int to_bgr;
  bool has_pairs = false;  // two pixels share their colour
};

// OpenCV names Bayer's patterns by the second and third pixel of the second row, ROS by the first
// four pixels.
constexpr std::array kEncodings = {
    Encoding{"mono8", 1, kAsItIs, cv::COLOR_GRAY2BGR},
    Encoding{"8UC1", 1, kAsItIs, cv::COLOR_GRAY2BGR},
    Encoding{"bgr8", 3, cv::COLOR_BGR2GRAY, kAsItIs},
    Encoding{"8UC3", 3, cv::COLOR_BGR2GRAY, kAsItIs},
    Encoding{"rgb8", 3, cv::COLOR_RGB2GRAY, cv::COLOR_RGB2BGR},
    Encoding{"bgra8", 4, cv::COLOR_BGRA2GRAY, cv::COLOR_BGRA2BGR},
    Encoding{"8UC4", 4, cv::COLOR_BGRA2GRAY, cv::COLOR_BGRA2BGR},
    Encoding{"rgba8", 4, cv::COLOR_RGBA2GRAY, cv::COLOR_RGBA2BGR},
    Encoding{"bayer_rggb8", 1, cv::COLOR_BayerBG2GRAY, cv::COLOR_BayerBG2BGR},
    Encoding{"bayer_bggr8", 1, cv::COLOR_BayerRG2GRAY, cv::COLOR_BayerRG2BGR},
    Encoding{"bayer_gbrg8", 1, cv::COLOR_BayerGR2GRAY, cv::COLOR_BayerGR2BGR},
    Encoding{"bayer_grbg8", 1, cv::COLOR_BayerGB2GRAY, cv::COLOR_BayerGB2BGR},
    Encoding{"yuv422", 2, cv::COLOR_YUV2GRAY_UYVY, cv::COLOR_YUV2BGR_UYVY, true},
    Encoding{"uyvy", 2, cv::COLOR_YUV2GRAY_UYVY, cv::COLOR_YUV2BGR_UYVY, true},
    Encoding{"yuv422_yuy2", 2, cv::COLOR_YUV2GRAY_YUY2, cv::COLOR_YUV2BGR_YUY2, true},
    Encoding{"yuyv", 2, cv::COLOR_YUV2GRAY_YUY2, cv::COLOR_YUV2BGR_YUY2, true},
};

const Encoding& FindEncoding(const std::string& encoding, const std::string& name) {
  const auto known =
      std::find_if(kEncodings.begin(), kEncodings.end(),
                   [&](const Encoding& candidate) { return candidate.name == encoding; });
  if (known != kEncodings.end()) return *known;
  throw InputError(
      fmt::format("{}: has the encoding '{}', expected 8 bits a channel: mono8, bgr8, rgb8, bgra8, "
                  "rgba8, bayer_*8, yuv422 or yuv422_yuy2",
                  name, Shown(encoding)));
}

void CheckSize(const ImageMessage& message, const Encoding& encoding, const std::string& name) {
  const std::uint32_t width = message.width;
  const std::uint32_t height = message.height;
  if (width == 0 || height == 0 || width > kMaxSide_px || height > kMaxSide_px) {
    throw InputError(fmt::format("{}: has {}x{} pixels, expected 1 to {} each way", name, width,
                                 height, kMaxSide_px));
  }
  if (encoding.has_pairs && width % 2 != 0) {
    throw InputError(fmt::format("{}: is {} pixels wide, expected an even number with {}", name,
                                 width, encoding.name));
  }
  const std::uint64_t row = std::uint64_t{width} * encoding.channels;
  // The last row need not be padded.
  const std::uint64_t needed = std::uint64_t{height - 1} * message.step + row;
  if (message.step < row || message.data.size() < needed) {
    throw InputError(fmt::format("{}: has {} bytes in rows of {}, too few for {}x{} pixels of {}",
                                 name, message.data.size(), message.step, width, height,
                                 encoding.name));
  }
}

}  // namespace

cv::Mat DecodeImage(const ImageMessage& message, PixelFormat format, const std::string& name) {
  const Encoding& encoding = FindEncoding(message.encoding, name);
  CheckSize(message, encoding, name);
  const cv::Mat pixels(static_cast<int>(message.height), static_cast<int>(message.width),
                       CV_8UC(encoding.channels), const_cast<char*>(message.data.data()),
                       message.step);
  const int code = format == PixelFormat::kGray ? encoding.to_gray : encoding.to_bgr;
  if (code == kAsItIs) return pixels.clone();
  cv::Mat converted;
  try {
    cv::cvtColor(pixels, converted, code);
  } catch (const cv::Exception&) {
    throw InputError(fmt::format("{}: {}x{} pixels of {} cannot be decoded", name, message.width,
                                 message.height, encoding.name));
  }
  return converted;
}

cv::Mat DecodeImage(const CompressedImageMessage& message, PixelFormat format,
                    const std::string& name) {
  if (message.format.find("compressedDepth") != std::string::npos) {
    throw InputError(name + ": is a depth image (compressedDepth), expected JPEG or PNG");
  }
  return DecodeImageBytes(message.data, format, name);
}

}  // namespace kestrel
