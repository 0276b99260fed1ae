// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// An image from a file: PNG, JPEG, TIFF, WebP, BMP, PGM or PPM.
//
// Example:
//   const cv::Mat gray = ReadGrayImage("photo.jpg");
//   const cv::Mat color = ReadImage("photo.jpg", PixelFormat::kBgr);
//   std::cout << gray.size() << "\n";

#include "kestrel/io/recording/media/image_file.h"  // IWYU pragma: export
