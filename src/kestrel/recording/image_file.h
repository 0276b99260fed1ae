// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <opencv2/core.hpp>

namespace kestrel {

// The image as CV_8UC1; colour is converted to luminance (BT.601). The pixels stay where the sensor
// had them: a rotation asked for by EXIF is ignored, because the calibration does not know of it.
// Throws InputError when the file is missing, cut off or not an image, or has other than 8 bits a
// channel.
cv::Mat ReadGrayImage(const std::string& path);

// 'image' as CV_8UC1, as above; 'name' is for the message.
cv::Mat ToGray(const cv::Mat& image, const std::string& name);

}  // namespace kestrel
