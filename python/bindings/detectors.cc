// SPDX-License-Identifier: BSD-3-Clause
// The detectors of pads.
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "bindings.h"
#include "camera_argument.h"
#include "detector.h"
#include "enum_casters.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/detect_tags.h"
#include "kestrel/helipad_detector.h"
#include "kestrel/landing_pattern_detector.h"
#include "kestrel/landing_pipeline.h"
#include "kestrel/make_target_detector.h"
#include "kestrel/tag_board_detector.h"
#include "kestrel/vision/tags/plain_tags.h"
#include "kestrel/vision/targets/ring_with_tags_detector.h"
#include "option_values.h"
#include "value_class.h"

namespace kestrel::python {

Detector::Detector(std::shared_ptr<const TargetDetector> detector)
    : detector_(std::move(detector)),
      view_(std::make_shared<PadView>(PadView{detector_->camera(), detector_->shape()})) {}

SeenReport Detector::Detect(const pybind11::handle& image, const TargetHint& hint) {
  const cv::Mat pixels = GrayImage(image, detector_->camera().intrinsics());
  std::unique_ptr<TargetWorkspace> workspace = TakeWorkspace();
  SeenReport report;
  {
    const pybind11::gil_scoped_release release;
    static_cast<TargetReport&>(report) = detector_->Detect(pixels, hint, *workspace);
  }
  idle_.push_back(std::move(workspace));
  report.view = view_;
  return report;
}

std::unique_ptr<TargetWorkspace> Detector::TakeWorkspace() {
  if (idle_.empty()) return detector_->MakeWorkspace();
  std::unique_ptr<TargetWorkspace> workspace = std::move(idle_.back());
  idle_.pop_back();
  return workspace;
}

namespace {

namespace py = pybind11;

// Python's names of the detectors are classes of their own.
struct LandingPatternFinder : Detector {
  using Detector::Detector;
};
struct TagBoardFinder : Detector {
  using Detector::Detector;
};
struct HelipadFinder : Detector {
  using Detector::Detector;
};
struct RingWithTagsFinder : Detector {
  using Detector::Detector;
};
struct OwnPadFinder : Detector {
  using Detector::Detector;
};

// A detector that is a function of Python. What it raises is the reason of the report: a pipeline
// goes on.
class CalledDetector : public TargetDetector {
 public:
  CalledDetector(CameraModel camera, TargetShape shape, py::function find)
      : camera_(std::move(camera)), shape_(std::move(shape)), find_(std::move(find)) {}

  TargetReport Detect(const cv::Mat& image, const TargetHint& hint,
                      TargetWorkspace& /*workspace*/) const override {
    const py::gil_scoped_acquire acquire;
    TargetReport report;
    try {
      // The function may keep the image: the pixels are its own.
      report.detection = find_(ArrayOf(image.clone()), hint).cast<std::optional<TargetDetection>>();
      report.reason = "the function has found nothing";
    } catch (const std::exception& error) {
      report.reason = Interned(error.what());
      const auto* const raised = dynamic_cast<const py::error_already_set*>(&error);
      // Ctrl-C is for the program: Python raises it again where the call returns to it.
      if (raised != nullptr && raised->matches(PyExc_KeyboardInterrupt)) PyErr_SetInterrupt();
    }
    if (report.detection) {
      report.reached = LandingStage::kFound;
      report.reason = {};
    }
    return report;
  }
  std::unique_ptr<TargetWorkspace> MakeWorkspace() const override {
    return std::make_unique<TargetWorkspace>();
  }
  const CameraModel& camera() const override { return camera_; }
  const TargetShape& shape() const override { return shape_; }

 private:
  CameraModel camera_;
  TargetShape shape_;
  py::function find_;
};

template <class Finder>
using FinderClass = py::class_<Finder, Detector, std::shared_ptr<Finder>>;

// Returns a board from the path of its file, or from a list of dicts as its tags.
TagBoard BoardOf(const py::object& board) {
  const TagTargetOptions defaults;
  if (const auto path = PathOf(board)) {
    return ParseTagBoard(ReadFile(*path), *path, defaults.family, defaults.size_m);
  }
  // A dict is YAML, too.
  const std::string text =
      "tags: " + py::module_::import("json").attr("dumps")(board).cast<std::string>();
  return ParseTagBoard(text, "board", defaults.family, defaults.size_m);
}

void WarnOfBoard(const TagBoard& board) {
  for (const std::string& warning : WarningsOfPlainTags(board)) Warn(warning);
}

void BindBase(py::module_& module) {
  py::class_<Detector, std::shared_ptr<Detector>>(
      module, "TargetDetector",
      "Finds one kind of pad in gray images of one camera. Any number of threads may use one at "
      "the same time.")
      .def("detect", &Detector::Detect, py::arg("image"), py::arg("hint") = TargetHint(),
           "Searches an image.\n\nimage: uint8 of shape (rows, columns), of the camera's size, "
           "gray; its pixels are not copied. Rows may be apart, as in a part of an array.\nhint: "
           "TargetHint, what is known before.\nReturns a TargetReport. Raises TypeError for "
           "another kind of array, InputError for another size. Lets other threads run.")
      .def_property_readonly(
          "camera", [](const Detector& self) { return self.view()->camera; }, "The CameraModel.")
      .def_property_readonly(
          "shape", [](const Detector& self) { return self.view()->shape; }, "The TargetShape.")
      .def("__repr__", [](const py::object& self) {
        const auto& view = self.cast<const Detector&>().view();
        return fmt::format("<{}: a pad of {:.3g} m in images of {} x {} px>",
                           py::str(py::type::of(self).attr("__name__")).cast<std::string>(),
                           view->shape.diameter_m, view->camera.width_px(),
                           view->camera.height_px());
      });
}

void BindLandingPattern(py::module_& module) {
  FinderClass<LandingPatternFinder>(
      module, "LandingPatternDetector",
      "Finds the landing pattern: a black ring with a cross on a white board.")
      .def(py::init([](const CameraArgument& camera, const py::object& options,
                       const py::kwargs& keywords) {
             return std::make_shared<LandingPatternFinder>(std::make_shared<LandingPatternDetector>(
                 *camera.model,
                 OptionsOf<LandingPatternDetectorOptions>(
                     options, keywords, [](const auto& file) { return file.landing.detector; })));
           }),
           py::arg("camera"), py::arg("options") = py::none(),
           "camera: CameraModel, CameraCalibration or CameraIntrinsics.\noptions: a dict by the "
           "names of `kestrel config` under landing.detector, or the path of such a file; keyword "
           "arguments are options, too, as pattern={'outer_diameter_m': 0.6}, min_quality=0.9.");
}

void BindTags(py::module_& module) {
  FinderClass<TagBoardFinder>(module, "TagBoardDetector",
                              "Finds a board of AprilTags and ArUco markers, or a single one.")
      .def(py::init([](const CameraArgument& camera, const py::object& board,
                       const py::kwargs& keywords) {
             TagBoardDetectorOptions options;
             SetFields(keywords, FieldsOf(options));
             const TagBoard tags = BoardOf(board);
             auto finder = std::make_shared<TagBoardFinder>(
                 std::make_shared<TagBoardDetector>(*camera.model, tags, options));
             WarnOfBoard(tags);
             return finder;
           }),
           py::arg("camera"), py::arg("board"),
           "board: a list of dicts, as [{'family': 'tag36h11', 'id': 3, 'size_m': 0.5}] (x_m, y_m "
           "and yaw_deg place a tag on the board), or the path of its YAML file.\nKeyword "
           "arguments: landing.target.tags of `kestrel config`.");
  FinderClass<RingWithTagsFinder>(module, "RingWithTagsDetector",
                                  "Finds the landing pattern whose board also has tags.")
      .def(py::init([](const CameraArgument& camera, const py::object& board, const py::dict& ring,
                       const py::dict& tags) {
             LandingPatternDetectorOptions ring_options;
             SetFields(ring, FieldsOf(ring_options));
             TagBoardDetectorOptions tag_options;
             SetFields(tags, FieldsOf(tag_options));
             const TagBoard printed = BoardOf(board);
             auto finder =
                 std::make_shared<RingWithTagsFinder>(std::make_shared<RingWithTagsDetector>(
                     *camera.model, ring_options, printed, tag_options));
             WarnOfBoard(printed);
             return finder;
           }),
           py::arg("camera"), py::arg("board"), py::arg("ring") = py::dict(),
           py::arg("tags") = py::dict(),
           "board: the tags, in the ring's frame, as of TagBoardDetector.\nring, tags: dicts of "
           "landing.detector and landing.target.tags of `kestrel config`.");
}

using CornerRows = Eigen::Matrix<double, 4, 2, Eigen::RowMajor>;

CornerRows CornersOf(const TagDetection& tag) {
  CornerRows rows;
  for (int k = 0; k < 4; ++k) rows.row(k) = tag.corners_px[k].transpose();
  return rows;
}

void SetCorners(const py::handle& value, TagDetection* tag) {
  const auto rows = value.cast<CornerRows>();
  for (int k = 0; k < 4; ++k) tag->corners_px[k] = rows.row(k).transpose();
}

void BindDetectTags(py::module_& module) {
  TagDetection blank;
  blank.corners_px.fill(Eigen::Vector2d::Zero());
  ValueClass<TagDetection>(module, "TagDetection", "A tag in an image.", blank)
      .Field("family", &TagDetection::family, "Name of its family, as 'tag36h11'.")
      .Field("id", &TagDetection::id, "int.")
      .Field("corners_px", CornersOf, SetCorners,
             "Corners of the square where its black and white borders meet, float64 4 x 2, px: "
             "clockwise in the image from the tag's upper left corner, as OpenCV's detectMarkers "
             "returns them; libapriltag has them in reverse.")
      .Field("decision_margin", &TagDetection::decision_margin,
             "Mean distance of the bits from the threshold between black and white, gray values, "
             "as libapriltag defines it, but without its sharpening.")
      .Repr([](const TagDetection& self) {
        return fmt::format("<TagDetection: {} id {} at ({:.1f}, {:.1f}) px>", self.family, self.id,
                           self.corners_px[0].x(), self.corners_px[0].y());
      });
  module.def("tag_families", &TagFamilies, "Returns the names of all families of detect_tags.");
  module.def(
      "detect_tags",
      [](const py::handle& image, const std::vector<std::string>& families) {
        const cv::Mat pixels = AnyImage(image);
        const py::gil_scoped_release release;
        return DetectTags(pixels, families);
      },
      py::arg("image"), py::arg("families"),
      "Finds all AprilTags and ArUco markers in an image, without a calibration.\n\nimage: uint8 "
      "of shape (rows, columns) or (rows, columns, 3), BGR, of any size; its pixels are not "
      "copied.\nfamilies: list of names, as ['tag36h11', 'aruco_4x4_50'] (tag_families).\nReturns "
      "a list of TagDetection, by family and id. Raises TypeError for another kind of array, "
      "InputError for an unknown family. Lets other threads run.");
}

void BindHelipad(py::module_& module) {
  FinderClass<HelipadFinder>(module, "HelipadDetector", "Finds a helipad by its H.")
      .def(py::init([](const CameraArgument& camera, const py::object& options,
                       const py::kwargs& keywords) {
             return std::make_shared<HelipadFinder>(std::make_shared<HelipadDetector>(
                 *camera.model,
                 OptionsOf<HelipadDetectorOptions>(options, keywords, [](const auto& file) {
                   return file.landing.target.helipad;
                 })));
           }),
           py::arg("camera"), py::arg("options") = py::none(),
           "options: landing.target.helipad of `kestrel config`, as of LandingPatternDetector.");
}

void BindOwnPad(py::module_& module) {
  FinderClass<OwnPadFinder>(module, "OwnPadDetector",
                            "A pad of your own, found by a function, as a pipeline takes it.")
      .def(py::init([](const CameraArgument& camera, const TargetShape& shape,
                       const py::function& find) {
             return std::make_shared<OwnPadFinder>(
                 std::make_shared<CalledDetector>(*camera.model, shape, find));
           }),
           py::arg("camera"), py::arg("shape"), py::arg("find"),
           "shape: TargetShape, for pictures and the track.\nfind: function of an image (uint8, "
           "rows "
           "x columns) and a TargetHint that returns a TargetDetection, or None. What it raises "
           "is the reason in the report.");
}

void BindMakeDetector(py::module_& module) {
  module.def(
      "make_detector",
      [](const CameraArgument& camera, const py::object& options, const py::kwargs& keywords) {
        const auto landing = OptionsOf<LandingPipelineOptions>(
            options, keywords, [](const auto& file) { return file.landing; });
        auto detector = std::make_shared<Detector>(
            MakeTargetDetector(*camera.model, landing.target, landing.detector));
        WarnOf(landing.target);
        return detector;
      },
      py::arg("camera"), py::arg("options") = py::none(),
      "Returns the TargetDetector of a configuration.\n\noptions: a dict by the names of `kestrel "
      "config` under landing, or the path of such a file; keyword arguments are options, too, as "
      "target={'kind': 'apriltag', 'apriltag': {'id': 3, 'size_m': 0.5}}.");
  module.def("target_kinds", &TargetKinds, "Returns the kinds of pads, for target.kind.");
}

}  // namespace

void BindDetectors(py::module_& module) {
  BindBase(module);
  BindLandingPattern(module);
  BindTags(module);
  BindDetectTags(module);
  BindHelipad(module);
  BindOwnPad(module);
  BindMakeDetector(module);
}

}  // namespace kestrel::python
