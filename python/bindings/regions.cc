// SPDX-License-Identifier: BSD-3-Clause
// The tracker of a region that a person marks.
#include <array>
#include <optional>

#include <fmt/format.h>

#include "arrays.h"
#include "bind_enum.h"
#include "bindings.h"
#include "enum_casters.h"
#include "kestrel/region_tracker.h"

namespace kestrel::python {

template <>
struct Words<RegionState> : WordsByToString<RegionState, RegionState::kFollowing,
                                            RegionState::kCoasting, RegionState::kLost> {
  static constexpr char kName[] = "RegionState";
};

namespace {

namespace py = pybind11;

using Box = std::array<double, 4>;

}  // namespace

void BindRegions(py::module_& module) {
  BindEnum<RegionState>(module,
                        "Whether a region is seen in the image, was seen within the last 0.5 s, or "
                        "is lost and looked for.");
  py::class_<RegionReport>(module, "RegionReport", "A region in an image.")
      .def_property_readonly(
          "state", [](const RegionReport& self) { return self.state; }, "RegionState.")
      .def_property_readonly(
          "box_px",
          [](const RegionReport& self) {
            const cv::Rect2d& box = self.box_px;
            return Box{box.x, box.y, box.width, box.height};
          },
          "x, y, width, height, px: the pixel (x, y) is the upper left one. The last place when "
          "the region is lost.")
      .def_readonly("probability", &RegionReport::probability,
                    "That the box is on what was marked, 0 to 1.")
      .def("__repr__", [](const RegionReport& self) {
        return fmt::format("<RegionReport: {} at ({:.1f}, {:.1f}), {:.1f} x {:.1f} px>",
                           ToString(self.state), self.box_px.x, self.box_px.y, self.box_px.width,
                           self.box_px.height);
      });
  py::class_<RegionTracker>(module, "RegionTracker",
                            "Follows a region of an image that a person has marked, by its "
                            "appearance: whatever it shows.\n\n"
                            "    tracker = kestrel.RegionTracker()\n"
                            "    tracker.mark(first, 0, (310, 200, 40, 60))\n"
                            "    for i, image in enumerate(images):\n"
                            "        report = tracker.track(image, i * 33_000_000)\n"
                            "        print(report.state, report.box_px)")
      .def(py::init<>(), "Makes a tracker that follows nothing yet.")
      .def(
          "mark",
          [](RegionTracker& self, const py::handle& image, Time time, const Box& box) {
            self.Mark(AnyImage(image), time, {box[0], box[1], box[2], box[3]});
          },
          py::arg("image"), py::arg("time_ns"), py::arg("box_px"),
          "Starts on a region of an image, in place of any before. image: uint8, gray or BGR. "
          "box_px: x, y, width, height, at least 4 px wide and high. Raises InputError for a box "
          "that is not in the image.")
      .def(
          "track",
          [](RegionTracker& self, const py::handle& image, Time time,
             const std::optional<Eigen::Vector2d>& expected_px, double sigma_px) {
            std::optional<RegionHint> hint;
            if (expected_px) {
              hint = {*expected_px, sigma_px * sigma_px * Eigen::Matrix2d::Identity()};
            }
            return self.Track(AnyImage(image), time, hint);
          },
          py::arg("image"), py::arg("time_ns"), py::arg("expected_px") = py::none(),
          py::arg("sigma_px") = 20.0,
          "Returns a RegionReport of a later image of the same size and type. expected_px: where "
          "its middle is expected (2), or None; sigma_px: standard deviation of that, for a lost "
          "region.");
}

}  // namespace kestrel::python
