// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

#include <opencv2/core.hpp>

#include "kestrel/core/codec/encoded_image.h"

namespace kestrel {

bool IsBmp(std::string_view bytes);

// See DecodeImage. Accepts uncompressed files of 8 bits with a palette (gray where it has only
// grays), 24 or 32 bits. Returns gray or BGR: the fourth byte of a pixel has no agreed meaning.
cv::Mat DecodeBmp(const EncodedImage& image);

}  // namespace kestrel
