// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <pybind11/numpy.h>

#include <opencv2/core.hpp>

#include "casters.h"
#include "kestrel/camera_model.h"

namespace kestrel::python {

// Returns the image in an array, whose pixels it shares: uint8 of rows x columns (gray), or rows x
// columns x 3 (BGR). The pixels of a row are side by side; the rows may be apart, as in a part of
// an image. Throws TypeError for anything else.
cv::Mat GrayImage(const pybind11::handle& array);
cv::Mat ColorImage(const pybind11::handle& array);
// Either of them, by the number of axes.
cv::Mat AnyImage(const pybind11::handle& array);

// The same for an image of a camera. Throws ImageSizeError when it has another size.
cv::Mat GrayImage(const pybind11::handle& array, const CameraIntrinsics& camera);
cv::Mat ColorImage(const pybind11::handle& array, const CameraIntrinsics& camera);

// Returns an array that shares the pixels of 'image' (CV_8UC1 or CV_8UC3). Not writable: others may
// hold the same image.
pybind11::array ArrayOf(const cv::Mat& image);

// An array of points: N x 'columns', or one point of 'columns' numbers. Shared where it is an array
// of this type and in order, converted otherwise.
template <class Number>
struct Points {
  pybind11::array_t<Number, pybind11::array::c_style | pybind11::array::forcecast> array;
  bool is_one = false;

  std::size_t count() const { return is_one ? 1 : static_cast<std::size_t>(array.shape(0)); }
  const Number* data() const { return array.data(); }
};

// Throws TypeError when 'values' are no numbers of such a shape. 'name': of the argument.
template <class Number>
Points<Number> PointsOf(const pybind11::handle& values, int columns, const char* name);

// Returns an array for the results of 'points': N x 'columns', or 'columns' for one point.
template <class Number>
pybind11::array_t<Number> ResultsFor(const Points<Number>& points, int columns) {
  if (points.is_one) return pybind11::array_t<Number>(columns);
  return pybind11::array_t<Number>({points.array.shape(0), pybind11::ssize_t{columns}});
}

}  // namespace kestrel::python
