// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include <opencv2/core.hpp>

namespace kestrel {

// An image with more pixels than this is refused.
inline constexpr std::size_t kMaxImagePixels = std::size_t{1} << 28;

// The image in the bytes of a PNG, JPEG, TIFF, WebP, BMP, PGM or PPM file, which is told by the
// first bytes. As the file stores it: CV_8U, or CV_16U of PNG, PGM and PPM with 16 bits, of 1
// channel (gray), 3 (BGR) or 4 (BGRA). A palette becomes BGR, fewer than 8 bits become 8, a
// rotation (EXIF, TIFF) is ignored. Throws InputError with one line that begins with 'name' when
// the bytes are cut off, broken, or no such image.
cv::Mat DecodeImage(std::string_view bytes, const std::string& name,
                    std::size_t max_pixels = kMaxImagePixels);

// The same of the file at 'path'.
cv::Mat ReadImage(const std::string& path);

// Replaces the file at 'path', atomically. Its extension says the format: ".png" (see EncodePng),
// or
// ".jpg" and ".jpeg" (quality 95). Throws InputError when the file cannot be written.
void WriteImage(const std::string& path, const cv::Mat& image);

}  // namespace kestrel
