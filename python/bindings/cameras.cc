// SPDX-License-Identifier: BSD-3-Clause
// Lenses, their calibration, and rays of pixels.
#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "arrays.h"
#include "bindings.h"
#include "camera_argument.h"
#include "enum_casters.h"
#include "kestrel/calibration.h"
#include "kestrel/calibration_reader.h"
#include "kestrel/camera_model.h"
#include "kestrel/core/camera/ray_table.h"
#include "kestrel/paper_camera.h"
#include "kestrel/recording_plan.h"
#include "value_class.h"

namespace kestrel::python {
namespace {

namespace py = pybind11;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::string Described(const CameraIntrinsics& camera) {
  return fmt::format("{} x {} px, {}, focal length {:.2f} px, centre ({:.2f}, {:.2f})",
                     camera.width_px, camera.height_px,
                     Words<DistortionModel>::Of(camera.distortion_model), camera.fx_px,
                     camera.cx_px, camera.cy_px);
}

std::string Described(const CameraCalibration& calibration) {
  return fmt::format("<CameraCalibration{}: {}{}{}>",
                     calibration.name.empty() ? "" : " " + calibration.name,
                     Described(calibration.intrinsics),
                     calibration.body_from_camera ? ", with a mount" : ", no mount",
                     calibration.clock_offset
                         ? fmt::format(", clock offset {} s", ToSeconds(*calibration.clock_offset))
                         : "");
}

py::array_t<double> Project(const CameraModel& camera, const py::handle& values) {
  const auto points = PointsOf<double>(values, 3, "points_in_camera");
  auto pixels = ResultsFor(points, 2);
  const double* const in = points.data();
  double* const out = pixels.mutable_data();
  const py::gil_scoped_release release;
  for (std::size_t i = 0; i < points.count(); ++i) {
    Eigen::Vector2d pixel(kNan, kNan);
    camera.Project(Eigen::Map<const Eigen::Vector3d>(in + 3 * i), &pixel);
    Eigen::Map<Eigen::Vector2d>(out + 2 * i) = pixel;
  }
  return pixels;
}

py::array_t<double> Unproject(const CameraModel& camera, const py::handle& values) {
  const auto pixels = PointsOf<double>(values, 2, "pixels");
  auto rays = ResultsFor(pixels, 3);
  const double* const in = pixels.data();
  double* const out = rays.mutable_data();
  const py::gil_scoped_release release;
  for (std::size_t i = 0; i < pixels.count(); ++i) {
    Eigen::Vector3d ray(kNan, kNan, kNan);
    camera.Unproject(Eigen::Map<const Eigen::Vector2d>(in + 2 * i), &ray);
    Eigen::Map<Eigen::Vector3d>(out + 3 * i) = ray;
  }
  return rays;
}

// Looks up the rays of pixels in blocks, in which the kernel has each coordinate by itself.
void LookUp(const RayTable& table, const float* pixels, std::size_t count, float* rays) {
  constexpr std::size_t kBlock = 512;
  std::array<std::array<float, kBlock>, 5> block;
  auto& [u, v, x, y, z] = block;
  for (std::size_t begin = 0; begin < count; begin += kBlock) {
    const std::size_t size = std::min(kBlock, count - begin);
    for (std::size_t i = 0; i < size; ++i) {
      u[i] = pixels[2 * (begin + i)];
      v[i] = pixels[2 * (begin + i) + 1];
    }
    table.Rays(u.data(), v.data(), size, x.data(), y.data(), z.data());
    for (std::size_t i = 0; i < size; ++i) {
      float* const ray = rays + 3 * (begin + i);
      ray[0] = x[i];
      ray[1] = y[i];
      ray[2] = z[i];
    }
  }
}

py::array_t<float> Rays(const RayTable& table, const py::handle& values) {
  const auto pixels = PointsOf<float>(values, 2, "pixels");
  auto rays = ResultsFor(pixels, 3);
  const float* const in = pixels.data();
  float* const out = rays.mutable_data();
  const py::gil_scoped_release release;
  LookUp(table, in, pixels.count(), out);
  return rays;
}

void BindIntrinsics(py::module_& module) {
  ValueClass<CameraIntrinsics>(
      module, "CameraIntrinsics",
      "A lens and the size of its images. Pixels: integer coordinates are the pixels' centres.")
      .Field("width_px", &CameraIntrinsics::width_px, "Width of the image, px.")
      .Field("height_px", &CameraIntrinsics::height_px, "Height of the image, px.")
      .Field("fx_px", &CameraIntrinsics::fx_px, "Focal length along x, px.")
      .Field("fy_px", &CameraIntrinsics::fy_px, "Focal length along y, px.")
      .Field("cx_px", &CameraIntrinsics::cx_px, "Principal point, px.")
      .Field("cy_px", &CameraIntrinsics::cy_px, "Principal point, px.")
      .Field("distortion_model", &CameraIntrinsics::distortion_model,
             "'none', 'radial-tangential' (OpenCV's order: k1 k2 p1 p2 [k3 [k4 k5 k6]]) or "
             "'equidistant' (OpenCV's fisheye, Kalibr: k1 k2 k3 k4).")
      .Field("distortion", &CameraIntrinsics::distortion,
             "Coefficients: 0, 4, 5 or 8, depending on the model.")
      .Repr([](const CameraIntrinsics& self) {
        return "<CameraIntrinsics: " + Described(self) + ">";
      });
}

void BindCalibration(py::class_<CameraCalibration>& calibration) {
  calibration.def(py::init([](const CameraIntrinsics& intrinsics) {
    CameraCalibration made;
    made.intrinsics = intrinsics;
    return made;
  }));
  py::implicitly_convertible<CameraIntrinsics, CameraCalibration>();
}

void BindModel(py::module_& module) {
  py::class_<CameraModel>(module, "CameraModel",
                          "A calibrated lens: points in the camera frame (x right, y down, z along "
                          "the optical axis) to "
                          "pixels, and pixels to rays, past 90 degrees from the axis. Immutable.")
      .def(py::init([](const CameraArgument& camera) { return *camera.model; }), py::arg("camera"),
           "camera: CameraIntrinsics or CameraCalibration. Raises InputError that names all that "
           "is wrong with it.")
      .def("project", &Project, py::arg("points_in_camera"),
           "Projects points.\n\npoints_in_camera: N x 3 (or 3), of any length.\nReturns pixels, "
           "float64 N x 2 (or 2), also outside of the image; NaN where the lens model does not "
           "cover the point.")
      .def("unproject", &Unproject, py::arg("pixels"),
           "Returns the unit rays through pixels, float64 N x 3 (or 3): the exact inverse of "
           "project. NaN where the lens model does not cover the pixel.\n\npixels: N x 2 (or 2).")
      .def_property_readonly("max_angle", &CameraModel::max_angle,
                             "Largest angle (rad) between a ray and the optical axis that the lens "
                             "model covers.")
      .def_property_readonly("intrinsics", &CameraModel::intrinsics, "The CameraIntrinsics.")
      .def("__repr__",
           [](const CameraModel& self) {
             return fmt::format("<CameraModel: {}, sees {:.1f} degrees from its axis>",
                                Described(self.intrinsics()), 180 / EIGEN_PI * self.max_angle());
           })
      .def(py::pickle([](const CameraModel& self) { return self.intrinsics(); },
                      [](const CameraIntrinsics& camera) { return CameraModel(camera); }));
}

void BindRayTable(py::module_& module) {
  py::class_<RayTable>(
      module, "RayTable",
      "Rays of pixels by a precomputed table, some 10 ns a pixel. Within 0.01 px of "
      "CameraModel.unproject inside of the image. Immutable.")
      .def(py::init([](const CameraArgument& camera) { return RayTable(*camera.model); }),
           py::arg("camera"), "camera: CameraModel, CameraIntrinsics or CameraCalibration.")
      .def("rays", &Rays, py::arg("pixels"),
           "Returns the unit rays through pixels, float32 N x 3 (or 3), in the camera frame; zeros "
           "outside of the lens model and of the table.\n\npixels: N x 2 (or 2); a float32 array "
           "in order is read without a copy.");
}

// Keys of the file that are not used become Python's warnings.
CameraCalibration ReadWithWarnings(const std::filesystem::path& file, const std::string& camera) {
  return ReadCalibration(file, camera, Warn);
}

}  // namespace

void BindCameras(py::module_& module) {
  BindIntrinsics(module);
  auto calibration =
      ValueClass<CameraCalibration>(module, "CameraCalibration",
                                    "The content of a camera's calibration file: the lens, the "
                                    "mount on the body, and the offset of the clock.")
          .Field("intrinsics", &CameraCalibration::intrinsics, "The CameraIntrinsics.")
          .Field("body_from_camera", &CameraCalibration::body_from_camera,
                 "The mount, a RigidTransform from the camera frame to the body's (FLU: x forward, "
                 "y left, z up); None: not known.")
          .Field("clock_offset_s", &CameraCalibration::clock_offset,
                 "t_nav = t_image + clock_offset_s, s; None: not known.")
          .Field("name", &CameraCalibration::name, "Name of the camera in its file.")
          .Repr([](const CameraCalibration& self) { return Described(self); });
  BindCalibration(calibration.py());
  BindModel(module);
  BindRayTable(module);
  module.def("read_calibration", &ReadWithWarnings, py::arg("file"), py::arg("camera") = "",
             "Reads the calibration of a camera: files of Kalibr, EuRoC, ROS, OpenCV (YAML, XML), "
             "camodocal, VINS and ORB-SLAM. Returns a CameraCalibration.\n\ncamera: which one of "
             "several in a file of Kalibr ('cam1').\nWarns of keys that are not used. Raises "
             "InputError that names file, line and key.");
  module.def("paper_calibration", &PaperCalibration,
             "Returns the calibration of the paper's fisheye camera, 752 x 480 px and 185 degrees, "
             "which looks down from the UAV: for trials.");
  module.def("hunt_calibration", &HuntCalibration,
             "Returns the calibration of the simulated colour camera, 1280 x 720 px: for trials.");
}

}  // namespace kestrel::python
