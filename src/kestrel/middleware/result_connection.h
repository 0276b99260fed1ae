// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "kestrel/bags/messages.h"
#include "kestrel/bags/result_messages.h"

namespace kestrel {

// What a node publishes. A name without a slash is below the node's own.
enum class ResultTopic : std::size_t {
  kDetections,
  kTargetPose,
  kTrack,
  kPrediction,
  kMarkers,
  kAnnotatedImage,
  kTransforms,
  kDiagnostics,
  kMap,  // this and the next are of the node of ROS 1 only
  kMapMarkers,
};

struct ResultTopicInfo {
  std::string_view name;
  std::string_view type;
  bool is_latched = false;  // who comes later gets the newest, too
};

inline constexpr std::array kResultTopics = {
    // in the order of ResultTopic
    ResultTopicInfo{"detections", Detection3DArrayMessage::kType},
    ResultTopicInfo{"target_pose", PoseWithCovarianceStampedMessage::kType},
    ResultTopicInfo{"track", OdometryMessage::kType},
    ResultTopicInfo{"prediction", PathMessage::kType},
    ResultTopicInfo{"markers", MarkerArrayMessage::kType},
    ResultTopicInfo{"image_annotated", ImageMessage::kType},
    ResultTopicInfo{"/tf", TfMessage::kType},
    ResultTopicInfo{"/diagnostics", DiagnosticArrayMessage::kType},
    ResultTopicInfo{"map", Detection3DArrayMessage::kType, true},
    ResultTopicInfo{"map_markers", MarkerArrayMessage::kType, true},
};

// The way of results to others. All calls from any thread.
class ResultConnection {
 public:
  virtual ~ResultConnection() = default;

  virtual bool HasSubscribers(ResultTopic topic) const = 0;
  virtual void Publish(ResultTopic topic, const std::string& bytes) = 0;
};

}  // namespace kestrel
