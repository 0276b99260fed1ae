// SPDX-License-Identifier: BSD-3-Clause
// Coloured objects: their model, their detector and what it finds.
#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "arrays.h"
#include "bindings.h"
#include "camera_argument.h"
#include "enum_casters.h"
#include "kestrel/object_detector.h"
#include "kestrel/object_model.h"
#include "option_values.h"
#include "seen.h"
#include "value_class.h"

namespace kestrel::python {
namespace {

namespace py = pybind11;

// A detector of objects, which any threads may use at the same time.
class ObjectFinder {
 public:
  ObjectFinder(const CameraModel& camera, const ObjectModel& model,
               const ObjectDetectorOptions& options)
      : detector_(camera, model, options), model_(std::make_shared<ObjectModel>(model)) {}

  SeenObjects Detect(const py::handle& image, std::optional<Eigen::Vector3d> up_in_camera,
                     std::optional<double> camera_height_m) {
    const cv::Mat pixels = ColorImage(image, detector_.camera().intrinsics());
    ObjectWorkspace workspace = TakeWorkspace();
    const ObjectHint hint{
        .track = {}, .up_in_camera = std::move(up_in_camera), .camera_height_m = camera_height_m};
    SeenObjects report;
    {
      const py::gil_scoped_release release;
      detector_.Detect(pixels, hint, workspace, &report);
    }
    idle_.push_back(std::move(workspace));
    report.model = model_;
    return report;
  }

  const ObjectDetector& detector() const { return detector_; }

 private:
  ObjectWorkspace TakeWorkspace() {
    if (idle_.empty()) return {};
    ObjectWorkspace workspace = std::move(idle_.back());
    idle_.pop_back();
    return workspace;
  }

  ObjectDetector detector_;
  std::shared_ptr<ObjectModel> model_;
  std::vector<ObjectWorkspace> idle_;  // guarded by the interpreter's lock
};

void BindModel(py::module_& module) {
  py::class_<ObjectModel, std::shared_ptr<ObjectModel>>(
      module, "ObjectModel", "The colours and the classes of the objects to find.")
      .def(py::init([](const py::object& file) {
             if (file.is_none()) return DefaultObjectModel();
             const auto path = PathOf(file);
             if (!path) throw py::type_error("file: expected the path of a model (YAML) or None");
             return ReadObjectModel(*path);
           }),
           py::arg("file") = py::none(),
           "file: path of a model (YAML); None: the objects of MBZIRC 2017.")
      .def_static(
          "from_yaml", [](const std::string& text) { return ParseObjectModel(text, "model"); },
          py::arg("text"), "Returns the model of a YAML text. Raises InputError with the line.")
      .def("to_yaml", &PrintObjectModel, "Returns the YAML text of the same model.")
      .def_property_readonly(
          "class_names",
          [](const ObjectModel& self) {
            std::vector<std::string> names;
            for (const ObjectClass& each : self.classes) names.push_back(each.name);
            return names;
          },
          "Names of the classes, by their index.")
      .def_property_readonly(
          "color_names",
          [](const ObjectModel& self) {
            std::vector<std::string> names;
            for (const ColorMixture& each : self.colors.colors) names.push_back(each.name);
            return names;
          },
          "Names of the colours, by their index.")
      .def("__repr__",
           [](const ObjectModel& self) {
             return fmt::format("<ObjectModel: {} colours, {} classes>", self.colors.colors.size(),
                                self.classes.size());
           })
      .def(py::pickle([](const ObjectModel& self) { return PrintObjectModel(self); },
                      [](const std::string& text) { return ParseObjectModel(text, "pickle"); }));
}

void BindParts(py::module_& module) {
  ValueClass<Ellipse>(module, "Ellipse", "An ellipse in the image.")
      .Field("center", &Ellipse::center, "float64 of 2, px.")
      .Field("semi_major", &Ellipse::semi_major, "px.")
      .Field("semi_minor", &Ellipse::semi_minor, "px.")
      .Field("angle", &Ellipse::angle, "Of the major axis, rad from x to y.");
  ValueClass<ObjectLocation>(module, "ObjectLocation", "Where an object is.")
      .Field("position", &ObjectLocation::position, "float64 of 3, m.")
      .Field("covariance", &ObjectLocation::covariance, "float64 3 x 3, m^2.");
  ValueClass<HeightBySize>(module, "HeightBySize",
                           "Height of the camera above the ground, from an object's size alone.")
      .Field("camera_height_m", &HeightBySize::camera_height_m, "m.")
      .Field("sigma_m", &HeightBySize::sigma_m, "Standard deviation, m.");
  ValueClass<Hsv>(module, "Hsv", "A colour.")
      .Field("hue_deg", &Hsv::hue_deg, "0 to 360.")
      .Field("saturation", &Hsv::saturation, "0 to 1.")
      .Field("value", &Hsv::value, "0 to 1.");
}

std::string InWords(const ObjectDetection& self) {
  const auto distance =
      self.location ? fmt::format(", {:.2f} m away", self.location->position.norm()) : "";
  const auto digit =
      self.digits ? fmt::format(", digit {}", LikeliestDigit(*self.digits).digit) : std::string();
  return fmt::format("<ObjectDetection: class {}, {} at ({:.1f}, {:.1f}) px{}{}>", self.class_index,
                     ToString(self.completeness), self.center_px.x(), self.center_px.y(), distance,
                     digit);
}

void BindFound(py::module_& module) {
  using Detection = ObjectDetection;
  ValueClass<Detection>(module, "ObjectDetection", "A coloured object in an image.")
      .Field("class_index", &Detection::class_index, "Index in ObjectModel.class_names.")
      .Field("completeness", &Detection::completeness, "'whole', 'cut off' or 'merged'.")
      .Field("center_px", &Detection::center_px, "float64 of 2, px.")
      .Field("bearing", &Detection::bearing, "Unit ray through it, camera frame.")
      .Field("ellipse", &Detection::ellipse, "Ellipse of its pixels' moments.")
      .Field("roundness", &Detection::roundness, "1 for a disc seen from above.")
      .Field("circularity", &Detection::circularity, "1 for a disc.")
      .Field("pixels", &Detection::pixels, "Number of its pixels.")
      .Field("misfit", &Detection::misfit, "0 is perfect; most objects have less than 0.5.")
      .Field("mean_color", &Detection::mean_color, "Hsv.")
      .Field("color_probabilities", &Detection::color_probabilities,
             "Probability of each of the model's colours.")
      .Field("class_probability", &Detection::class_probability, "Of its class, 0 to 1.")
      .Field("digits", &Detection::digits, "Probability of each digit, of cuboids; or None.")
      .Field("location", &Detection::location, "ObjectLocation in the camera frame, or None.")
      .Field("height", &Detection::height, "HeightBySize or None.")
      .Repr(&InWords);
  ValueClass<SeenObjects>(module, "ObjectReport", "All coloured objects of an image.")
      .Field("detections", &SeenObjects::detections, "List of ObjectDetection.")
      .Field("elsewhere", &SeenObjects::elsewhere,
             "List of those that, by their size, are not on the ground as the hint has it.")
      .Field("passed", &SeenObjects::passed, "Number of segments that passed each stage.")
      .Field("segmentation_time_s", &SeenObjects::segmentation_time, "s.")
      .Field("test_time_s", &SeenObjects::test_time, "s.")
      .Field("model", &SeenObjects::model, "The ObjectModel that they are of.")
      .Repr([](const SeenObjects& self) {
        return fmt::format("<ObjectReport: {} objects>", self.detections.size());
      });
}

void BindDetector(py::module_& module) {
  py::class_<ObjectFinder, std::shared_ptr<ObjectFinder>>(
      module, "ObjectDetector",
      "Finds coloured objects in images of one camera that looks down. Any number of threads may "
      "use one at the same time.")
      .def(py::init([](const CameraArgument& camera, const std::shared_ptr<ObjectModel>& model,
                       const py::object& options, const py::kwargs& keywords) {
             return std::make_shared<ObjectFinder>(
                 *camera.model, model ? *model : DefaultObjectModel(),
                 OptionsOf<ObjectDetectorOptions>(
                     options, keywords, [](const auto& file) { return file.hunt.detector; }));
           }),
           py::arg("camera"), py::arg("model") = py::none(), py::arg("options") = py::none(),
           "model: ObjectModel; None: that of MBZIRC 2017.\noptions: a dict by the names of "
           "`kestrel config` under hunt.detector, or the path of such a file; keyword arguments "
           "are options, too.")
      .def("detect", &ObjectFinder::Detect, py::arg("image"), py::arg("up_in_camera") = py::none(),
           py::arg("camera_height_m") = py::none(),
           "Searches an image.\n\nimage: uint8 of shape (rows, columns, 3), BGR, of the camera's "
           "size; its pixels are not copied.\nup_in_camera: unit vector away from the ground, "
           "camera frame; camera_height_m: above the ground, m; both or none.\nReturns an "
           "ObjectReport. Lets other threads run.")
      .def_property_readonly(
          "camera", [](const ObjectFinder& self) { return self.detector().camera(); },
          "The CameraModel.")
      .def("__repr__", [](const ObjectFinder& self) {
        return fmt::format("<ObjectDetector: {} classes in images of {} x {} px>",
                           self.detector().model().classes.size(),
                           self.detector().camera().width_px(),
                           self.detector().camera().height_px());
      });
}

}  // namespace

void BindObjects(py::module_& module) {
  BindModel(module);
  BindParts(module);
  BindFound(module);
  BindDetector(module);
}

}  // namespace kestrel::python
