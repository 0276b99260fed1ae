// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/core/base/time.h"
#include "kestrel/vision/objects/object_model.h"
#include "kestrel/vision/pipeline/hunt_pipeline.h"

namespace kestrel {

// The output of `kestrel hunt` for a recording, frame by frame. Facts that are not in the table
// (detections that are not on the ground, colours) are unknown. The ellipses lie around the
// objects' origins.
class HuntResult {
 public:
  // 'table': path of object_detections.csv. Throws InputError when it is not valid.
  explicit HuntResult(const std::string& table);

  // A model with nothing but the names of the classes in the table.
  const ObjectModel& model() const { return model_; }

  // Returns the next frame whose image could be read. Its time and its pose are given. Throws
  // InputError when the table has no row for it.
  HuntObservation Next(Time time, const std::optional<RigidTransform>& world_from_camera);
  // Throws InputError when the table has rows of further frames.
  void RequireEnd() const;

  const std::string& text() const { return text_; }
  // The summary of the run: "12 detections".
  std::string Found() const;

 private:
  std::size_t ClassIndex(const std::string& name);

  std::string file_;
  std::string text_;
  ObjectModel model_;
  std::vector<HuntObservation> frames_;
  std::size_t next_ = 0;
};

}  // namespace kestrel
