// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

#include <opencv2/core.hpp>

#include "kestrel/core/codec/encoded_image.h"

namespace kestrel {

bool IsTiff(std::string_view bytes);

// See DecodeImage. Returns the first image of the file, gray or BGR. Throws InputError when it has
// more than 8 bits per channel.
cv::Mat DecodeTiff(const EncodedImage& image);

}  // namespace kestrel
