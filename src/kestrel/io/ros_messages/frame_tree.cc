// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/ros_messages/frame_tree.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace kestrel {
namespace {

// Largest difference between repeated messages of a fixed transform.
constexpr double kSameTranslation_m = 1e-6;
constexpr double kSameRotation_rad = 1e-6;

bool IsSame(const RigidTransform& a, const RigidTransform& b) {
  return (a.translation - b.translation).norm() < kSameTranslation_m &&
         a.rotation.angularDistance(b.rotation) < kSameRotation_rad;
}

}  // namespace

std::optional<RigidTransform> TransformOf(const TransformMessage& message) {
  constexpr double kUnitTolerance = 0.01;
  const auto& [p, q] = message;
  RigidTransform transform{{q.w, q.x, q.y, q.z}, {p.x, p.y, p.z}};
  const bool is_unit = std::abs(transform.rotation.norm() - 1) <= kUnitTolerance;  // false for NaN
  if (!is_unit || !transform.translation.allFinite()) return std::nullopt;
  transform.rotation.normalize();
  return transform;
}

std::optional<RigidTransform> TransformOf(const PoseMessage& pose) {
  const auto& [p, q] = pose;
  return TransformOf(TransformMessage{{p.x, p.y, p.z}, q});
}

PoseMessage PoseMessageOf(const RigidTransform& transform) {
  const auto [p, q] = TransformMessageOf(transform);
  return {{p.x, p.y, p.z}, q};
}

TransformMessage TransformMessageOf(const RigidTransform& transform) {
  const Eigen::Vector3d& p = transform.translation;
  const Eigen::Quaterniond& q = transform.rotation;
  return {{p.x(), p.y(), p.z()}, {q.x(), q.y(), q.z(), q.w()}};
}

std::string FrameName(const std::string& frame_id) {
  return frame_id.starts_with('/') ? frame_id.substr(1) : frame_id;
}

void FrameTree::Add(const TransformStampedMessage& transform) {
  const std::string frame = FrameName(transform.child_frame_id);
  const std::string parent = FrameName(transform.header.frame_id);
  const auto parent_from_frame = TransformOf(transform.transform);
  if (!parent_from_frame || frame == parent) return;
  const auto [link, is_new] = links_.try_emplace(frame, Link{parent, *parent_from_frame});
  if (is_new) return;
  if (link->second.parent != parent ||
      !IsSame(link->second.parent_from_frame, *parent_from_frame)) {
    link->second.is_fixed = false;
  }
}

bool FrameTree::Has(const std::string& frame) const {
  return links_.contains(frame) || std::any_of(links_.begin(), links_.end(), [&](const auto& link) {
           return link.second.parent == frame;
         });
}

bool FrameTree::IsFixed(const std::string& frame) const {
  const auto link = links_.find(frame);
  return link != links_.end() && link->second.is_fixed;
}

std::vector<std::string> FrameTree::ChainToRoot(const std::string& frame, bool only_fixed) const {
  std::vector<std::string> chain{frame};
  // The number of links is the limit: frames may be each other's parents.
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const auto link = links_.find(chain.back());
    if (link == links_.end() || (only_fixed && !link->second.is_fixed)) break;
    chain.push_back(link->second.parent);
  }
  return chain;
}

std::optional<RigidTransform> FrameTree::Fixed(const std::string& to,
                                               const std::string& from) const {
  const std::vector<std::string> above_to = ChainToRoot(to, /*only_fixed=*/true);
  RigidTransform ancestor_from_from;
  for (const std::string& ancestor : ChainToRoot(from, /*only_fixed=*/true)) {
    const auto common = std::find(above_to.begin(), above_to.end(), ancestor);
    if (common != above_to.end()) {
      RigidTransform ancestor_from_to;
      for (auto frame = above_to.begin(); frame != common; ++frame) {
        ancestor_from_to = links_.at(*frame).parent_from_frame * ancestor_from_to;
      }
      return ancestor_from_to.Inverse() * ancestor_from_from;
    }
    const auto link = links_.find(ancestor);
    if (link == links_.end()) break;
    ancestor_from_from = link->second.parent_from_frame * ancestor_from_from;
  }
  return std::nullopt;
}

}  // namespace kestrel
