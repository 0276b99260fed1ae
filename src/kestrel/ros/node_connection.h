// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "kestrel/bags/messages.h"
#include "kestrel/bags/result_messages.h"
#include "kestrel/base/time.h"

namespace kestrel {

// What the node publishes. A name without a slash is below the node's own.
enum class NodeTopic : std::size_t {
  kDetections,
  kTargetPose,
  kTrack,
  kPrediction,
  kMarkers,
  kAnnotatedImage,
  kTransforms,
  kDiagnostics,
};

struct NodeTopicInfo {
  std::string_view name;
  std::string_view type;
};

inline constexpr std::array kNodeTopics = {
    // in the order of NodeTopic
    NodeTopicInfo{"detections", Detection3DArrayMessage::kType},
    NodeTopicInfo{"target_pose", PoseWithCovarianceStampedMessage::kType},
    NodeTopicInfo{"track", OdometryMessage::kType},
    NodeTopicInfo{"prediction", PathMessage::kType},
    NodeTopicInfo{"markers", MarkerArrayMessage::kType},
    NodeTopicInfo{"image_annotated", ImageMessage::kType},
    NodeTopicInfo{"/tf", TfMessage::kType},
    NodeTopicInfo{"/diagnostics", DiagnosticArrayMessage::kType},
};

// The way of the node's messages to others. All calls from any thread.
class NodeConnection {
 public:
  virtual ~NodeConnection() = default;

  virtual bool HasSubscribers(NodeTopic topic) const = 0;
  virtual void Publish(NodeTopic topic, const std::string& bytes) = 0;
  virtual void Warn(const std::string& text) = 0;
  // On the clock of the stamps.
  virtual Time StampNow() const = 0;
};

}  // namespace kestrel
