// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

#include <opencv2/core.hpp>

#include "kestrel/core/codec/encoded_image.h"

namespace kestrel {

// True for PGM and PPM, in binary (P5, P6) or as text (P2, P3).
bool IsPnm(std::string_view bytes);

// See DecodeImage. The values are those of the file, whose maximum may be less than 255.
cv::Mat DecodePnm(const EncodedImage& image);

}  // namespace kestrel
