// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/vision/mapping/object_map.h"
#include "kestrel/vision/objects/object_detector.h"

namespace kestrel {

// Decides whether a frame should have shown an object of the map: the object lies well inside of
// the image and is large enough there, its position is known, and no detection at its position may
// hide it (a cut-off or merged object does not prove that it is gone).
class ObjectView : public FieldOfView {
 public:
  // All must outlive the view. 'saw_all': the frame was searched completely.
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
