// SPDX-License-Identifier: BSD-3-Clause
#include "arrays.h"

#include <cstdint>
#include <memory>
#include <string>

#include <fmt/format.h>

namespace kestrel::python {
namespace {

namespace py = pybind11;

// Returns what an argument is, as "float64 array of shape (480, 752)".
std::string Described(const py::handle& value) {
  if (!py::isinstance<py::array>(value)) {
    return py::str(py::type::handle_of(value).attr("__name__")).cast<std::string>();
  }
  const auto array = py::reinterpret_borrow<py::array>(value);
  return fmt::format("{} array of shape {}", py::str(array.dtype()).cast<std::string>(),
                     py::str(array.attr("shape")).cast<std::string>());
}

// The pixels of a row are side by side, and the rows one below the other.
bool HasPlainRows(const py::array& image, int channels) {
  if (channels > 1 && image.strides(2) != 1) return false;
  return image.strides(1) == channels && image.strides(0) >= channels * image.shape(1);
}

cv::Mat Image(const py::handle& value, int channels) {
  const std::string expected =
      channels == 1 ? "a gray image: uint8 array of shape (rows, columns)"
                    : "a colour image (BGR): uint8 array of shape (rows, columns, 3)";
  const auto refuse = [&](const std::string& got) {
    return py::type_error(fmt::format("image: got {}, expected {}", got, expected));
  };
  if (!py::isinstance<py::array>(value)) throw refuse(Described(value));
  const auto image = py::reinterpret_borrow<py::array>(value);
  const bool has_shape =
      channels == 1 ? image.ndim() == 2 : image.ndim() == 3 && image.shape(2) == channels;
  if (!has_shape || !py::isinstance<py::array_t<std::uint8_t>>(image) || image.size() == 0) {
    throw refuse(Described(value));
  }
  if (!HasPlainRows(image, channels)) {
    throw refuse(fmt::format("{} with strides {}", Described(value),
                             py::str(image.attr("strides")).cast<std::string>()) +
                 " (numpy.ascontiguousarray makes a copy in order)");
  }
  // The detectors only read.
  auto* pixels = const_cast<void*>(image.data());
  return cv::Mat(static_cast<int>(image.shape(0)), static_cast<int>(image.shape(1)),
                 CV_8UC(channels), pixels, static_cast<std::size_t>(image.strides(0)));
}

cv::Mat OfSize(const cv::Mat& image, const CameraIntrinsics& camera) {
  CheckImageSize(camera, image.cols, image.rows, "image");
  return image;
}

}  // namespace

cv::Mat GrayImage(const py::handle& array) { return Image(array, 1); }
cv::Mat ColorImage(const py::handle& array) { return Image(array, 3); }
cv::Mat AnyImage(const py::handle& array) {
  const bool is_color =
      py::isinstance<py::array>(array) && py::reinterpret_borrow<py::array>(array).ndim() == 3;
  return is_color ? ColorImage(array) : GrayImage(array);
}
cv::Mat GrayImage(const py::handle& array, const CameraIntrinsics& camera) {
  return OfSize(GrayImage(array), camera);
}
cv::Mat ColorImage(const py::handle& array, const CameraIntrinsics& camera) {
  return OfSize(ColorImage(array), camera);
}

py::array ArrayOf(const cv::Mat& image) {
  const py::ssize_t channels = image.channels();
  std::vector<py::ssize_t> shape = {image.rows, image.cols};
  std::vector<py::ssize_t> strides = {static_cast<py::ssize_t>(image.step[0]), channels};
  if (channels > 1) {
    shape.push_back(channels);
    strides.push_back(1);
  }
  auto kept = std::make_unique<cv::Mat>(image);
  const py::capsule owner(kept.get(),
                          [](void* held) { delete static_cast<cv::Mat*>(held); });  // NOLINT
  const cv::Mat* const pixels = kept.release();
  py::array array(py::dtype::of<std::uint8_t>(), shape, strides, pixels->data, owner);
  array.attr("flags").attr("writeable") = false;
  return array;
}

template <class Number>
Points<Number> PointsOf(const py::handle& values, int columns, const char* name) {
  const auto refuse = [&](const std::string& got) {
    return py::type_error(fmt::format("{}: got {}, expected numbers of shape (N, {}) or ({},)",
                                      name, got, columns, columns));
  };
  const py::array given = py::array::ensure(values);
  if (!given) {
    PyErr_Clear();
    throw refuse(Described(values));
  }
  const char kind = given.dtype().kind();
  const int axes = static_cast<int>(given.ndim());
  const bool is_number = kind == 'f' || kind == 'i' || kind == 'u';
  if (!is_number || axes < 1 || axes > 2 || given.shape(axes - 1) != columns) {
    throw refuse(Described(given));
  }
  return {given, axes == 1};
}

template Points<float> PointsOf(const py::handle& values, int columns, const char* name);
template Points<double> PointsOf(const py::handle& values, int columns, const char* name);

}  // namespace kestrel::python
