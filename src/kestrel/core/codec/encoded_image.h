// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include <opencv2/core.hpp>

namespace kestrel {

// The bytes of an image file, which the decoders read.
struct EncodedImage {
  std::string_view bytes;
  const std::string& name;  // for messages
  std::size_t max_pixels;
};

// Throws InputError: the image's name and then 'fault'.
[[noreturn]] void FailToDecode(const EncodedImage& image, std::string_view fault);

// Throws InputError that says that the bytes end too early.
[[noreturn]] void FailAsCutOff(const EncodedImage& image);

// The pixels that a decoder fills. Throws InputError when there is none, when there are more than
// 'max_pixels', or when there is no memory for them.
cv::Mat NewPixels(const EncodedImage& image, std::uint64_t width, std::uint64_t height, int type);

}  // namespace kestrel
