// SPDX-License-Identifier: BSD-3-Clause
// Rendered images of the landing pattern, and simulated flights.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "arrays.h"
#include "bindings.h"
#include "camera_argument.h"
#include "enum_casters.h"
#include "kestrel/app/evaluation/landing_truth.h"
#include "kestrel/calibration_reader.h"
#include "kestrel/frame_source.h"
#include "kestrel/io/recording/euroc/euroc_layout.h"
#include "kestrel/io/recording/euroc/euroc_recording.h"
#include "kestrel/recording_plan.h"
#include "kestrel/simulation/labelled_images/scene_renderer.h"
#include "kestrel/simulation/recordings/scenarios.h"
#include "kestrel/simulation/scene/landing_drawings.h"
#include "option_values.h"
#include "recordings.h"
#include "value_class.h"

namespace kestrel::python {
namespace {

namespace py = pybind11;

// Returns a file of a plan; empty when it has none of this name.
std::string TextOf(const RecordingPlan& plan, const std::string& name) {
  for (const RecordingFile& file : plan.files) {
    if (file.name == name) return file.text;
  }
  return "";
}

// The frames of a plan, each rendered when it is requested.
class RenderedFrames : public FrameSource {
 public:
  RenderedFrames(std::shared_ptr<const RecordingPlan> plan, std::vector<PoseSample> poses)
      : plan_(std::move(plan)), poses_(std::move(poses)) {}

  bool ReadNext(Frame* frame) override { return Read(next_, frame) && ++next_ > 0; }
  bool Read(std::size_t index, Frame* frame) const override {
    if (index >= plan_->times.size()) return false;
    const Time time = plan_->times[index];
    *frame = {fmt::format("cam0/data/{}.png", ToNanoseconds(time)), time, plan_->render(index)};
    return true;
  }
  std::optional<std::size_t> frame_count() const override { return plan_->times.size(); }
  double rate_hz() const override {
    const auto& times = plan_->times;
    return times.size() < 2 ? kNominalRateHz
                            : (times.size() - 1) / ToSeconds(times.back() - times.front());
  }
  std::vector<PoseSample> poses() const override { return poses_; }

 private:
  std::shared_ptr<const RecordingPlan> plan_;
  std::vector<PoseSample> poses_;
  std::size_t next_ = 0;
};

// A simulated flight, with its truth.
struct Simulation : Recording {
  std::shared_ptr<const RecordingPlan> plan;
};

// Flights over the landing pattern, or over coloured objects.
struct FlightKind {
  decltype(&PlanLandingScenario) plan;
  CameraCalibration (*calibration)();
  decltype(&LandingScenarios) scenarios;
};

FlightKind KindOf(bool is_hunt) {
  if (is_hunt) return {&PlanHuntScenario, &HuntCalibration, &HuntScenarios};
  return {&PlanLandingScenario, &PaperCalibration, &LandingScenarios};
}

Simulation Simulate(const std::string& scenario, bool is_hunt,
                    const std::optional<CameraCalibration>& camera, std::uint64_t seed,
                    const py::kwargs& settings) {
  const FlightKind kind = KindOf(is_hunt);
  auto plan = std::make_shared<const RecordingPlan>(
      kind.plan(scenario, Settings(settings), camera.value_or(kind.calibration()), seed));
  const CameraCalibration calibration =
      ParseCalibration(TextOf(*plan, "cam0/sensor.yaml"), "cam0/sensor.yaml");
  const std::vector<PoseSample> poses = ParsePoseRows(TextOf(*plan, euroc::kPoses), euroc::kPoses);
  const auto open = [plan, calibration, poses] {
    return OpenedSource{std::make_unique<RenderedFrames>(plan, poses), calibration};
  };
  return {{"sim:" + scenario, open, open()}, plan};
}

Frame FrameAt(const Simulation& self, std::ptrdiff_t index) {
  const auto count = static_cast<std::ptrdiff_t>(self.plan->times.size());
  if (index < -count || index >= count) throw py::index_error("no such frame");
  Frame frame;
  const py::gil_scoped_release release;
  self.opened.source->Read(static_cast<std::size_t>(index < 0 ? index + count : index), &frame);
  return frame;
}

bool Write(const Simulation& self, const std::filesystem::path& folder, bool replace) {
  const py::gil_scoped_release release;
  const int threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  return WriteRecording(*self.plan, folder, replace, threads, [](std::size_t) {
    const py::gil_scoped_acquire acquire;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    return true;
  });
}

void BindTruth(py::module_& module) {
  ValueClass<TruePattern>(module, "TruePattern", "The pattern at the time of an image.")
      .Field("time_ns", &TruePattern::time, "int, ns.")
      .Field("world_from_pattern", &TruePattern::world_from_pattern, "RigidTransform, m, ENU.")
      .Field("velocity_in_world", &TruePattern::velocity_in_world, "float64 of 3, m/s.")
      .Field("center_px", &TruePattern::center_px, "float64 of 2, px; may be out of view.")
      .Field("altitude_m", &TruePattern::altitude_m, "Height of the camera above it, m.")
      .Field("visible_fraction", &TruePattern::visible_fraction, "Part of it in view, 0 to 1.");
}

void BindFlight(py::module_& module) {
  py::class_<Simulation, Recording>(
      module, "SimulatedFlight",
      "A simulated flight: a recording whose frames are rendered when they are asked for. The same "
      "scenario, settings and seed give the same bytes.")
      .def("__len__", [](const Simulation& self) { return self.plan->times.size(); })
      .def("__getitem__", &FrameAt, py::arg("index"), "Renders a Frame. Lets other threads run.")
      .def_property_readonly(
          "true_patterns",
          [](const Simulation& self) {
            const std::string text = TextOf(*self.plan, euroc::kTruePatterns);
            return text.empty() ? std::vector<TruePattern>()
                                : ParseTruePatterns(text, euroc::kTruePatterns);
          },
          "List of TruePattern, one for each frame; empty for a hunt.")
      .def("write", &Write, py::arg("folder"), py::arg("replace") = false,
           "Writes the flight as a recording (EuRoC), as `kestrel simulate` does.")
      .def("__repr__", [](const Simulation& self) {
        return fmt::format("<SimulatedFlight {}: {} frames>", self.name, self.plan->times.size());
      });
  module.def("simulate", &Simulate, py::arg("scenario") = "calm", py::arg("hunt") = false,
             py::arg("camera") = py::none(), py::arg("seed") = 1,
             "Plans a SimulatedFlight over the landing pattern, or over coloured objects.\n\n"
             "scenario: one of scenarios().\ncamera: CameraCalibration with a mount; None: "
             "paper_calibration() or hunt_calibration().\nKeyword arguments: settings as of "
             "`kestrel simulate --set`, as frames=100, flight={'altitude_m': 5}.");
  module.def(
      "scenarios",
      [](bool is_hunt) {
        py::dict meanings;
        for (const Scenario& scenario : KindOf(is_hunt).scenarios()) {
          meanings[scenario.name] = scenario.meaning;
        }
        return meanings;
      },
      py::arg("hunt") = false, "Returns the names of the simulated flights with their meanings.");
}

// Draws the pattern on its board on level ground.
Scene SceneOf(const LandingPattern& pattern) {
  constexpr double kWhite = 0.9;
  constexpr double kBlack = 0.04;
  Scene scene;
  scene.layers.push_back({SquareBoard({0, 0}, pattern.board_size_m, 0), kWhite});
  scene.layers.push_back({LandingPatternInk(pattern), kBlack});
  return scene;
}

struct RenderQuality {
  double blur_sigma_px;
  double noise;
  double haze;
};

py::array Render(const CameraModel& camera, const RigidTransform& camera_from_target,
                 const py::dict& pattern, const RenderQuality& quality, std::uint64_t seed) {
  LandingPattern drawn;
  SetFields(pattern, FieldsOf(drawn));
  RequireValid(drawn);
  ImagingOptions imaging;
  imaging.blur_sigma_px = quality.blur_sigma_px;
  imaging.read_noise = quality.noise;
  imaging.haze = quality.haze;
  imaging.noise_seed = seed;
  Scene scene = SceneOf(drawn);
  scene.texture_seed = seed;
  cv::Mat image;
  {
    const py::gil_scoped_release release;
    image = SceneRenderer(camera).Render(scene, camera_from_target, imaging);
  }
  return ArrayOf(image);
}

void BindRendering(py::module_& module) {
  module.def(
      "render_pattern",
      [](const CameraArgument& camera, const RigidTransform& camera_from_target,
         const py::dict& pattern, double blur_sigma_px, double noise, double haze,
         std::uint64_t seed) {
        return Render(*camera.model, camera_from_target, pattern, {blur_sigma_px, noise, haze},
                      seed);
      },
      py::arg("camera"), py::arg("camera_from_target"), py::arg("pattern") = py::dict(),
      py::arg("blur_sigma_px") = 0.5, py::arg("noise") = 0, py::arg("haze") = 0,
      py::arg("seed") = 1,
      "Returns an image of the landing pattern on level ground, uint8 of the camera's size.\n\n"
      "camera_from_target: RigidTransform; the camera is above the pattern (its z axis is up).\n"
      "pattern: dict by the names of landing.detector.pattern.\nblur_sigma_px: of the optics, px. "
      "noise: standard deviation, gray values. haze: part of the light, 0 to 1.\nRaises InputError "
      "for a view from below.");
}

}  // namespace

void BindSimulation(py::module_& module) {
  BindTruth(module);
  BindFlight(module);
  BindRendering(module);
}

}  // namespace kestrel::python
