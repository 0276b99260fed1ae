// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pybind11/pybind11.h>
#include <string>

namespace kestrel::python {

// Issues a UserWarning of Python. Throws it where the user has made errors of warnings.
void Warn(const std::string& text);

// Each adds the classes and functions of one subject to the module. A function may use the classes
// of those before it.
void BindErrors(pybind11::module_& module);
void BindEnums(pybind11::module_& module);
void BindCameras(pybind11::module_& module);
void BindPoses(pybind11::module_& module);
void BindDetection(pybind11::module_& module);
void BindDetectors(pybind11::module_& module);
void BindObjects(pybind11::module_& module);
void BindTracking(pybind11::module_& module);
void BindRegions(pybind11::module_& module);
void BindMaps(pybind11::module_& module);
void BindPipelines(pybind11::module_& module);
void BindRecordings(pybind11::module_& module);
void BindSimulation(pybind11::module_& module);
void BindDrawing(pybind11::module_& module);
void BindSession(pybind11::module_& module);
void BindEvaluation(pybind11::module_& module);
void BindCalibration(pybind11::module_& module);
void BindTeam(pybind11::module_& module);

}  // namespace kestrel::python
