// SPDX-License-Identifier: BSD-3-Clause
// Hint and result of a search for a pad.
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bindings.h"
#include "enum_casters.h"
#include "seen.h"
#include "value_class.h"

namespace kestrel::python {
namespace {

namespace py = pybind11;

// Numbers of the stages of a search, by their names.
template <class Number>
py::dict ByStage(const std::array<Number, kLandingStageCount>& numbers) {
  py::dict named;
  for (const LandingStage stage : Words<LandingStage>::kValues) {
    named[ToString(stage)] = numbers[static_cast<std::size_t>(stage)];
  }
  return named;
}

template <class Number>
void SetByStage(const py::handle& value, std::array<Number, kLandingStageCount>* numbers) {
  for (const auto& [name, number] : value.cast<py::dict>()) {
    (*numbers)[static_cast<std::size_t>(py::cast<LandingStage>(name))] = py::cast<Number>(number);
  }
}

void BindShape(py::module_& module) {
  ValueClass<TargetTag>(module, "TargetTag", "A tag of a pad.")
      .Field("family", &TargetTag::family, "Name of its family, as 'tag36h11'.")
      .Field("id", &TargetTag::id, "int.")
      .Field("size_m", &TargetTag::size_m, "Side where its black and white borders meet, m.")
      .Field("pattern_from_tag", &TargetTag::pattern_from_tag,
             "RigidTransform from the tag's frame (x right, y up) to the pad's.");
  ValueClass<TargetShape>(module, "TargetShape",
                          "What a pad looks like. Its frame: origin in the middle of what is "
                          "detected, z up out of the printed face.")
      .Field("diameter_m", &TargetShape::diameter_m,
             "Of the circle around all that is detected, m.")
      .Field("board_size_m", &TargetShape::board_size_m, "Side of the square board, m.")
      .Field("outlines", &TargetShape::outlines,
             "Edges of the print, a list of lines of points, m, in the pad's frame.")
      .Field("tags", &TargetShape::tags, "List of TargetTag.")
      .Repr([](const TargetShape& self) {
        return fmt::format("<TargetShape: {} m wide on a board of {} m, {} outlines, {} tags>",
                           self.diameter_m, self.board_size_m, self.outlines.size(),
                           self.tags.size());
      });
  py::class_<PadView, std::shared_ptr<PadView>>(
      module, "PadView", "Camera and shape of a pad that was seen, for drawing it.")
      .def_readonly("camera", &PadView::camera, "CameraModel.")
      .def_readonly("shape", &PadView::shape, "TargetShape.")
      .def(py::pickle([](const PadView& self) { return py::make_tuple(self.camera, self.shape); },
                      [](const py::tuple& state) {
                        return std::make_shared<PadView>(
                            PadView{state[0].cast<CameraModel>(), state[1].cast<TargetShape>()});
                      }));
}

void BindHint(py::module_& module) {
  const auto rotation = [](const TargetHint& self) -> std::optional<Eigen::Vector4d> {
    if (!self.rotation_in_camera) return std::nullopt;
    const auto& q = *self.rotation_in_camera;
    return Eigen::Vector4d(q.w(), q.x(), q.y(), q.z());
  };
  const auto set_rotation = [](const py::handle& value, TargetHint* hint) {
    hint->rotation_in_camera.reset();
    if (value.is_none()) return;
    const auto q = value.cast<Eigen::Vector4d>();
    hint->rotation_in_camera = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized();
  };
  ValueClass<TargetHint>(module, "TargetHint",
                         "What is known about a frame before it is searched. Everything may be "
                         "None; it may be wrong, and a pad in plain view is found all the same.")
      .Field("center_in_camera", &TargetHint::center_in_camera,
             "Expected centre of the pad, camera frame, float64 of 3, m.")
      .Field("center_sigma_m", &TargetHint::center_sigma_m, "Its standard deviation per axis, m.")
      .Field("rotation_in_camera", rotation, set_rotation,
             "Expected orientation camera_from_target, quaternion w, x, y, z.")
      .Field("id", &TargetHint::id, "Which pad it is.")
      .Field("altitude_m", &TargetHint::altitude_m, "Height of the camera above the pad, m.")
      .Field("up_in_camera", &TargetHint::up_in_camera,
             "Unit vector away from the ground, camera frame.")
      .Field("first_step", &TargetHint::first_step,
             "SearchDiagnostics.next_step of the frame before.")
      .Field("max_search_ms", &TargetHint::max_search_ms, "Time limit, ms; 0: none.");
}

void BindEvidence(py::module_& module) {
  using Evidence = CalibrationEvidence;
  ValueClass<SeenPrint>(module, "SeenPrint",
                        "Where the image shows a print, whatever lens and sheet are.",
                        {{}, Eigen::Matrix<double, 2, 8>::Zero(), 0})
      .Field("near_pose", &SeenPrint::near_pose, "RigidTransform.")
      .Field("displacement_px", &SeenPrint::displacement_px, "float64 2 x 8, px.")
      .Field("radius_m", &SeenPrint::radius_m, "Unit of length of the displacement, m.");
  ValueClass<Evidence>(module, "CalibrationEvidence",
                       "What one view of a print says about the camera's calibration.")
      .Field("log_focal", &Evidence::log_focal, "Logarithm of true over calibrated focal length.")
      .Field("log_focal_sigma", &Evidence::log_focal_sigma, "Its standard deviation.")
      .Field("principal_px", &Evidence::principal_px, "Error of the principal point, px.")
      .Field("surprise", &Evidence::surprise,
             "Squared Mahalanobis distance of both from the calibration; 3 on average.")
      .Field("contradicts", &Evidence::contradicts,
             "True when the calibration cannot explain the view.")
      .Field("information", &Evidence::information, "float64 4 x 4, of the edges alone.")
      .Field("pull", &Evidence::pull, "float64 of 4.")
      .Field("edge_variance", &Evidence::edge_variance, "px^2.");
}

void BindLandingDetection(py::module_& module) {
  using Detection = TargetDetection;
  ValueClass<SeenPart>(module, "SeenPart", "A part of a pad that was recognised.")
      .Field("name", &SeenPart::name, "'ring', 'tag', ...")
      .Field("tag", &SeenPart::tag, "Index in TargetShape.tags, or None.")
      .Field("size_px", &SeenPart::size_px, "Its longer side or axis, px.");
  const auto parts = [](const Detection& self) {
    return std::vector<SeenPart>(self.parts.all().begin(), self.parts.all().end());
  };
  const auto set_parts = [](const py::handle& value, Detection* detection) {
    detection->parts = {};
    for (const auto& part : value.cast<std::vector<SeenPart>>()) detection->parts.Add(part);
  };
  using Diagnostics = DetectionDiagnostics;
  ValueClass<Diagnostics>(module, "DetectionDiagnostics",
                          "How a detection fits lens and print, for the examination of a "
                          "calibration.")
      .Field("misfit_px", &Diagnostics::misfit_px,
             "Distance of the edges from where pose and lens predict them, RMS, px.")
      .Field("misfit_bound_px", &Diagnostics::misfit_bound_px,
             "Largest misfit that agrees with print and lens, px.")
      .Field("seen", &Diagnostics::seen, "SeenPrint or None.")
      .Field("calibration", &Diagnostics::calibration, "CalibrationEvidence.")
      .Field("mirror_camera_from_target", &Diagnostics::mirror_camera_from_target,
             "The other pose under which the print looks the same, or None.")
      .Derived("is_misfit", &Diagnostics::is_misfit,
               "True when lens or print are not as described.");
  Detection blank{};
  blank.center_px.setZero();
  blank.covariance.setZero();
  ValueClass<Detection>(module, "TargetDetection", "A pad in an image.", blank)
      .Field("center_px", &Detection::center_px, "Its centre, float64 of 2, px.")
      .Field("camera_from_target", &Detection::camera_from_target,
             "RigidTransform from the pad's frame to the camera's (x right, y down, z forward), m.")
      .Field("covariance", &Detection::covariance,
             "Of the pose's error, float64 6 x 6: translation in the camera frame (m^2), rotation "
             "vector in the camera frame (rad^2).")
      .Field("method", &Detection::method, "DetectionMethod.")
      .Field("quality", &Detection::quality, "Probability that it is the pad, 0 to 1.")
      .Field("semi_major_px", &Detection::semi_major_px, "Half of its longest extent, px.")
      .Field("semi_minor_px", &Detection::semi_minor_px, "Half of its extent across, px.")
      .Field("id", &Detection::id, "Which pad it is, where pads of this kind differ; or None.")
      .Field("heading_symmetry", &Detection::heading_symmetry,
             "Number of headings under which the pad looks the same; 0: all.")
      .Field("parts", parts, set_parts, "List of SeenPart.")
      .Field("diagnostics", &Detection::diagnostics, "DetectionDiagnostics.")
      .Derived(
          "center_in_camera",
          [](const Detection& self) { return self.camera_from_target.translation; },
          "Its centre in the camera frame, float64 of 3, m.")
      .Derived(
          "sigma_in_camera",
          [](const Detection& self) -> Eigen::Vector3d {
            return self.covariance.diagonal().head<3>().cwiseSqrt();
          },
          "Standard deviations of that, m.")
      .Repr([](const Detection& self) { return "<TargetDetection: " + InWords(self) + ">"; });
}

void BindReport(py::module_& module) {
  using Diagnostics = SearchDiagnostics;
  ValueClass<Diagnostics>(module, "SearchDiagnostics", "Counts and times of one search for a pad.")
      .Field(
          "candidates", [](const Diagnostics& self) { return ByStage(self.candidates); },
          [](const py::handle& value, Diagnostics* self) { SetByStage(value, &self->candidates); },
          "Number of candidates that entered each stage, by the stages' names.")
      .Field(
          "stage_ns", [](const Diagnostics& self) { return ByStage(self.stage_ns); },
          [](const py::handle& value, Diagnostics* self) { SetByStage(value, &self->stage_ns); },
          "Time in each stage, ns, by the stages' names.")
      .Field("next_step", &Diagnostics::next_step,
             "Step at which the search ran out of time; 0: it did not.");
  ValueClass<SeenReport>(module, "TargetReport",
                         "The result of a search for a pad: the detection, or why there is none.")
      .Field("detection", &SeenReport::detection, "TargetDetection or None.")
      .Field("reached", &SeenReport::reached,
             "LandingStage: FOUND, or the stage at which the best candidate fell.")
      .Field("reason", &SeenReport::reason, "Why it fell; empty when found.")
      .Field("diagnostics", &SeenReport::diagnostics, "SearchDiagnostics.")
      .Field("view", &SeenReport::view, "PadView for drawing it, or None.")
      .Repr([](const SeenReport& self) { return "<TargetReport: " + InWords(self) + ">"; })
      .py()
      .def("__bool__", [](const SeenReport& self) { return self.detection.has_value(); });
}

}  // namespace

std::string InWords(const TargetDetection& detection) {
  return fmt::format(
      "at ({:.1f}, {:.1f}) px, {:.2f} m away, quality {:.2f}, by {}{}", detection.center_px.x(),
      detection.center_px.y(), detection.camera_from_target.translation.norm(), detection.quality,
      ToString(detection.method), detection.id ? fmt::format(", id {}", *detection.id) : "");
}

std::string InWords(const TargetReport& report) {
  if (report.detection) return "found " + InWords(*report.detection);
  return fmt::format("not found: {}", MissInWords(report));
}

void BindDetection(py::module_& module) {
  BindShape(module);
  BindHint(module);
  BindEvidence(module);
  BindLandingDetection(module);
  BindReport(module);
}

}  // namespace kestrel::python
