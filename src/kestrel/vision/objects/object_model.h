// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kestrel/vision/objects/color_model.h"

namespace kestrel {

enum class ObjectShape {
  kDisc,    // a horizontal disc
  kCuboid,  // a cube whose upper face has a white digit
  kBar,     // a long horizontal rectangle
};
const char* ToString(ObjectShape shape);  // "disc", "cuboid", "bar"

// A kind of object: what it looks like and what it is worth. Configured, not coded.
struct ObjectClass {
  std::string name;       // as reported; classes of different shapes may share one
  std::size_t color = 0;  // index in the model's colours
  ObjectShape shape = ObjectShape::kDisc;
  double size_m = 0.2;      // diameter, edge of the upper face, length of the bar
  double width_m = 0;       // of a bar
  double height_m = 0;      // of the upper face above the ground
  double max_height_m = 0;  // where the same object may also stand higher (a moving robot)
  double score = 1;
  bool may_move = false;
};

// What there is to be found: the colours and the classes that have them.
struct ObjectModel {
  ColorModel colors;
  std::vector<ObjectClass> classes;

  // Every violation in words: those of the colours, and classes without a name or a size.
  std::vector<std::string> Validate() const;
};

// Model from YAML, as `objects.yaml` beside this file. 'file' is for messages. Throws
// InputError, with the line, for what is missing, unknown, of the wrong type or contradictory.
ObjectModel ParseObjectModel(const std::string& yaml, const std::string& file);
ObjectModel ReadObjectModel(const std::string& path);

// YAML from which ParseObjectModel gets the same model.
std::string PrintObjectModel(const ObjectModel& model);

// The objects of MBZIRC 2017: red, green and blue discs, yellow moving ones, the long orange one,
// and the cuboids with digits that were planned before. Their colours hold for a daylight camera
// with its white balance about right.
ObjectModel DefaultObjectModel();

}  // namespace kestrel
