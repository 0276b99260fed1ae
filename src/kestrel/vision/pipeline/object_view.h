// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/vision/mapping/object_map.h"
#include "kestrel/vision/objects/object_detector.h"

namespace kestrel {

// Says of an object in the map whether a frame should have shown it: it lies well inside of the
// image and is large enough there, its place is known, and nothing was found where it should be
// that may hide it (what is cut off or merged is no proof that it is gone).
class ObjectView : public FieldOfView {
 public:
  // All must outlive the view. 'saw_all': the frame was searched as a whole.
  ObjectView(const ObjectDetector& detector, const ObjectReport& report,
             const RigidTransform& world_from_camera, bool saw_all)
      : detector_(detector),
        report_(report),
        camera_from_world_(world_from_camera.Inverse()),
        saw_all_(saw_all) {}

  bool Shows(const MappedObject& object) const override;

 private:
  const ObjectDetector& detector_;
  const ObjectReport& report_;
  RigidTransform camera_from_world_;
  bool saw_all_;
};

}  // namespace kestrel
