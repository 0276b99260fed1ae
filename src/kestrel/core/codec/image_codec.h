// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include <opencv2/core.hpp>

namespace kestrel {

// Largest number of pixels of an image that is accepted.
inline constexpr std::size_t kMaxImagePixels = std::size_t{1} << 28;

// Decodes a PNG, JPEG, TIFF, WebP, BMP, PGM or PPM file; the first bytes determine the format.
// Returns the image as stored: CV_8U, or CV_16U for PNG, PGM and PPM with 16 bits, with 1 channel
// (gray), 3 (BGR) or 4 (BGRA). A palette becomes BGR, fewer than 8 bits become 8, and a rotation
// (EXIF, TIFF) is ignored. 'page': of a file that has several, from 0. Throws InputError with one
// line that begins with 'name' when the bytes are truncated, corrupt, or in another format.
cv::Mat DecodeImage(std::string_view bytes, const std::string& name,
                    std::size_t max_pixels = kMaxImagePixels, std::size_t page = 0);

// Returns the number of images in a file: the pages of a TIFF that can be found, else 1.
std::size_t CountPages(std::string_view bytes);

// Decodes the file at 'path'.
cv::Mat ReadImage(const std::string& path);

// Atomically replaces the file at 'path'. The extension determines the format: ".png" (see
// EncodePng), or ".jpg" and ".jpeg" (quality 95). Throws InputError when the file cannot be
// written.
void WriteImage(const std::string& path, const cv::Mat& image);

}  // namespace kestrel
