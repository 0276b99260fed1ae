// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// OpenCV's ArUco dictionaries: a part of objdetect from OpenCV 4.7 on, of the contrib module aruco
// before.
#if __has_include(<opencv2/objdetect/aruco_dictionary.hpp>)
#include <opencv2/objdetect/aruco_dictionary.hpp>
#else
#include <opencv2/aruco/dictionary.hpp>
#endif

namespace kestrel {

// Returns the dictionary with OpenCV's number, cv::aruco::DICT_4X4_50 for example.
inline cv::aruco::Dictionary ArucoDictionary(int number) {
#if __has_include(<opencv2/objdetect/aruco_dictionary.hpp>)
  return cv::aruco::getPredefinedDictionary(number);
#else
  return *cv::aruco::getPredefinedDictionary(number);
#endif
}

}  // namespace kestrel
