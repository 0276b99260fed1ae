// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/ros_node/vision_node.h"

#include <utility>
#include <vector>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/options.h"
#include "kestrel/io/bags/bag_topics.h"
#include "kestrel/io/bags/camera_info.h"
#include "kestrel/io/bags/frame_tree.h"
#include "kestrel/io/bags/image_message.h"
#include "kestrel/io/bags/pose_message.h"

namespace kestrel {
namespace {

constexpr std::size_t kKeptPoses = 200;  // fewer than LiveEvents can take at once
constexpr Duration kJumpBack = std::chrono::seconds(1);
constexpr Duration kWarnAgainAfter = std::chrono::seconds(5);

// The hunt cannot see colours in a gray image.
void RequireColors(const ImageMessage& message, const std::string& topic) {
  if (message.encoding != "mono8" && message.encoding != "8UC1") return;
  throw InputError(fmt::format("{}: the images are gray ({}), task:=hunt needs colours", topic,
                               message.encoding));
}

std::string Joined(const char* what, const std::vector<std::string>& names) {
  return names.empty() ? "" : fmt::format("{}: {}", what, fmt::join(names, ", "));
}

KeyValueMessage Value(const char* key, std::uint64_t value) { return {key, fmt::to_string(value)}; }

KeyValueMessage Latency(const char* key, const LatencySummary& latency) {
  return {key, fmt::format("median {:.2f} ms, p99 {:.2f}, max {:.2f}", 1e3 * latency.median_s,
                           1e3 * latency.p99_s, 1e3 * latency.max_s)};
}

}  // namespace

VisionNode::VisionNode(const NodeOptions& options, NodeConnection* connection)
    : options_(options),
      connection_(connection),
      files_(ReadNodeFiles(options)),
      diagnosed_(Now()) {}

void VisionNode::Warn(const std::string& text) {
  const Time now = Now();
  if (text == last_warning_ && now - last_warning_time_ < kWarnAgainAfter) return;
  last_warning_ = text;
  last_warning_time_ = now;
  connection_->Warn(text);
}

template <class Action>
void VisionNode::WarnOfErrors(const Action& action) {
  try {
    action();
  } catch (const InputError& error) {
    Warn(error.what());
  }
}

void VisionNode::TakeCameraInfo(std::string_view bytes, const std::string& topic) {
  WarnOfErrors([&] {
    camera_info_ = ParseMessage<CameraInfoMessage>(bytes, WireFormat::kRos1, topic);
    camera_info_topic_ = topic;
  });
}

void VisionNode::TakeImage(std::string_view bytes, const std::string& topic) {
  TakeAnyImage<ImageMessage>(bytes, topic);
}

void VisionNode::TakeCompressedImage(std::string_view bytes, const std::string& topic) {
  TakeAnyImage<CompressedImageMessage>(bytes, topic);
}

template <class Message>
void VisionNode::TakeAnyImage(std::string_view bytes, const std::string& topic) {
  if (is_stopped_) return;
  const Time arrival = Now();
  ++received_;
  ++refused_;  // until it is accepted
  WarnOfErrors([&] {
    const auto message = ParseMessage<Message>(bytes, WireFormat::kRos1, topic);
    if (!CheckOrder(message.header, topic)) return;
    if constexpr (std::is_same_v<Message, ImageMessage>) {
      if (options_.is_hunt()) RequireColors(message, topic);
    }
    const cv::Mat image =
        DecodeImage(message, options_.is_hunt() ? PixelFormat::kBgr : PixelFormat::kGray, topic);
    if (!StartFlight(message.header, topic)) return;
    CheckImageSize(flight_->intrinsics(), image.cols, image.rows, topic);
    --refused_;
    newest_ = message.header.stamp;
    flight_->Push({topic, message.header.stamp, image}, arrival);
  });
}

// Counts the images that never came. Starts anew when the clock jumps back, as when a bag is played
// again.
bool VisionNode::CheckOrder(const HeaderMessage& header, const std::string& topic) {
  if (ToNanoseconds(header.stamp) <= 0) {
    throw InputError(topic + ": the images have no stamps (zero), expected when they were taken");
  }
  if (header.frame_id.empty()) {
    throw InputError(topic + ": the images have no frame_id, expected the camera's optical frame");
  }
  if (newest_ && header.stamp < *newest_ - kJumpBack) {
    Warn("the images' stamps jump back: starting anew");
    Forget();
    poses_.clear();
  }
  if (newest_ && header.stamp <= *newest_) return false;
  if (sequence_ && header.sequence > *sequence_) missed_ += header.sequence - *sequence_ - 1;
  sequence_ = header.sequence;
  return true;
}

bool VisionNode::StartFlight(const HeaderMessage& header, const std::string& topic) {
  if (flight_) return true;
  const std::string camera_frame = FrameName(header.frame_id);
  const auto calibration = CalibrationFor(camera_frame, topic);
  if (!calibration) return false;
  NodeFrames frames{camera_frame, std::nullopt};
  if (options_.poses != "none") {
    if (poses_.empty()) {
      Warn(fmt::format("no poses yet by {}; poses:=none goes without", options_.poses));
      return false;
    }
    frames.world = world_;
  }
  flight_ =
      std::make_unique<NodeFlight>(*calibration, files_.objects, options_, frames, connection_);
  for (const PoseSample& pose : poses_) flight_->Push(pose);
  return true;
}

std::optional<CameraCalibration> VisionNode::CalibrationFor(const std::string& camera_frame,
                                                            const std::string& topic) {
  if (!files_.calibration && !camera_info_) {
    Warn("no camera_info yet; _camera:=FILE tells the calibration instead");
    return std::nullopt;
  }
  CameraCalibration calibration =
      files_.calibration ? *files_.calibration
                         : CalibrationOf(*camera_info_, IsRectified(topic), camera_info_topic_);
  if (options_.poses == "none" || calibration.body_from_camera) return calibration;
  const std::string& body = body_.empty() ? options_.body_frame : body_;
  calibration.body_from_camera = transforms_.Fixed(body, camera_frame);
  if (!calibration.body_from_camera) {
    calibration.body_from_camera = transforms_.Fixed(options_.body_frame, camera_frame);
  }
  if (calibration.body_from_camera) return calibration;
  Warn(
      fmt::format("no mount: expected a static transform from {} to {}, or a calibration file "
                  "with T_BS (_camera:=FILE); poses:=none goes without",
                  body, camera_frame));
  return std::nullopt;
}

void VisionNode::TakePose(std::string_view type, std::string_view bytes, const std::string& topic) {
  WarnOfErrors([&] {
    if (!IsPoseType(type)) {
      throw InputError(fmt::format(
          "{}: is of type {}, expected PoseStamped, PoseWithCovarianceStamped, TransformStamped or "
          "Odometry",
          topic, type));
    }
    const StampedPose pose = ParsePose(type, bytes, WireFormat::kRos1, topic);
    const auto world_from_body = TransformOf(pose.pose);
    if (!world_from_body || ToNanoseconds(pose.stamp) <= 0) {
      throw InputError(topic +
                       ": a pose is left out that has no stamp, is not finite, or is turned "
                       "by no unit quaternion");
    }
    body_ = FrameName(pose.body);
    AddPose({pose.stamp, *world_from_body,
             pose.twist ? MotionOf(*pose.twist, *world_from_body) : std::nullopt},
            FrameName(pose.world));
  });
}

void VisionNode::TakeTransforms(std::string_view bytes, bool is_static, const std::string& topic) {
  WarnOfErrors([&] {
    const auto message = ParseMessage<TfMessage>(bytes, WireFormat::kRos1, topic);
    for (const TransformStampedMessage& transform : message.transforms) {
      transforms_.Add(transform, is_static);
      if (options_.poses != "tf" || is_static) continue;
      const auto pose = transforms_.PoseBy(transform, options_.body_frame, options_.world_frame);
      if (pose) AddPose(pose->sample, pose->world);
    }
  });
}

void VisionNode::AddPose(const PoseSample& pose, const std::string& world) {
  world_ = world;
  if (!poses_.empty() && pose.time < poses_.back().time - kJumpBack) {
    Warn("the poses' stamps jump back: starting anew");
    Forget();
    poses_.clear();
  }
  if (!poses_.empty() && pose.time <= poses_.back().time) return;
  if (poses_.size() == kKeptPoses) poses_.pop_front();
  poses_.push_back(pose);
  if (flight_) flight_->Push(pose);
}

// Images that are left out meanwhile do not count as missed.
void VisionNode::Stop() {
  is_stopped_ = true;
  sequence_.reset();
}

void VisionNode::Forget() {
  flight_.reset();
  newest_.reset();
  sequence_.reset();
}

// Throws InputError for options that would change the topics.
void VisionNode::RequireChangeable(const NodeOptions& options) const {
  if (options.task == options_.task && options.poses == options_.poses &&
      options.image_transport == options_.image_transport) {
    return;
  }
  throw InputError(
      "task, poses and image_transport cannot change while the node runs: start it anew");
}

std::string VisionNode::Update(const NodeOptions& options) {
  RequireChangeable(options);
  NodeOptions updated = options_;
  const OptionUpdate update = UpdateOptions(options, &updated);
  RequireValid(updated);
  if (flight_ && !update.taken.empty()) {
    flight_->WithTask([&](NodeTask* task) { task->Update(updated); });
  }
  options_ = updated;
  if (update.taken.empty() && update.left.empty()) return "nothing has changed";
  const bool are_both = !update.taken.empty() && !update.left.empty();
  return Joined("taken", update.taken) + (are_both ? "; " : "") +
         Joined("not taken without a reset", update.left);
}

std::string VisionNode::SaveMap() {
  if (!flight_) throw InputError("there is no map: no image was processed yet");
  return flight_->WithTask([](NodeTask* task) { return task->SaveMap(); });
}

void VisionNode::Reset(const NodeOptions& options) {
  RequireChangeable(options);
  NodeFiles files = ReadNodeFiles(options);
  Forget();
  const bool is_other_world =
      options.world_frame != options_.world_frame || options.body_frame != options_.body_frame;
  if (is_other_world) poses_.clear();
  options_ = options;
  files_ = std::move(files);
  received_ = missed_ = refused_ = diagnosed_images_ = 0;
}

void VisionNode::Tick() {
  if (flight_) flight_->WithTask([](NodeTask* task) { task->PublishMap(); });
  PublishDiagnostics();
}

void VisionNode::PublishDiagnostics() {
  const Time now = Now();
  const double rate_hz =
      static_cast<double>(received_ - diagnosed_images_) / ToSeconds(now - diagnosed_);
  diagnosed_ = now;
  diagnosed_images_ = received_;
  const NodeFlight::Counters counters = flight_ ? flight_->counters() : NodeFlight::Counters();

  DiagnosticStatusMessage status;
  status.name = options_.is_hunt() ? "kestrel: coloured objects" : "kestrel: landing pattern";
  status.level =
      is_stopped_ || rate_hz > 0 ? DiagnosticStatusMessage::kOk : DiagnosticStatusMessage::kWarn;
  status.message = is_stopped_ ? "stopped" : rate_hz > 0 ? "running" : "no images";
  if (!is_stopped_ && rate_hz > 0 && !flight_) {
    status.level = DiagnosticStatusMessage::kWarn;
    status.message = "waiting: " + last_warning_;
  }
  status.values = {
      {"image rate", fmt::format("{:.1f} Hz", rate_hz)},
      Value("images received", received_),
      Value("images processed", counters.events.frames),
      Value(options_.is_hunt() ? "images with objects" : "images with the pattern", counters.found),
      Value("images dropped for newer ones", counters.events.dropped_frames),
      Value("images missed before the node", missed_),
      Value("images left out", refused_),
      Value("images without the pose after them", counters.events.unposed_frames),
      Latency("image to detection", counters.latency),
      Latency("of that beyond Detect", counters.beyond_detect),
      Latency("Detect", counters.detect)};
  DiagnosticArrayMessage message;
  message.header.stamp = connection_->StampNow();
  message.status.push_back(std::move(status));
  connection_->Publish(ResultTopic::kDiagnostics, SerializeMessage(message, WireFormat::kRos1));
}

}  // namespace kestrel
