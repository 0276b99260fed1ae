// SPDX-License-Identifier: BSD-3-Clause
// The tracker of a vehicle.
#include <string>

#include <fmt/format.h>

#include "bindings.h"
#include "enum_casters.h"
#include "kestrel/target_tracker.h"
#include "option_values.h"
#include "value_class.h"

namespace kestrel::python {
namespace {

namespace py = pybind11;

void BindMeasurement(py::module_& module) {
  using Measurement = TargetMeasurement;
  ValueClass<Measurement>(module, "TargetMeasurement",
                          "A measured position of the target at the time of an image.",
                          {{}, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero()})
      .Field("time_ns", &Measurement::time, "int, ns.")
      .Field("position_in_world", &Measurement::position_in_world, "float64 of 3, ENU, m.")
      .Field("covariance", &Measurement::covariance, "Of this position alone, float64 3 x 3, m^2.")
      .Field("shared_covariance", &Measurement::shared_covariance,
             "Of the error that all measurements share, float64 3 x 3, m^2.")
      .Field("yaw", &Measurement::yaw, "Yaw of the target, rad, or None.")
      .Field("yaw_variance", &Measurement::yaw_variance, "rad^2.")
      .Field("yaw_period", &Measurement::yaw_period,
             "Turn (rad) after which the target looks the same.");
}

void BindEstimate(py::module_& module) {
  using Estimate = TargetEstimate;
  ValueClass<TurnState>(module, "TurnState",
                        "State of the motion: position and velocity (3 each), turn rate and its "
                        "derivative, sway's part of position and velocity (2 each), yaw.")
      .Field("mean", &TurnState::mean, "float64 of 13.")
      .Field("covariance", &TurnState::covariance, "float64 13 x 13.");
  ValueClass<Estimate>(module, "TargetEstimate", "The target at one time, in the world (ENU).")
      .Field("time_ns", &Estimate::time, "int, ns.")
      .Field("motion", &Estimate::motion, "TurnState.")
      .Field("yaw_period", &Estimate::yaw_period,
             "Turn (rad) modulo which `yaw` is its heading; 0: no yaw was measured.")
      .Derived(
          "position",
          [](const Estimate& self) -> Eigen::Vector3d { return self.motion.position(); },
          "float64 of 3, m.")
      .Derived(
          "velocity",
          [](const Estimate& self) -> Eigen::Vector3d { return self.motion.velocity(); },
          "float64 of 3, m/s.")
      .Derived(
          "yaw", [](const Estimate& self) { return self.motion.yaw(); }, "rad.")
      .Derived(
          "turn_rate", [](const Estimate& self) { return self.motion.turn_rate(); }, "rad/s.")
      .Derived("speed", &Estimate::speed, "Horizontal, m/s.")
      .Derived("heading", &Estimate::heading, "Of the velocity, rad from east to north.")
      .Derived("position_sigma_m", &Estimate::position_sigma_m, "Standard deviation per axis, m.")
      .Derived("velocity_sigma_mps", &Estimate::velocity_sigma_mps,
               "Standard deviation per axis, m/s.")
      .Repr([](const Estimate& self) {
        const auto position = self.motion.position();
        return fmt::format(
            "<TargetEstimate: at ({:.2f}, {:.2f}, {:.2f}) m, sigma {:.3f} m, {:.2f} m/s>",
            position.x(), position.y(), position.z(), self.position_sigma_m(), self.speed());
      });
}

}  // namespace

void BindTracking(py::module_& module) {
  BindMeasurement(module);
  BindEstimate(module);
  py::class_<TargetTracker>(module, "TargetTracker",
                            "Tracks one ground vehicle: measured positions in, late ones too; its "
                            "motion now and in the near future out.")
      .def(py::init([](const py::object& options, const py::kwargs& keywords) {
             return TargetTracker(OptionsOf<TargetTrackerOptions>(
                 options, keywords, [](const auto& file) { return file.landing.tracker; }));
           }),
           py::arg("options") = py::none(),
           "options: a dict by the names of `kestrel config` under landing.tracker, or the path of "
           "such a file; keyword arguments are options, too.")
      .def("add", &TargetTracker::Add, py::arg("measurement"),
           "Adds a TargetMeasurement. Returns what became of it: 'started', 'accepted', 'invalid', "
           "'too old', 'far from the track'.")
      .def("state_at", &TargetTracker::StateAt, py::arg("time_ns"),
           "Returns 'searching', 'tracking', 'predicting' or 'lost'.")
      .def("predict", &TargetTracker::Predict, py::arg("time_ns"),
           "Returns the TargetEstimate of a time, predicted after the newest measurement; None "
           "before the oldest one and when the target is lost.");
}

}  // namespace kestrel::python
