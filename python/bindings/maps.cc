// SPDX-License-Identifier: BSD-3-Clause
// Maps of coloured objects, and their files.
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bindings.h"
#include "enum_casters.h"
#include "kestrel/map_file.h"
#include "kestrel/object_map.h"
#include "option_values.h"
#include "value_class.h"

namespace kestrel::python {
namespace {

namespace py = pybind11;

// The field of view as a function of Python, or everything.
class CalledView : public FieldOfView {
 public:
  explicit CalledView(const py::object& shows) : shows_(shows) {}
  bool Shows(const MappedObject& object) const override {
    return shows_.is_none() || shows_(object).cast<bool>();
  }

 private:
  const py::object& shows_;
};

void BindMappedObject(py::module_& module) {
  using Object = MappedObject;
  ValueClass<Object>(module, "MappedObject", "What a map knows of an object.")
      .Field("id", &Object::id, "Unique within its map.")
      .Field("shape", &Object::shape, "'disc', 'cuboid' or 'bar'.")
      .Field("first_seen_ns", &Object::first_seen, "int, ns.")
      .Field("last_seen_ns", &Object::last_seen, "int, ns.")
      .Field("time_ns", &Object::time, "Of the state, int, ns.")
      .Field("state", &Object::state,
             "Position (m), velocity (m/s), acceleration (m/s^2) in the world (ENU), float64 of 9.")
      .Field("covariance", &Object::covariance, "float64 9 x 9.")
      .Field("may_move", &Object::may_move, "By its class.")
      .Field("move_log_odds", &Object::move_log_odds, "Log odds that it moves.")
      .Field("moves", &Object::moves, "True once that is beyond doubt.")
      .Field("detections", &Object::detections, "Number of its detections.")
      .Field("log_odds", &Object::log_odds, "Log odds that it exists.")
      .Field("color", &Object::color, "Hsv of the last detection.")
      .Field("color_log_likelihoods", &Object::color_log_likelihoods, "Of the model's colours.")
      .Field("digit_log_likelihoods", &Object::digit_log_likelihoods, "Of the digits.")
      .Derived(
          "position", [](const Object& self) -> Eigen::Vector3d { return self.position(); },
          "float64 of 3, m, ENU.")
      .Derived(
          "velocity", [](const Object& self) -> Eigen::Vector3d { return self.velocity(); },
          "float64 of 3, m/s, ENU.")
      .Derived("sigma_m", &Object::sigma_m, "Standard deviation of the position per axis, m.")
      .Derived("color_index", &Object::color_index, "Index in ObjectModel.color_names.")
      .Derived(
          "digit",
          [](const Object& self) -> std::optional<int> {
            const auto digit = self.digit();
            return digit ? std::optional(digit->digit) : std::nullopt;
          },
          "The likeliest digit of a cuboid, or None.")
      .Repr([](const Object& self) {
        return fmt::format(
            "<MappedObject {}: {} of colour {} at ({:.2f}, {:.2f}, {:.2f}) m, sigma "
            "{:.3f} m, seen {} times>",
            self.id, ToString(self.shape), self.color_index(), self.position().x(),
            self.position().y(), self.position().z(), self.sigma_m(), self.detections);
      });
}

void BindObjectMeasurement(py::module_& module) {
  using Measurement = ObjectMeasurement;
  ValueClass<Measurement>(module, "ObjectMeasurement", "A detection with its place in the world.")
      .Field("delay_s", &Measurement::delay_s, "Relative to the frame's time, s.")
      .Field("position", &Measurement::position, "float64 of 3, m, ENU.")
      .Field("covariance", &Measurement::covariance, "float64 3 x 3, m^2.")
      .Field("clock_shift", &Measurement::clock_shift,
             "Error of the position per error of the clock offset, float64 of 3, m/s.")
      .Field("shape", &Measurement::shape, "'disc', 'cuboid' or 'bar'.")
      .Field("color", &Measurement::color, "Hsv.")
      .Field("color_probabilities", &Measurement::color_probabilities, "Of the model's colours.")
      .Field("digits", &Measurement::digits, "Probability of each digit, or None.");
}

void BindMap(py::module_& module) {
  py::class_<ObjectMap>(module, "ObjectMap",
                        "The map of objects: detections in the world in, confirmed objects out, "
                        "each counted once.")
      .def(py::init([](const std::shared_ptr<ObjectModel>& model, const py::object& options,
                       const py::kwargs& keywords) {
             return std::make_unique<ObjectMap>(
                 model ? *model : DefaultObjectModel(),
                 OptionsOf<ObjectMapOptions>(options, keywords,
                                             [](const auto& file) { return file.hunt.map; }));
           }),
           py::arg("model") = py::none(), py::arg("options") = py::none(),
           "model: ObjectModel; None: that of MBZIRC 2017.\noptions: a dict by the names of "
           "`kestrel config` under hunt.map, or the path of such a file; keyword arguments are "
           "options, too.")
      .def(
          "update",
          [](ObjectMap& self, Time time, const std::vector<ObjectMeasurement>& measurements,
             const py::object& shows) { self.Update(time, measurements, CalledView(shows)); },
          py::arg("time_ns"), py::arg("measurements"), py::arg("shows") = py::none(),
          "Adds the detections of one frame, a list of ObjectMeasurement. An older frame is "
          "ignored.\n\nshows: function that says of a MappedObject whether it should have been "
          "seen; None: all should.")
      .def("confirmed", &ObjectMap::Confirmed,
           "Returns the objects that were seen often enough, a list of MappedObject.")
      .def("objects", &ObjectMap::objects, "Returns all objects.")
      .def("__repr__", [](const ObjectMap& self) {
        return fmt::format("<ObjectMap: {} confirmed objects>", self.Confirmed().size());
      });
}

}  // namespace

void BindMaps(py::module_& module) {
  BindMappedObject(module);
  BindObjectMeasurement(module);
  BindMap(module);
  module.def("save_objects", &SaveObjects, py::arg("path"), py::arg("objects"),
             "Writes a list of MappedObject as JSON, without loss.");
  module.def("load_objects", &LoadObjects, py::arg("path"),
             "Reads them. Raises InputError with the line.");
  module.def(
      "class_of",
      [](const MappedObject& object, const ObjectModel& model) -> std::optional<std::string> {
        const auto index = ClassOf(object, model);
        return index ? std::optional(model.classes[*index].name) : std::nullopt;
      },
      py::arg("object"), py::arg("model"),
      "Returns the name of the likeliest class of a MappedObject, or None.");
  module.def(
      "geojson",
      [](const std::vector<MappedObject>& objects, const ObjectModel& model, double latitude_deg,
         double longitude_deg) {
        return PrintGeoJson(objects, model, {latitude_deg, longitude_deg});
      },
      py::arg("objects"), py::arg("model"), py::arg("latitude_deg"), py::arg("longitude_deg"),
      "Returns the objects as GeoJSON text; the origin of the world is at this latitude and "
      "longitude (WGS 84, degrees).");
}

}  // namespace kestrel::python
