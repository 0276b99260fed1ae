// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include <opencv2/core.hpp>

#include "kestrel/io/recording/frame.h"

namespace kestrel {

// Reads an image in 'format'; colour is converted to luminance by BT.601. The pixels stay in the
// sensor's order: a rotation in the EXIF data is ignored, as the calibration does not know it.
// Throws InputError when the file is missing, cut off or not an image, or does not have 8 bits per
// channel.
// 'page': of a TIFF that has several, from 0.
cv::Mat ReadImage(const std::string& path, PixelFormat format, std::size_t page = 0);
inline cv::Mat ReadGrayImage(const std::string& path) {
  return ReadImage(path, PixelFormat::kGray);
}

// The same for the bytes of an image file; 'name' is for the message.
cv::Mat DecodeImageBytes(std::string_view bytes, PixelFormat format, const std::string& name,
                         std::size_t page = 0);

// Converts 'image' to 'format', as above; 'name' is for the message.
cv::Mat ToFormat(const cv::Mat& image, PixelFormat format, const std::string& name);

}  // namespace kestrel
