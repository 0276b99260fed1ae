// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string_view>

#include <opencv2/core.hpp>

#include "kestrel/core/codec/encoded_image.h"

namespace kestrel {

bool IsTiff(std::string_view bytes);

// Returns the number of pages: images of the file but its thumbnails; 1 when it cannot be read.
std::size_t CountTiffPages(std::string_view bytes);

// See DecodeImage. Returns a page of the file, gray or BGR. Throws InputError when there is none or
// it has more than 8 bits per channel.
cv::Mat DecodeTiff(const EncodedImage& image);

}  // namespace kestrel
