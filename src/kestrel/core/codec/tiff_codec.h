// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

#include <opencv2/core.hpp>

#include "kestrel/core/codec/encoded_image.h"

namespace kestrel {

bool IsTiff(std::string_view bytes);

// See DecodeImage. The first image of the file, gray or BGR; throws InputError where it has more
// than 8 bits a channel.
cv::Mat DecodeTiff(const EncodedImage& image);

}  // namespace kestrel
