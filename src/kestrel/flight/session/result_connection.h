// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "kestrel/io/ros_messages/messages.h"
#include "kestrel/io/ros_messages/result_messages.h"
#include "kestrel/io/ros_messages/tag_messages.h"

namespace kestrel {

// Topics of a node's results. A name without a slash is below the node's own.
enum class ResultTopic : std::size_t {
  kDetections,
  kTargetPose,
  kTrack,
  kPrediction,
  kMarkers,
  kAnnotatedImage,
  kTransforms,
  kDiagnostics,
  kTeamMap,
  kTeamMarkers,
  kStaticTransforms,
  kTags,
};

struct ResultTopicInfo {
  std::string_view name;
  std::string_view type;
  bool is_latched = false;  // later subscribers receive the newest message, too
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
    ResultTopicInfo{"team_map", Detection3DArrayMessage::kType, true},
    ResultTopicInfo{"team_markers", MarkerArrayMessage::kType, true},
    ResultTopicInfo{"/tf_static", TfMessage::kType, true},
    ResultTopicInfo{"/detections", TagArrayMessage::kType},
};

constexpr const ResultTopicInfo& InfoOf(ResultTopic topic) {
  return kResultTopics[static_cast<std::size_t>(topic)];
}

// Topics that are advertised at once. A latched topic is advertised with its first message.
using ResultTopics = std::span<const ResultTopic>;
inline constexpr std::array kLandingTopics = {
    ResultTopic::kDetections, ResultTopic::kTargetPose, ResultTopic::kTrack,
    ResultTopic::kPrediction, ResultTopic::kMarkers,    ResultTopic::kAnnotatedImage,
    ResultTopic::kTransforms, ResultTopic::kDiagnostics};
inline constexpr std::array kFurtherCameraTopics = {
    ResultTopic::kDetections, ResultTopic::kTargetPose, ResultTopic::kMarkers,
    ResultTopic::kAnnotatedImage, ResultTopic::kTransforms};
inline constexpr std::array kFollowTopics = {ResultTopic::kTrack, ResultTopic::kAnnotatedImage,
                                             ResultTopic::kTransforms, ResultTopic::kDiagnostics};
inline constexpr std::array kHuntTopics = {ResultTopic::kDetections, ResultTopic::kMarkers,
                                           ResultTopic::kAnnotatedImage, ResultTopic::kTransforms,
                                           ResultTopic::kDiagnostics};

// Connection that carries results to others. Any thread may call it.
class ResultConnection {
 public:
  virtual ~ResultConnection() = default;

  virtual bool HasSubscribers(ResultTopic topic) const = 0;
  virtual void Publish(ResultTopic topic, const std::string& bytes) = 0;
  // Waits for a short time until all subscribers have everything, as far as that is known.
  virtual void Flush() {}
};

}  // namespace kestrel
