// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/ros_node/node_files.h"

#include "kestrel/core/camera/calibration_reader.h"

namespace kestrel {
namespace {

HuntedObjects ReadObjects(const NodeOptions& options) {
  const ObjectModel model =
      options.model.empty() ? DefaultObjectModel() : ReadObjectModel(options.model);
  return {model, options.grid.empty() ? ColorGrid(model.colors)
                                      : ColorGrid::Load(options.grid, model.colors.colors.size())};
}

}  // namespace

NodeFiles ReadNodeFiles(const NodeOptions& options) {
  NodeFiles files;
  if (!options.camera.empty()) files.calibration = ReadCalibration(options.camera);
  if (options.is_hunt()) files.objects = ReadObjects(options);
  return files;
}

}  // namespace kestrel
