// SPDX-License-Identifier: BSD-3-Clause
// The pipelines of a landing and of a hunt, and what they see in a frame.
#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "arrays.h"
#include "bindings.h"
#include "detector.h"
#include "enum_casters.h"
#include "kestrel/follow_pipeline.h"
#include "kestrel/hunt_pipeline.h"
#include "kestrel/io/recording/overlays/follow_overlay.h"
#include "kestrel/landing_pipeline.h"
#include "kestrel/vision/pipeline/require_altitude.h"
#include "option_values.h"
#include "seen.h"
#include "value_class.h"

namespace kestrel::python {
namespace {

namespace py = pybind11;

// A pipeline of Python. Threads that use it at the same time wait for each other.
template <class Pipeline>
class Guarded {
 public:
  explicit Guarded(Pipeline pipeline) : pipeline_(std::move(pipeline)) {}

  // Calls 'action' with the pipeline, without the interpreter's lock.
  template <class Action>
  auto With(const Action& action) {
    const py::gil_scoped_release release;
    const std::lock_guard lock(mutex_);
    return action(pipeline_);
  }

  // For what never changes.
  const Pipeline& pipeline() const { return pipeline_; }

 private:
  std::mutex mutex_;
  Pipeline pipeline_;
};

class GuardedLanding : public Guarded<LandingPipeline> {
 public:
  explicit GuardedLanding(LandingPipeline pipeline)
      : Guarded(std::move(pipeline)), views_(ViewsOf(this->pipeline())) {}

  SeenLanding Process(const py::handle& image, Time time, std::size_t camera) {
    const auto& view = views_[RequireCamera(camera)];
    const cv::Mat pixels = GrayImage(image, view->camera.intrinsics());
    return With([&](LandingPipeline& pipeline) {
      return SeenLanding{pipeline.Process(pixels, time, camera), view};
    });
  }

  std::optional<std::string> FaultOf(std::size_t camera) {
    RequireCamera(camera);
    const CameraState state =
        With([&](LandingPipeline& pipeline) { return pipeline.camera_state(camera); });
    if (state.health == CameraHealth::kGood) return std::nullopt;
    return kestrel::InWords(state);
  }

 private:
  using PadViews = std::vector<std::shared_ptr<PadView>>;

  static PadViews ViewsOf(const LandingPipeline& pipeline) {
    PadViews views;
    for (std::size_t i = 0; i < pipeline.camera_count(); ++i) {
      const TargetDetector& detector = pipeline.detector(i);
      views.push_back(std::make_shared<PadView>(PadView{detector.camera(), detector.shape()}));
    }
    return views;
  }

  std::size_t RequireCamera(std::size_t camera) const {
    if (camera < views_.size()) return camera;
    throw InputError(fmt::format("camera is {}, expected less than {}", camera, views_.size()));
  }

  PadViews views_;  // one for each camera
};

class GuardedHunt : public Guarded<HuntPipeline> {
 public:
  GuardedHunt(HuntPipeline pipeline, std::shared_ptr<ObjectModel> model)
      : Guarded(std::move(pipeline)), model_(std::move(model)) {}

  SeenHunt Process(const py::handle& image, Time time) {
    const cv::Mat pixels = ColorImage(image, pipeline().detector().camera().intrinsics());
    return With([&](HuntPipeline& pipeline) {
      return SeenHunt{pipeline.Process(pixels, time), model_};
    });
  }

 private:
  std::shared_ptr<ObjectModel> model_;
};

using OneOrSeveral = std::variant<CameraCalibration, std::vector<CameraCalibration>>;

std::vector<CameraCalibration> CamerasOf(const OneOrSeveral& calibration) {
  if (const auto* one = std::get_if<CameraCalibration>(&calibration)) return {*one};
  const auto& cameras = std::get<std::vector<CameraCalibration>>(calibration);
  if (!cameras.empty()) return cameras;
  throw InputError("calibration is an empty list, expected one for each camera");
}

void BindLandingObservation(py::module_& module) {
  using Seen = SeenLanding;
  ValueClass<Seen>(module, "LandingObservation", "What the landing pipeline saw in a frame.")
      .Field("time_ns", &Seen::time,
             "Of the frame, on the images' clock; of several cameras, the first one's, int, ns.")
      .Field("camera", &Seen::camera, "Index of the camera, int.")
      .Field(
          "report",
          [](const Seen& self) {
            return SeenReport{self.report, self.view};
          },
          [](const py::handle& value, Seen* self) { self->report = value.cast<SeenReport>(); },
          "TargetReport: the detection in the camera frame, or why there is none.")
      .Field("world_from_camera", &Seen::world_from_camera,
             "RigidTransform, or None without a pose.")
      .Field("pose", &Seen::pose, "'found', 'predicted', or why there is no pose.")
      .Field("pose_uncertainty", &Seen::pose_uncertainty, "PoseUncertainty of a predicted pose.")
      .Field("center_in_world", &Seen::center_in_world,
             "The pad's centre in the world, float64 of 3, ENU, m; or None.")
      .Field("position_method", &Seen::position_method, "'size' or 'altitude'.")
      .Field("yaw_in_world", &Seen::yaw_in_world, "Yaw of the pad, rad, or None.")
      .Field("fate", &Seen::fate, "What the track made of the detection, or None.")
      .Field("track_state", &Seen::track_state, "'searching', 'tracking', 'predicting' or 'lost'.")
      .Field("target", &Seen::target, "TargetEstimate at the time of the frame, or None.")
      .Field("detect_time_s", &Seen::detect_time, "Time of the detection alone, s.")
      .Field("view", &Seen::view, "What it is drawn by, or None.")
      .Derived(
          "detection", [](const Seen& self) { return self.report.detection; },
          "That of the report.")
      .Repr([](const Seen& self) {
        const auto place = self.center_in_world
                               ? fmt::format(", at ({:.2f}, {:.2f}, {:.2f}) m in the world",
                                             self.center_in_world->x(), self.center_in_world->y(),
                                             self.center_in_world->z())
                               : "";
        return fmt::format("<LandingObservation: {}{}, {}>", InWords(self.report), place,
                           ToString(self.track_state));
      })
      .py()
      .def("__bool__", [](const Seen& self) { return self.report.detection.has_value(); });
}

void BindHuntObservation(py::module_& module) {
  using Seen = SeenHunt;
  ValueClass<Seen>(module, "HuntObservation", "What the hunt pipeline saw in a frame.")
      .Field("time_ns", &Seen::time, "Of the frame, on the images' clock, int, ns.")
      .Field(
          "report",
          [](const Seen& self) {
            return SeenObjects{self.report, self.model};
          },
          [](const py::handle& value, Seen* self) { self->report = value.cast<SeenObjects>(); },
          "ObjectReport.")
      .Field("world_from_camera", &Seen::world_from_camera,
             "RigidTransform, or None without a pose.")
      .Field("in_world", &Seen::in_world,
             "For each detection, in order: ObjectLocation in the world (ENU), or None.")
      .Field("detect_time_s", &Seen::detect_time, "Time of the detection alone, s.")
      .Field("model", &Seen::model, "The ObjectModel.")
      .Repr([](const Seen& self) {
        return fmt::format("<HuntObservation: {} objects{}>", self.report.detections.size(),
                           self.world_from_camera ? ", with a pose" : ", no pose");
      });
}

void BindFollowObservation(py::module_& module) {
  using Seen = FollowObservation;
  ValueClass<PlaceOnGround>(module, "PlaceOnGround", "A place on the ground, in the world (ENU).")
      .Field("position", &PlaceOnGround::position, "float64 of 3, m.")
      .Field("covariance", &PlaceOnGround::covariance, "float64 of (3, 3), m^2, of all errors.");
  ValueClass<Seen>(module, "FollowObservation", "What was seen of a marked thing in a frame.")
      .Field("time_ns", &Seen::time, "Of the frame, on the images' clock, int, ns.")
      .Field("region", &Seen::region, "RegionReport, or None before something was marked.")
      .Field("world_from_camera", &Seen::world_from_camera,
             "RigidTransform, or None without a pose.")
      .Field("bearing", &Seen::bearing,
             "Direction to it in the world, float64 of 3, of length 1; or None.")
      .Field("place", &Seen::place, "PlaceOnGround; None near and above the horizon.")
      .Field("fate", &Seen::fate, "What the track made of the place, or None.")
      .Field("track_state", &Seen::track_state, "'searching', 'tracking', 'predicting' or 'lost'.")
      .Field("target", &Seen::target, "TargetEstimate at the time of the frame, or None.")
      .Field("detect_time_s", &Seen::detect_time, "Time of the tracker alone, s.")
      .Repr([](const Seen& self) { return fmt::format("<FollowObservation: {}>", InWords(self)); });
}

constexpr char kAddPose[] =
    "Adds a PoseSample of the navigation, later than those before. Returns 'ok', 'out of order' or "
    "'invalid'.";
constexpr char kSetAltitude[] =
    "Sets the height (m) of the camera above what it looks for, for frames without a pose; None: "
    "not known.";

void BindLandingPipeline(py::module_& module) {
  py::class_<GuardedLanding, std::shared_ptr<GuardedLanding>>(
      module, "LandingPipeline",
      "The whole vision of a landing: images and poses in; the pad, its place in the world and its "
      "track out.")
      .def(py::init([](const OneOrSeveral& calibration, const py::object& options,
                       const std::shared_ptr<Detector>& detector, const py::kwargs& keywords) {
             const auto values = OptionsOf<LandingPipelineOptions>(
                 options, keywords, [](const auto& file) { return file.landing; });
             const std::vector<CameraCalibration> cameras = CamerasOf(calibration);
             if (detector && cameras.size() > 1) {
               throw InputError("detector: expected the calibration of one camera");
             }
             if (detector) {
               return std::make_shared<GuardedLanding>(LandingPipeline(
                   cameras.front(), std::make_unique<SharedDetector>(detector->target()), values));
             }
             auto made = std::make_shared<GuardedLanding>(LandingPipeline(cameras, values));
             WarnOf(values.target);
             return made;
           }),
           py::arg("calibration"), py::arg("options") = py::none(),
           py::arg("detector") = py::none(),
           "calibration: CameraCalibration; poses place the pad in the world where it has a "
           "mount. A list: several cameras, which together make one track.\noptions: a dict by the "
           "names of `kestrel config` under landing, or the path of "
           "such a file; keyword arguments are options, too, as target={'kind': 'helipad'}.\n"
           "detector: TargetDetector in place of that of the options.")
      .def(
          "add_pose",
          [](GuardedLanding& self, const PoseSample& sample) {
            return self.With([&](LandingPipeline& pipeline) { return pipeline.AddPose(sample); });
          },
          py::arg("sample"), kAddPose)
      .def(
          "set_altitude",
          [](GuardedLanding& self, std::optional<double> altitude_m) {
            RequireAltitude(altitude_m);
            self.With([&](LandingPipeline& pipeline) { pipeline.SetAltitude(altitude_m); });
          },
          py::arg("altitude_m"), kSetAltitude)
      .def("process", &GuardedLanding::Process, py::arg("image"), py::arg("time_ns"), py::kw_only(),
           py::arg("camera_index") = 0,
           "Processes a frame.\n\nimage: uint8 of shape (rows, columns), gray, of the camera's "
           "size; not copied.\ntime_ns: middle of the exposure, int, ns.\ncamera_index: of "
           "several cameras.\nReturns a LandingObservation. Lets other threads run.")
      .def("camera_fault", &GuardedLanding::FaultOf, py::arg("camera_index"),
           "Returns in words why one of several cameras does not contribute to the track; None "
           "where it does.")
      .def(
          "predict",
          [](GuardedLanding& self, Time time) {
            return self.With(
                [&](LandingPipeline& pipeline) { return pipeline.tracker().Predict(time); });
          },
          py::arg("time_ns"),
          "Returns the TargetEstimate of the track at a time, or None where it is not known.")
      .def("__repr__", [](const GuardedLanding& self) {
        return fmt::format("<LandingPipeline: a pad of {:.3g} m>",
                           self.pipeline().detector().shape().diameter_m);
      });
}

void BindHuntPipeline(py::module_& module) {
  py::class_<GuardedHunt, std::shared_ptr<GuardedHunt>>(
      module, "HuntPipeline",
      "The whole vision of a hunt: colour images and poses in; objects and their map out.")
      .def(py::init([](const CameraCalibration& calibration,
                       const std::shared_ptr<ObjectModel>& model, const py::object& options,
                       const py::kwargs& keywords) {
             const auto used = model ? model : std::make_shared<ObjectModel>(DefaultObjectModel());
             return std::make_shared<GuardedHunt>(
                 HuntPipeline(calibration, *used,
                              OptionsOf<HuntPipelineOptions>(
                                  options, keywords, [](const auto& file) { return file.hunt; })),
                 used);
           }),
           py::arg("calibration"), py::arg("model") = py::none(), py::arg("options") = py::none(),
           "model: ObjectModel; None: that of MBZIRC 2017.\noptions: a dict by the names of "
           "`kestrel config` under hunt, or the path of such a file; keyword arguments are "
           "options, too.")
      .def(
          "add_pose",
          [](GuardedHunt& self, const PoseSample& sample) {
            return self.With([&](HuntPipeline& pipeline) { return pipeline.AddPose(sample); });
          },
          py::arg("sample"), kAddPose)
      .def(
          "set_altitude",
          [](GuardedHunt& self, std::optional<double> altitude_m) {
            RequireAltitude(altitude_m);
            self.With([&](HuntPipeline& pipeline) { pipeline.SetAltitude(altitude_m); });
          },
          py::arg("altitude_m"), kSetAltitude)
      .def("process", &GuardedHunt::Process, py::arg("image"), py::arg("time_ns"),
           "Processes a frame.\n\nimage: uint8 of shape (rows, columns, 3), BGR, of the camera's "
           "size; not copied.\ntime_ns: middle of the exposure, int, ns.\nReturns a "
           "HuntObservation. Lets other threads run.")
      .def(
          "confirmed",
          [](GuardedHunt& self) {
            return self.With([](HuntPipeline& pipeline) { return pipeline.map().Confirmed(); });
          },
          "Returns the confirmed objects of the map, a list of MappedObject.")
      .def("__repr__", [](const GuardedHunt& self) {
        return fmt::format("<HuntPipeline: {} classes>",
                           self.pipeline().detector().model().classes.size());
      });
}

}  // namespace

void BindPipelines(py::module_& module) {
  BindLandingObservation(module);
  BindHuntObservation(module);
  BindFollowObservation(module);
  BindLandingPipeline(module);
  BindHuntPipeline(module);
}

}  // namespace kestrel::python
