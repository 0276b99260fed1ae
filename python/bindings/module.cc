// SPDX-License-Identifier: BSD-3-Clause
// The extension of the Python package `kestrel`.
#include "bindings.h"
#include "kestrel/version.h"

PYBIND11_MODULE(_kestrel, module) {
  using namespace kestrel::python;
  module.doc() = "The compiled part of kestrel.";
  module.attr("__version__") = kestrel::kVersion;
  BindErrors(module);
  BindEnums(module);
  BindPoses(module);
  BindCameras(module);
  BindDetection(module);
  BindDetectors(module);
  BindObjects(module);
  BindTracking(module);
  BindRegions(module);
  BindMaps(module);
  BindPipelines(module);
  BindRecordings(module);
  BindSimulation(module);
  BindDrawing(module);
  BindSession(module);
  BindEvaluation(module);
  BindCalibration(module);
  BindTeam(module);
}
