// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cctype>
#include <string>
#include <vector>

#include "bind_enum.h"
#include "bindings.h"

namespace kestrel::python {
namespace {

namespace py = pybind11;

// "out of order" is OUT_OF_ORDER.
std::string MemberName(std::string word) {
  std::transform(word.begin(), word.end(), word.begin(), [](unsigned char letter) {
    return std::isalnum(letter) != 0 ? static_cast<char>(std::toupper(letter)) : '_';
  });
  return word;
}

}  // namespace

py::object AddEnum(py::module_& module, const char* name, const std::vector<std::string>& words,
                   const char* doc) {
  py::list members;
  for (const std::string& word : words) members.append(py::make_tuple(MemberName(word), word));
  const py::handle text(reinterpret_cast<PyObject*>(&PyUnicode_Type));
  const py::object added =
      py::module_::import("enum").attr("Enum")(name, members, py::arg("type") = text);
  added.attr("__doc__") = doc;
  added.attr("__str__") = text.attr("__str__");
  module.attr(name) = added;
  return added;
}

void BindEnums(py::module_& module) {
  BindEnum<DetectionMethod>(
      module,
      "Means by which a pad was recognised: its ring with a cross, a part of it, decoded tags, the "
      "letter of a helipad, its appearance at the expected place, or a detector of one's own.");
  BindEnum<LandingStage>(module,
                         "Stages of a search for a pad, in order. Before FOUND: where the best "
                         "candidate fell (TargetReport.reached).");
  BindEnum<MeasurementFate>(module, "What a TargetTracker did with a measurement.");
  BindEnum<TrackState>(module, "State of a track: never seen, seen, predicted, or lost.");
  BindEnum<PoseLookup>(module, "Whether a PoseHistory has a pose at a time, or why not.");
  BindEnum<PositionMethod>(module,
                           "What the distance to a pad comes from: its size, or the altitude.");
  BindEnum<Completeness>(module,
                         "Whether an object is seen whole, cut off by the image, or merged with "
                         "another one.");
  BindEnum<ObjectShape>(module, "Shape of a coloured object.");
  BindEnum<PoseStatus>(module, "Whether a pose was added to a history, or why not.");
  BindEnum<DistortionModel>(module, "Distortion of a lens, by the words of a calibration file.");
  BindEnum<PixelFormat>(module,
                        "Format of an image: gray (rows, columns) or BGR (rows, columns, 3).");
}

}  // namespace kestrel::python
