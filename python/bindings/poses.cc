// SPDX-License-Identifier: BSD-3-Clause
// Rigid transforms, and the poses of the UAV.
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "arrays.h"
#include "bindings.h"
#include "enum_casters.h"
#include "kestrel/pose_history.h"
#include "kestrel/rigid_transform.h"
#include "value_class.h"

namespace kestrel::python {
namespace {

namespace py = pybind11;

std::string Described(const RigidTransform& pose) {
  const auto& t = pose.translation;
  const auto& q = pose.rotation;
  return fmt::format(
      "RigidTransform(translation=[{:.6g}, {:.6g}, {:.6g}], quaternion=[{:.6g}, {:.6g}, {:.6g}, "
      "{:.6g}])",
      t.x(), t.y(), t.z(), q.w(), q.x(), q.y(), q.z());
}

Eigen::Vector4d Quaternion(const RigidTransform& pose) {
  const auto& q = pose.rotation;
  return {q.w(), q.x(), q.y(), q.z()};
}

void SetQuaternion(const py::handle& value, RigidTransform* pose) {
  const auto q = value.cast<Eigen::Vector4d>();
  if (!(std::abs(q.norm() - 1) < 0.01)) {
    throw InputError(
        fmt::format("quaternion: got [{}, {}, {}, {}], expected w, x, y, z of length 1", q[0], q[1],
                    q[2], q[3]));
  }
  pose->rotation = Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
  // A unit quaternion keeps its bits.
  if (std::abs(q.norm() - 1) > 1e-12) pose->rotation.normalize();
}

RigidTransform FromMatrix(const Eigen::Matrix4d& matrix) {
  const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
  const bool is_rigid =
      (rotation * rotation.transpose()).isIdentity(1e-4) && rotation.determinant() > 0 &&
      matrix.row(3).isApprox(Eigen::RowVector4d(0, 0, 0, 1)) && matrix.allFinite();
  if (!is_rigid) throw InputError("matrix: expected a rotation and a translation, 4 x 4");
  return {Eigen::Quaterniond(rotation).normalized(), matrix.topRightCorner<3, 1>()};
}

Eigen::Matrix4d Matrix(const RigidTransform& pose) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.topLeftCorner<3, 3>() = pose.rotation.toRotationMatrix();
  matrix.topRightCorner<3, 1>() = pose.translation;
  return matrix;
}

py::array_t<double> Apply(const RigidTransform& pose, const py::handle& values) {
  const auto points = PointsOf<double>(values, 3, "points");
  auto moved = ResultsFor(points, 3);
  const double* const in = points.data();
  double* const out = moved.mutable_data();
  for (std::size_t i = 0; i < points.count(); ++i) {
    Eigen::Map<Eigen::Vector3d>(out + 3 * i) = pose * Eigen::Vector3d(in + 3 * i);
  }
  return moved;
}

void BindTransform(py::module_& module) {
  ValueClass<RigidTransform>(
      module, "RigidTransform",
      "A rigid transform from frame A to frame B: b_from_a @ p_in_a is p_in_b. Named by "
      "cancellation: c_from_a = c_from_b @ b_from_a. Metres.")
      .Field("translation", &RigidTransform::translation, "float64 of 3, m.")
      .Field("quaternion", &Quaternion, &SetQuaternion,
             "The rotation as a unit quaternion, float64 of 4: w, x, y, z.")
      .Derived(
          "rotation",
          [](const RigidTransform& self) -> Eigen::Matrix3d {
            return self.rotation.toRotationMatrix();
          },
          "The rotation as a matrix, float64 3 x 3.")
      .Derived("matrix", &Matrix, "The transform as a matrix, float64 4 x 4.")
      .Repr(&Described)
      .py()
      .def_static("from_matrix", &FromMatrix, py::arg("matrix"),
                  "Returns the transform of a 4 x 4 matrix. Raises InputError where it is not "
                  "rigid.")
      .def("inverse", &RigidTransform::Inverse, "Returns a_from_b.")
      .def(
          "__matmul__",
          [](const RigidTransform& self, const RigidTransform& other) { return self * other; },
          py::arg("other"))
      .def("__matmul__", &Apply, py::arg("points"),
           "Composes transforms, or transforms points: N x 3 or 3, m.");
}

void BindSample(py::module_& module) {
  ValueClass<BodyMotion>(module, "BodyMotion", "Motion of the body.")
      .Field("velocity_in_world", &BodyMotion::velocity_in_world, "float64 of 3, m/s, ENU.")
      .Field("rate_in_body", &BodyMotion::rate_in_body,
             "Angular velocity, float64 of 3, rad/s, FLU.");
  ValueClass<PoseSample>(module, "PoseSample",
                         "Pose of the body (FLU) in the world (ENU) at an instant of the "
                         "navigation's clock.")
      .Field("time_ns", &PoseSample::time, "int, ns.")
      .Field("world_from_body", &PoseSample::world_from_body, "RigidTransform.")
      .Field("motion", &PoseSample::motion, "BodyMotion where the navigation reports it, or None.")
      .Field("time_sigma_s", &PoseSample::time_sigma_s, "Standard deviation of time_ns, s.");
  ValueClass<PoseUncertainty>(module, "PoseUncertainty",
                              "Standard deviations per axis that a predicted pose has beyond those "
                              "of the samples.")
      .Field("position_m", &PoseUncertainty::position_m, "m.")
      .Field("attitude_rad", &PoseUncertainty::attitude_rad, "rad.");
}

void BindHistory(py::module_& module) {
  py::class_<PoseHistory>(module, "PoseHistory",
                          "The latest poses of the UAV in order of time, with interpolation. The "
                          "newest sample replaces the oldest.")
      .def(py::init([](int capacity, Duration max_gap) {
             if (capacity < 1) throw InputError("capacity: expected 1 or more samples");
             return PoseHistory(static_cast<std::size_t>(capacity), max_gap);
           }),
           py::arg("capacity") = 1000, py::arg("max_gap_s") = 0.5,
           "Keeps up to 'capacity' samples. Between two of them more than 'max_gap_s' apart there "
           "is no pose.")
      .def("add", &PoseHistory::Add, py::arg("sample"),
           "Adds a PoseSample. Returns 'ok', 'out of order' or 'invalid'; what is not ok changes "
           "nothing.")
      .def("check", &PoseHistory::Check, py::arg("time_ns"),
           "Returns 'found' where lookup has a pose, or why it has none: 'no poses', 'too old', "
           "'too new', 'gap'.")
      .def("lookup", &PoseHistory::Lookup, py::arg("time_ns"),
           "Returns world_from_body at 'time_ns', interpolated between two samples, or None.")
      .def("smooth", &PoseHistory::Smooth, py::arg("time_ns"), py::arg("half_window_s"),
           "The same with less noise: from the samples up to 'half_window_s' before and after.")
      .def("__len__", &PoseHistory::size)
      .def("__repr__", [](const PoseHistory& self) {
        return fmt::format("<PoseHistory: {} of {} samples>", self.size(), self.capacity());
      });
}

}  // namespace

void BindPoses(py::module_& module) {
  BindTransform(module);
  BindSample(module);
  BindHistory(module);
}

}  // namespace kestrel::python
