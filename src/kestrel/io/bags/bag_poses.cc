// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/bags/bag_poses.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/shown.h"
#include "kestrel/io/ros_messages/messages.h"
#include "kestrel/io/ros_messages/pose_message.h"
#include "kestrel/io/ros_messages/serialization.h"

namespace kestrel {
namespace {

constexpr const char* kDefaultBody = "base_link";

// Collects poses, which may be out of order or wrong.
class PoseList {
 public:
  PoseList(bool use_arrival_times, std::string name)
      : use_arrival_times_(use_arrival_times), name_(std::move(name)) {}

  void Add(Time stamp, Time arrival, const std::optional<RigidTransform>& pose,
           const std::optional<TwistMessage>& twist) {
    if (!pose || (!use_arrival_times_ && ToNanoseconds(stamp) <= 0)) {
      unstamped_ += pose.has_value();
      invalid_ += !pose.has_value();
      return;
    }
    poses_.push_back({use_arrival_times_ ? arrival : stamp, *pose,
                      twist ? MotionOf(*twist, *pose) : std::nullopt});
  }

  // Returns the poses in order. What is wrong with them is written to 'remark'.
  std::vector<PoseSample> Take(std::string* remark) {
    if (poses_.empty() && unstamped_ > 0) {
      throw InputError(name_ +
                       ": the poses have no stamps (zero), expected the time of each; "
                       "--arrival-times takes when they were recorded");
    }
    std::stable_sort(poses_.begin(), poses_.end(),
                     [](const PoseSample& a, const PoseSample& b) { return a.time < b.time; });
    const auto end = std::unique(poses_.begin(), poses_.end(),
                                 [](const auto& a, const auto& b) { return a.time == b.time; });
    const auto repeated = poses_.end() - end;
    poses_.erase(end, poses_.end());
    if (invalid_ + unstamped_ > 0) {
      *remark = fmt::format(
          "{}: poses left out: {} that are not finite or no unit quaternion, {} without a stamp",
          name_, invalid_, unstamped_);
    } else if (repeated > 0) {
      *remark = fmt::format("{}: {} poses with the stamp of another are left out", name_, repeated);
    }
    return std::move(poses_);
  }

 private:
  bool use_arrival_times_;
  std::string name_;
  std::vector<PoseSample> poses_;
  std::size_t invalid_ = 0;
  std::size_t unstamped_ = 0;
};

// Poses of 'body' in the root frame, one for each message of the moving frame nearest to the body.
class TransformPoses {
 public:
  TransformPoses(const FrameTree& tree, const std::string& body)
      : chain_(tree.ChainToRoot(body, /*only_fixed=*/false)) {
    chain_.pop_back();  // the root has no transform
    const auto moving = std::find_if(chain_.begin(), chain_.end(), [&](const std::string& frame) {
      return !tree.IsFixed(frame);
    });
    if (moving != chain_.end()) moving_ = *moving;
  }

  bool HasPoses() const { return !moving_.empty(); }

  void Add(const TransformStampedMessage& transform, Time arrival, PoseList* poses) {
    const std::string frame = FrameName(transform.child_frame_id);
    if (std::find(chain_.begin(), chain_.end(), frame) == chain_.end()) return;
    const auto parent_from_frame = TransformOf(transform.transform);
    if (parent_from_frame) newest_[frame] = *parent_from_frame;
    if (frame != moving_) return;
    std::optional<RigidTransform> root_from_body = RigidTransform();
    for (const std::string& link : chain_) {
      const auto known = newest_.find(link);
      if (known == newest_.end()) return;  // not all of the transforms are known yet
      root_from_body = known->second * *root_from_body;
    }
    if (!parent_from_frame) root_from_body.reset();
    poses->Add(transform.header.stamp, arrival, root_from_body, std::nullopt);
  }

 private:
  std::vector<std::string> chain_;  // from the body to the root
  std::string moving_;              // the first frame of the chain that moves
  std::map<std::string, RigidTransform> newest_;
};

std::string NameOfTopic(const BagReader& bag, std::size_t topic, const std::string& path) {
  return fmt::format("{}: {}", path, bag.topics()[topic].name);
}

// Returns the frame whose poses are wanted.
std::string FindBody(const FrameTree& tree, const std::string& given, const std::string& camera) {
  for (const std::string& body : {given, std::string(kDefaultBody)}) {
    if (!body.empty() && tree.Has(body)) return body;
  }
  return tree.ChainToRoot(camera, /*only_fixed=*/true).back();
}

// Reads the poses from tf, for a bag without a topic of poses.
std::vector<PoseSample> ReadTransformPoses(BagReader* bag, const std::vector<std::size_t>& topics,
                                           const FrameTree& tree, const std::string& body,
                                           bool use_arrival_times, const std::string& path,
                                           std::string* remark) {
  TransformPoses transform_poses(tree, body);
  if (!transform_poses.HasPoses()) return {};
  PoseList poses(use_arrival_times, fmt::format("{}: tf of {}", path, Shown(body)));
  bag->Select(topics);
  for (BagMessage message; bag->Next(&message);) {
    const std::string name = NameOfTopic(*bag, message.topic, path);
    const WireFormat format = bag->topics()[message.topic].wire_format;
    for (const auto& transform : ParseMessage<TfMessage>(message.data, format, name).transforms) {
      transform_poses.Add(transform, message.arrival, &poses);
    }
  }
  return poses.Take(remark);
}

}  // namespace

BagPoses ReadPoses(BagReader* bag, const TopicChoice& topics, const std::string& camera_frame,
                   bool use_arrival_times, const std::string& path) {
  std::vector<std::size_t> selected = topics.transforms;
  if (topics.pose) selected.push_back(*topics.pose);
  const std::string pose_name = topics.pose ? NameOfTopic(*bag, *topics.pose, path) : "";
  FrameTree tree;
  PoseList poses(use_arrival_times, pose_name);
  std::string pose_body;
  bag->Select(selected);
  for (BagMessage message; bag->Next(&message);) {
    const RosTopic& topic = bag->topics()[message.topic];
    if (message.topic == topics.pose) {
      const StampedPose pose = ParsePose(topic.type, message.data, topic.wire_format, pose_name);
      if (pose_body.empty()) pose_body = FrameName(pose.body);
      poses.Add(pose.stamp, message.arrival, pose.pose, pose.twist);
    } else {
      const std::string name = NameOfTopic(*bag, message.topic, path);
      for (const auto& transform :
           ParseMessage<TfMessage>(message.data, topic.wire_format, name).transforms) {
        tree.Add(transform);
      }
    }
  }

  BagPoses result;
  const std::string camera = FrameName(camera_frame);
  const std::string body = FindBody(tree, pose_body, camera);
  if (!camera.empty() && tree.Has(camera) && body != camera) {
    result.body_from_camera = tree.Fixed(body, camera);
  }
  result.poses = topics.pose ? poses.Take(&result.remark)
                             : ReadTransformPoses(bag, topics.transforms, tree, body,
                                                  use_arrival_times, path, &result.remark);
  return result;
}

}  // namespace kestrel
