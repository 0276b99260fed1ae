// SPDX-License-Identifier: BSD-3-Clause
// Any bytes of an image file give an image of an allowed size, or are refused in one line.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "kestrel/core/base/error.h"
#include "kestrel/core/codec/image_codec.h"

namespace {

constexpr std::size_t kMaxPixels = 1 << 20;

void RequireImage(const cv::Mat& image) {
  const bool has_depth = image.depth() == CV_8U || image.depth() == CV_16U;
  if (image.empty() || image.total() > kMaxPixels || !has_depth || image.channels() > 4) {
    std::abort();
  }
}

void RequireOneLine(std::string_view message) {
  if (!message.starts_with("image: ") || message.find('\n') != std::string_view::npos) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try {
    RequireImage(kestrel::DecodeImage(bytes, "image", kMaxPixels));
  } catch (const kestrel::InputError& error) {
    RequireOneLine(error.what());
  }
  return 0;
}
