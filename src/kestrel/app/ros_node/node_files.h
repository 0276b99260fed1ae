// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "kestrel/app/ros_node/node_options.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/vision/objects/color_grid.h"
#include "kestrel/vision/objects/object_model.h"

namespace kestrel {

// The objects that the hunt looks for.
struct HuntedObjects {
  ObjectModel model;
  ColorGrid grid;
};

// The content of the files that the options name.
struct NodeFiles {
  std::optional<CameraCalibration> calibration;  // nothing: it comes from camera_info
  std::optional<HuntedObjects> objects;          // for the hunt; built-in ones without files
};

// Throws InputError when a file is not valid.
NodeFiles ReadNodeFiles(const NodeOptions& options);

}  // namespace kestrel
