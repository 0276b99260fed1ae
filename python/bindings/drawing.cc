// SPDX-License-Identifier: BSD-3-Clause
// Results drawn on their images.
#include "arrays.h"
#include "bindings.h"
#include "enum_casters.h"
#include "kestrel/io/recording/overlays/follow_overlay.h"
#include "kestrel/landing_overlay.h"
#include "kestrel/object_overlay.h"
#include "seen.h"

namespace kestrel::python {
namespace {

namespace py = pybind11;

const PadView& Required(const std::shared_ptr<PadView>& view) {
  if (!view) throw InputError("observation: expected the result of a detector or of a pipeline");
  return *view;
}

py::array DrawLanding(const py::handle& image, const SeenLanding& seen) {
  const PadView& view = Required(seen.view);
  const cv::Mat pixels = GrayImage(image, view.camera.intrinsics());
  cv::Mat drawn;
  {
    const py::gil_scoped_release release;
    drawn = DrawLandingOverlay(pixels, view.camera, view.shape, seen);
  }
  return ArrayOf(drawn);
}

py::array DrawReport(const py::handle& image, const SeenReport& report) {
  SeenLanding seen{{}, report.view};
  seen.report = report;
  return DrawLanding(image, seen);
}

py::array DrawHunt(const py::handle& image, const SeenHunt& seen) {
  if (!seen.model) throw InputError("observation: expected the result of a detector or a pipeline");
  const cv::Mat pixels = ColorImage(image);
  cv::Mat drawn;
  {
    const py::gil_scoped_release release;
    drawn = DrawObjectOverlay(pixels, *seen.model, seen);
  }
  return ArrayOf(drawn);
}

py::array DrawFollow(const py::handle& image, const FollowObservation& seen) {
  const cv::Mat pixels = ColorImage(image);
  cv::Mat drawn;
  {
    const py::gil_scoped_release release;
    drawn = DrawFollowOverlay(pixels, seen);
  }
  return ArrayOf(drawn);
}

py::array DrawObjects(const py::handle& image, const SeenObjects& report) {
  SeenHunt seen{{}, report.model};
  seen.report = report;
  return DrawHunt(image, seen);
}

}  // namespace

void BindDrawing(py::module_& module) {
  constexpr char kDraw[] =
      "Returns a copy of an image with a result drawn in, uint8 BGR: of a pad its outlines, axes, "
      "distance and quality, or the stage at which the best candidate fell, and why; of objects "
      "their outlines, classes and distances.\n\nimage: the image that was searched.\nobservation: "
      "TargetReport, LandingObservation, ObjectReport, HuntObservation or FollowObservation.";
  module.def("draw", &DrawLanding, py::arg("image"), py::arg("observation"), kDraw);
  module.def("draw", &DrawReport, py::arg("image"), py::arg("observation"));
  module.def("draw", &DrawHunt, py::arg("image"), py::arg("observation"));
  module.def("draw", &DrawFollow, py::arg("image"), py::arg("observation"));
  module.def("draw", &DrawObjects, py::arg("image"), py::arg("observation"));
}

}  // namespace kestrel::python
