// SPDX-License-Identifier: BSD-3-Clause
// Results against the truth of a recording.
#include <filesystem>
#include <string>

#include <fmt/format.h>

#include "bindings.h"
#include "casters.h"
#include "kestrel/app/evaluation/evaluate_hunt.h"
#include "kestrel/app/evaluation/evaluate_landing.h"
#include "value_class.h"

namespace kestrel::python {
namespace {

namespace py = pybind11;

Report Evaluate(const std::filesystem::path& recording, const std::filesystem::path& output,
                bool is_hunt) {
  const py::gil_scoped_release release;
  return is_hunt ? EvaluateHunt(recording, output) : EvaluateLanding(recording, output);
}

}  // namespace

void BindEvaluation(py::module_& module) {
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
}

}  // namespace kestrel::python
