// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/app/console/replay_frame.h"
#include "kestrel/core/base/time.h"
#include "kestrel/vision/objects/object_model.h"
#include "kestrel/vision/pipeline/hunt_pipeline.h"

namespace kestrel {

// What `kestrel hunt` wrote of a recording, frame by frame. What a table does not hold (what was
// not on the ground, colours) is not known; ellipses are drawn around the objects' origins.
class HuntResult {
 public:
  // 'table': object_detections.csv. Throws InputError for what is at fault in it.
  explicit HuntResult(const std::string& table);

  // Nothing but the names of the classes that are in the table.
  const ObjectModel& model() const { return model_; }

  // The next frame, which is of this time and seen from there. Throws InputError when the table has
  // not a row of it.
  HuntObservation Next(Time time, const std::optional<RigidTransform>& world_from_camera);
  // Throws InputError when there are rows of further frames.
  void RequireEnd() const;

  const std::string& text() const { return text_; }

 private:
  std::size_t ClassIndex(const std::string& name);

  std::string file_;
  std::string text_;
  ObjectModel model_;
  std::vector<HuntObservation> frames_;
  std::size_t next_ = 0;
};

// The objects of object_map.csv that stand, since they were first seen: where one that moves is
// since it was last seen nobody knows. Throws InputError for what is at fault; 'file': for that.
std::vector<MapEntry> StandingObjects(const std::string& map_csv, const std::string& file);

}  // namespace kestrel
