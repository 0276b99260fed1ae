// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include <opencv2/core.hpp>

#include "kestrel/core/codec/encoded_image.h"

namespace kestrel {

bool IsPng(std::string_view bytes);

// See DecodeImage. Gray with alpha becomes BGRA. A transparent colour becomes alpha, except in
// gray.
cv::Mat DecodePng(const EncodedImage& image);

// Compression of a PNG: zlib's levels 0 to 9, or the fastest way for images of a camera.
inline constexpr int kFastPng = -1;

// Appends the PNG of an image of 8 or 16 bits with 1, 3 (BGR) or 4 channels (BGRA). Throws
// InputError for any other image.
void AppendPng(const cv::Mat& image, int level, std::string* output);

// Returns the PNG instead of appending it.
std::string EncodePng(const cv::Mat& image, int level = kFastPng);

}  // namespace kestrel
