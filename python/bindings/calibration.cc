// SPDX-License-Identifier: BSD-3-Clause
// Calibration of a lens from views of the pattern, of mount and clock from a flight.
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "arrays.h"
#include "bindings.h"
#include "enum_casters.h"
#include "kestrel/flight_calibration.h"
#include "kestrel/frame_source.h"
#include "kestrel/io/recording/euroc/euroc_text.h"
#include "kestrel/lens_calibration.h"
#include "option_values.h"
#include "value_class.h"

namespace kestrel::python {
namespace {

namespace py = pybind11;

// Returns images of arrays or Frames, whose pixels they share.
std::vector<LensImage> ImagesOf(const py::iterable& images) {
  std::vector<LensImage> named;
  for (const py::handle image : images) {
    if (py::isinstance<Frame>(image)) {
      const Frame frame = image.cast<Frame>();
      named.push_back({frame.name, frame.image});
    } else {
      named.push_back({fmt::format("image {}", named.size()), GrayImage(image)});
    }
  }
  return named;
}

LensCalibration Calibrate(const py::iterable& images, std::optional<DistortionModel> model,
                          const std::optional<CameraIntrinsics>& start, const py::dict& detector) {
  LensCalibrationOptions options{.model = model, .start = start, .detector = {}};
  SetFields(detector, FieldsOf(options.detector));
  options.before_image = [] {
    const py::gil_scoped_acquire acquire;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  };
  // The list keeps the arrays as long as their pixels are read.
  const py::list kept(images);
  const std::vector<LensImage> named = ImagesOf(kept);
  const py::gil_scoped_release release;
  return CalibrateLens(named, options);
}

void BindLens(py::module_& module) {
  using Lens = LensCalibration;
  py::class_<Lens>(module, "LensCalibration", "A lens estimated from views of the pattern.")
      .def_readonly("intrinsics", &Lens::intrinsics, "CameraIntrinsics.")
      .def_readonly("found", &Lens::found, "Number of views with the pattern, large enough.")
      .def_property_readonly(
          "used", [](const Lens& self) { return self.views.size(); },
          "Number of views that were used.")
      .def_readonly("outliers", &Lens::outliers, "Number of views that do not fit.")
      .def_property_readonly(
          "rms_px", [](const Lens& self) { return self.fit.RootMeanSquare(); },
          "Root mean square of the edges' residuals, px.")
      .def_property_readonly(
          "sigmas", [](const Lens& self) -> Eigen::VectorXd { return self.fit.sigmas; },
          "Standard deviations of fx, fy / fx, cx, cy and the coefficients, float64 of 9; 0: not "
          "estimated.")
      .def_readonly("warnings", &Lens::warnings, "What the views do not determine well, in words.")
      .def("__repr__", [](const Lens& self) {
        return fmt::format("<LensCalibration: focal length {:.2f} px, {} views, {:.3f} px left>",
                           self.intrinsics.fx_px, self.views.size(), self.fit.RootMeanSquare());
      });
  module.def("calibrate_lens", &Calibrate, py::arg("images"), py::arg("model") = py::none(),
             py::arg("start") = py::none(), py::arg("detector") = py::dict(),
             "Calibrates a lens from images of the landing pattern.\n\nimages: gray images of one "
             "size, or Frames.\nmodel: 'none', 'radial-tangential' or 'equidistant'; None: the one "
             "that explains them best.\nstart: CameraIntrinsics, a guess.\ndetector: dict of "
             "landing.detector.\nReturns a LensCalibration. Raises InputError that says what to do "
             "where the views do not determine the lens. Lets other threads run.");
}

void BindValues(py::module_& module) {
  ValueClass<TargetSighting>(module, "TargetSighting", "A detection of the target.",
                             {{}, Eigen::Vector3d::Zero(), 0})
      .Field("time_ns", &TargetSighting::time, "On the clock of the images, int, ns.")
      .Field("center_in_camera", &TargetSighting::center_in_camera, "float64 of 3, m.")
      .Field("sigma_m", &TargetSighting::sigma_m, "Standard deviation per axis, m.");
  ValueClass<MountAndClock>(module, "MountAndClock", "The relation of camera and navigation.")
      .Field("body_from_camera", &MountAndClock::body_from_camera, "RigidTransform.")
      .Field("clock_offset_s", &MountAndClock::clock_offset_s,
             "t_nav = t_image + clock_offset_s, s.");
}

void BindFlight(py::module_& module) {
  using Flight = FlightCalibration;
  BindValues(module);
  py::class_<Flight>(module, "FlightCalibration", "Mount and clock estimated from a flight.")
      .def_readonly("estimate", &Flight::estimate, "MountAndClock.")
      .def_readonly("angles", &Flight::angles,
                    "Roll, pitch, yaw of the mount relative to the given one, float64 of 3, rad.")
      .def_readonly("angle_sigmas", &Flight::angle_sigmas, "Standard deviations, rad.")
      .def_readonly("clock_sigma_s", &Flight::clock_sigma_s, "Standard deviation, s.")
      .def_readonly("rms_before_m", &Flight::rms_before_m,
                    "Distance of the sightings from the path with the given values, RMS, m.")
      .def_readonly("rms_after_m", &Flight::rms_after_m, "The same with the estimate, m.")
      .def_readonly("sightings", &Flight::sightings, "Number of sightings used.")
      .def_readonly("outliers", &Flight::outliers, "Number of sightings left out.")
      .def_readonly("warnings", &Flight::warnings, "What the flight determines poorly, in words.")
      .def_property_readonly("no_use", &WhyOfNoUse,
                             "Why the estimate is not to be used, in words: what the flight does "
                             "not determine, and what it lacks; empty: it may be used. The same "
                             "for which `kestrel calibrate` writes no file.")
      .def("__repr__", [](const Flight& self) {
        return fmt::format("<FlightCalibration: clock offset {:.4f} s, {:.3f} m left of {:.3f} m>",
                           self.estimate.clock_offset_s, self.rms_after_m, self.rms_before_m);
      });
  module.def(
      "calibrate_flight",
      [](const std::vector<TargetSighting>& sightings, const std::vector<PoseSample>& poses,
         const MountAndClock& given, bool mount, bool clock, double knot_spacing_s) {
        FlightCalibrationOptions options;
        options.estimate_mount = mount;
        options.estimate_clock = clock;
        options.knot_spacing_s = knot_spacing_s;
        const py::gil_scoped_release release;
        return CalibrateFlight(sightings, poses, given, options);
      },
      py::arg("sightings"), py::arg("poses"), py::arg("given"), py::arg("mount") = true,
      py::arg("clock") = true, py::arg("knot_spacing_s") = 0,
      "Estimates the angles of the mount and the clock offset with which the target's positions in "
      "the world fit one path best.\n\nsightings: list of TargetSighting; poses: list of "
      "PoseSample; given: MountAndClock.\nmount, clock: whether each is estimated.\n"
      "knot_spacing_s: 0: the target stands; else it moves along a curve with a knot each so many "
      "seconds.\nReturns a FlightCalibration. Raises InputError for too few sightings with poses.");
}

}  // namespace

void BindCalibration(py::module_& module) {
  BindLens(module);
  BindFlight(module);
  module.def(
      "calibration_text",
      [](const CameraCalibration& calibration, double rate_hz) {
        return EurocCalibrationText(calibration, rate_hz);
      },
      py::arg("calibration"), py::arg("rate_hz") = kNominalRateHz,
      "Returns the text of a calibration file (EuRoC's sensor.yaml), which read_calibration "
      "reads back to the last bit.");
}

}  // namespace kestrel::python
