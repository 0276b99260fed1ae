// SPDX-License-Identifier: BSD-3-Clause
// Results against the truth of a recording.
#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bind_enum.h"
#include "bindings.h"
#include "casters.h"
#include "kestrel/app/evaluation/evaluate_hunt.h"
#include "kestrel/app/evaluation/evaluate_landing.h"
#include "value_class.h"

namespace kestrel::python {

template <>
struct Words<LandingVerdict> {
  static constexpr char kName[] = "LandingVerdict";
  static constexpr std::array kValues = {LandingVerdict::kFound, LandingVerdict::kMissed,
                                         LandingVerdict::kFalse, LandingVerdict::kQuiet};
  static const char* Of(LandingVerdict value) {
    static constexpr std::array kWords = {"found", "missed", "false", "quiet"};
    return kWords[static_cast<std::size_t>(value)];
  }
};

namespace {

namespace py = pybind11;

Report Evaluate(const std::filesystem::path& recording, const std::filesystem::path& output,
                bool is_hunt) {
  const py::gil_scoped_release release;
  return is_hunt ? EvaluateHunt(recording, output) : EvaluateLanding(recording, output);
}

std::vector<LandingComparison> CompareFrames(const std::filesystem::path& recording,
                                             const std::filesystem::path& output) {
  const py::gil_scoped_release release;
  return CompareLandingOutput(recording, output).comparisons;
}

std::vector<ObjectComparison> CompareSightings(const std::filesystem::path& recording,
                                               const std::filesystem::path& output) {
  const py::gil_scoped_release release;
  return CompareHuntOutput(recording, output).comparisons;
}

void BindLandingComparison(py::module_& module) {
  BindEnum<LandingVerdict>(
      module,
      "Whether a pad was found, missed, another thing was detected (FALSE), or "
      "there was neither a pad nor a detection (QUIET).");
  ValueClass<LandingErrors>(module, "LandingErrors",
                            "Errors of a right detection, estimate minus truth.")
      .Field("center_px", &LandingErrors::center_px, "Of the centre in the image, px.")
      .Field("lateral_m", &LandingErrors::lateral_m, "Across the true line of sight, m.")
      .Field("depth_m", &LandingErrors::depth_m, "Along it, m; positive: too far away.")
      .Field("nees", &LandingErrors::nees,
             "Position in the camera against the reported variances; 3 on average is right.")
      .Field("in_world", &LandingErrors::in_world, "float64 of 3, ENU, m; None without a pose.")
      .Field("yaw", &LandingErrors::yaw,
             "rad, to the nearest heading under which what was seen of the pad looks the same, or "
             "None.");
  ValueClass<LandingComparison>(module, "LandingComparison", "An image, its result, its truth.")
      .Field("time_ns", &LandingComparison::time, "Of the image, int, ns.")
      .Field("condition", &LandingComparison::condition, "Light and weather of scene.yaml.")
      .Field("verdict", &LandingComparison::verdict, "LandingVerdict.")
      .Field("truth", &LandingComparison::truth,
             "TruePattern, or None where the pad is not in the scene.")
      .Field("tilt", &LandingComparison::tilt,
             "Angle between the UAV's z axis and the vertical, rad, or None.")
      .Field("motion_px", &LandingComparison::motion_px,
             "Motion of the pad's centre during the exposure, px, or None.")
      .Field("errors", &LandingComparison::errors, "LandingErrors of what was found, or None.")
      .Derived(
          "is_visible", [](const LandingComparison& self) { return self.IsVisible(); },
          "True where at least a quarter of the pad is in view.");
}

void BindObjectComparison(py::module_& module) {
  using Row = ObjectComparison;
  ValueClass<Row>(module, "ObjectComparison", "A detection, an object in view, or a pair of both.")
      .Field("time_ns", &Row::time, "Of the image, int, ns.")
      .Field("true_id", &Row::true_id, "int; None: a detection of nothing.")
      .Field("true_class", &Row::true_class, "str; empty without an object.")
      .Field("is_wanted", &Row::is_wanted, "True: wholly in view with at least 50 px.")
      .Field("detected_class", &Row::detected_class, "str; empty: not detected.")
      .Field("class_probability", &Row::class_probability, "That was said of the class, 0 to 1.")
      .Field("center_error_px", &Row::center_error_px, "Of the centre in the image, px.")
      .Field("depth_error", &Row::depth_error, "Relative to the distance, or None.")
      .Field("world_error_m", &Row::world_error_m, "Of the position in the world, m, or None.");
}

}  // namespace

void BindEvaluation(py::module_& module) {
  BindLandingComparison(module);
  BindObjectComparison(module);
  ValueClass<ReportTable>(module, "ReportTable", "A table of a report, as text.")
      .Field("name", &ReportTable::name, "Name of its file, without the extension.")
      .Field("title", &ReportTable::title, "Title.")
      .Field("note", &ReportTable::note, "A line under the title; may be empty.")
      .Field("columns", &ReportTable::columns, "Titles of the columns.")
      .Field("rows", &ReportTable::rows, "Lists of cells.")
      .Derived(
          "csv", [](const ReportTable& self) { return ToCsv(self); },
          "The table as CSV; unknown values are empty.")
      .Repr([](const ReportTable& self) {
        return fmt::format("<ReportTable {}: {}, {} rows>", self.name, self.title,
                           self.rows.size());
      });
  py::class_<Report>(module, "Report", "The result of an evaluation.")
      .def_readonly("title", &Report::title, "Title.")
      .def_readonly("tables", &Report::tables, "List of ReportTable.")
      .def(
          "to_markdown", [](const Report& self) { return ToMarkdown(self); },
          "Returns the tables as a page of Markdown.")
      .def(
          "write",
          [](const Report& self, const std::filesystem::path& folder, bool replace) {
            const py::gil_scoped_release release;
            WriteReport(self, OutputFolder(folder, replace, "replace=True"));
          },
          py::arg("folder"), py::arg("replace") = false,
          "Writes report.md, a CSV file for each table and a PNG for each plot (by gnuplot).")
      .def("__repr__", [](const Report& self) {
        return fmt::format("<Report: {}, {} tables>", self.title, self.tables.size());
      });
  module.def(
      "evaluate", &Evaluate, py::arg("recording"), py::arg("output"), py::arg("hunt") = false,
      "Compares the tables that a Session wrote into the folder 'output' with the truth of a "
      "recording. Returns a Report. Raises InputError when they do not belong together.");
  module.def("compare_landing", &CompareFrames, py::arg("recording"), py::arg("output"),
             "Holds each row of landing_detections.csv in the folder 'output' against the truth of "
             "a recording. Returns a list of LandingComparison, one for each row. Raises "
             "InputError as evaluate.");
  module.def("compare_hunt", &CompareSightings, py::arg("recording"), py::arg("output"),
             "Holds object_detections.csv in the folder 'output' against the truth of a "
             "recording. Returns a list of ObjectComparison, in order of time. Raises InputError "
             "as evaluate.");
}

}  // namespace kestrel::python
