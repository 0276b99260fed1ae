// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/ros/live_transforms.h"

#include <cstddef>

#include "kestrel/io/ros_messages/frame_tree.h"

namespace kestrel {

void LiveTransforms::Add(const TransformStampedMessage& transform, bool is_static) {
  const auto parent_from_frame = TransformOf(transform.transform);
  if (!parent_from_frame) return;
  links_[FrameName(transform.child_frame_id)] = {FrameName(transform.header.frame_id),
                                                 *parent_from_frame, is_static};
}

std::vector<LiveTransforms::Ancestor> LiveTransforms::AncestorsOf(const std::string& frame,
                                                                  bool only_static) const {
  std::vector<Ancestor> ancestors{{frame, {}}};
  // Bounded by the number of links: a wrong tree may have a cycle.
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const auto link = links_.find(ancestors.back().name);
    if (link == links_.end() || (only_static && !link->second.is_static)) break;
    ancestors.push_back({link->second.parent,
                         link->second.parent_from_frame * ancestors.back().ancestor_from_frame});
  }
  return ancestors;
}

std::optional<RigidTransform> LiveTransforms::Fixed(const std::string& to,
                                                    const std::string& from) const {
  const std::vector<Ancestor> above_to = AncestorsOf(to, /*only_static=*/true);
  for (const Ancestor& above_from : AncestorsOf(from, /*only_static=*/true)) {
    for (const Ancestor& common : above_to) {
      if (common.name != above_from.name) continue;
      return common.ancestor_from_frame.Inverse() * above_from.ancestor_from_frame;
    }
  }
  return std::nullopt;
}

std::optional<LiveTransforms::WorldPose> LiveTransforms::PoseBy(
    const TransformStampedMessage& transform, const std::string& body) const {
  const std::string moving = AncestorsOf(body, /*only_static=*/true).back().name;
  if (moving != FrameName(transform.child_frame_id)) return std::nullopt;
  const Ancestor root = AncestorsOf(body, /*only_static=*/false).back();
  if (root.name == body) return std::nullopt;
  return WorldPose{root.name, {transform.header.stamp, root.ancestor_from_frame}};
}

}  // namespace kestrel
