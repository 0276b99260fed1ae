// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

#include <opencv2/core.hpp>

#include "kestrel/core/codec/encoded_image.h"

namespace kestrel {

bool IsWebp(std::string_view bytes);

// See DecodeImage. Returns BGR, or BGRA where there is alpha.
cv::Mat DecodeWebp(const EncodedImage& image);

}  // namespace kestrel
