// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

#include <opencv2/core.hpp>

#include "kestrel/core/codec/encoded_image.h"

namespace kestrel {

bool IsBmp(std::string_view bytes);

// See DecodeImage. Of 8 bits with a palette (gray where it has only grays), 24 or 32 bits, not
// compressed; BGR, as the fourth byte of a pixel has no meaning that all writers share.
cv::Mat DecodeBmp(const EncodedImage& image);

}  // namespace kestrel
