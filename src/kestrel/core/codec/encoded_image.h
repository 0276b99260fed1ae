// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include <opencv2/core.hpp>

namespace kestrel {

// The bytes of an image file, as input of the decoders.
struct EncodedImage {
  std::string_view bytes;
  const std::string& name;  // for messages
  std::size_t max_pixels;
  std::size_t page = 0;  // page in a TIFF
};

// Throws InputError with the image's name followed by 'fault'.
[[noreturn]] void FailToDecode(const EncodedImage& image, std::string_view fault);

// Throws InputError: the bytes end too early.
[[noreturn]] void FailAsCutOff(const EncodedImage& image);

// Returns the pixels that a decoder fills. Throws InputError when there are none, when there are
// more than 'max_pixels', or when memory is exhausted.
cv::Mat NewPixels(const EncodedImage& image, std::uint64_t width, std::uint64_t height, int type);

}  // namespace kestrel
