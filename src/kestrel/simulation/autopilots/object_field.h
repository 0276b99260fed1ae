// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "kestrel/core/base/limits.h"
#include "kestrel/core/base/random.h"
#include "kestrel/simulation/autopilots/taken_marks.h"
#include "kestrel/simulation/scene/hunt_objects.h"
#include "kestrel/simulation/scene/world.h"

namespace kestrel {

// A field of coloured objects around the origin of the world.
struct ObjectFieldOptions {
  double length_m = 0;
  double width_m = 20;
  std::string shared_file;
  HuntObjectsOptions objects;

  static void Visit(auto& self, auto&& visit) {
    visit("length_m", self.length_m, Range{0, 200}, "from east to west; 0: no field");
    visit("width_m", self.width_m, Range{2, 200}, "from north to south");
    visit("shared_file", self.shared_file,
          "file by which programs that share the field know what was taken; empty: none");
    visit.Group("objects", self.objects);
  }

  bool is_there() const { return length_m > 0; }
};

// The objects of a field. A gripper takes them: they are then not seen any more. Thread-safe once
// they are drawn; stays where it is.
class ObjectField {
 public:
  // Adds the objects to the world, which this must outlive. Throws InputError when the shared file
  // cannot be used.
  void Draw(const ObjectFieldOptions& options, Random* random, World* world);

  // A gripper's try. Distances are those of the nearest object that is there.
  struct Grab {
    int object = 0;       // its number
    double offset_m = 0;  // horizontal distance of its middle
    double height_m = 0;  // height of the gripper above it
    bool is_taken = false;
  };
  // Closes a gripper at this place (m, world) and takes the nearest object, if it is within reach:
  // its edge 3 cm further than the gripper (the paper's section 4), and 0.1 m above or below.
  // Nothing: there is no object.
  std::optional<Grab> Close(double time_s, const Eigen::Vector3d& gripper);

  const std::vector<HuntObject>& objects() const { return objects_; }
  // Whether this one of them, by its place in the list, was taken.
  bool is_taken(std::size_t index) const { return (*taken_)[index]; }

 private:
  std::vector<HuntObject> objects_;
  std::optional<TakenMarks> taken_;
};

}  // namespace kestrel
