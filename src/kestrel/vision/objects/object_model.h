// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kestrel/vision/objects/color/color_model.h"

namespace kestrel {

enum class ObjectShape {
  kDisc,    // a horizontal disc
  kCuboid,  // a cuboid with a white digit on its upper face
  kBar,     // a long horizontal rectangle
};
const char* ToString(ObjectShape shape);  // "disc", "cuboid", "bar"

// A class of objects: its appearance and its score. Configured, not coded.
struct ObjectClass {
  std::string name;       // name in reports; classes of different shapes may share one
  std::size_t color = 0;  // index in the model's colours
  ObjectShape shape = ObjectShape::kDisc;
  double size_m = 0.2;      // m: diameter, edge of the upper face, or length of the bar
  double width_m = 0;       // m, of a bar
  double height_m = 0;      // m, upper face above the ground
  double max_height_m = 0;  // m, more where it may also stand on a moving robot
  double score = 1;
  bool may_move = false;
};

// The objects to find: the colours, and the classes that have them.
struct ObjectModel {
  ColorModel colors;
  std::vector<ObjectClass> classes;

  // Returns every violation in words: those of the colours, and classes without a name or a size.
  std::vector<std::string> Validate() const;
};

// Reads a model from YAML such as `objects.yaml` beside this file. 'file' is for messages. Throws
// InputError, with the line, for entries that are missing, unknown, of the wrong type or
// contradictory.
ObjectModel ParseObjectModel(const std::string& yaml, const std::string& file);
ObjectModel ReadObjectModel(const std::string& path);

// Writes YAML from which ParseObjectModel reads the same model.
std::string PrintObjectModel(const ObjectModel& model);

// The objects of MBZIRC 2017: red, green and blue discs, yellow moving discs, the long orange bar,
// and the cuboids with digits that were planned earlier. The colours suit a daylight camera with a
// roughly correct white balance.
ObjectModel DefaultObjectModel();

}  // namespace kestrel
