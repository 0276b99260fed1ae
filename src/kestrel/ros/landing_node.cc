// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/ros/landing_node.h"

#include <utility>

#include <fmt/format.h>

#include "kestrel/bags/bag_topics.h"
#include "kestrel/bags/camera_info.h"
#include "kestrel/bags/frame_tree.h"
#include "kestrel/bags/image_message.h"
#include "kestrel/bags/pose_message.h"
#include "kestrel/base/error.h"
#include "kestrel/camera/calibration_reader.h"

namespace kestrel {
namespace {

constexpr std::size_t kKeptPoses = 200;  // fewer than LiveEvents takes at once
constexpr Duration kJumpBack = std::chrono::seconds(1);
constexpr Duration kWarnAgainAfter = std::chrono::seconds(5);

std::optional<CameraCalibration> ReadCalibrationFile(const NodeOptions& options) {
  if (options.camera.empty()) return std::nullopt;
  return ReadCalibration(options.camera);
}

KeyValueMessage Value(const char* key, std::uint64_t value) { return {key, fmt::to_string(value)}; }

KeyValueMessage Latency(const char* key, const LatencySummary& latency) {
  return {key, fmt::format("median {:.2f} ms, p99 {:.2f}, max {:.2f}", 1e3 * latency.median_s,
                           1e3 * latency.p99_s, 1e3 * latency.max_s)};
}

}  // namespace

LandingNode::LandingNode(const NodeOptions& options, NodeConnection* connection)
    : options_(options),
      connection_(connection),
      file_calibration_(ReadCalibrationFile(options)),
      diagnosed_(Now()) {}

void LandingNode::Warn(const std::string& text) {
  const Time now = Now();
  if (text == last_warning_ && now - last_warning_time_ < kWarnAgainAfter) return;
  last_warning_ = text;
  last_warning_time_ = now;
  connection_->Warn(text);
}

template <class Action>
void LandingNode::WarnOfErrors(const Action& action) {
  try {
    action();
  } catch (const InputError& error) {
    Warn(error.what());
  }
}

void LandingNode::TakeCameraInfo(std::string_view bytes, const std::string& topic) {
  WarnOfErrors([&] {
    camera_info_ = ParseMessage<CameraInfoMessage>(bytes, WireFormat::kRos1, topic);
    camera_info_topic_ = topic;
  });
}

void LandingNode::TakeImage(std::string_view bytes, const std::string& topic) {
  TakeAnyImage<ImageMessage>(bytes, topic);
}

void LandingNode::TakeCompressedImage(std::string_view bytes, const std::string& topic) {
  TakeAnyImage<CompressedImageMessage>(bytes, topic);
}

template <class Message>
void LandingNode::TakeAnyImage(std::string_view bytes, const std::string& topic) {
  if (is_stopped_) return;
  const Time arrival = Now();
  ++received_;
  ++refused_;  // until it is taken
  WarnOfErrors([&] {
    const auto message = ParseMessage<Message>(bytes, WireFormat::kRos1, topic);
    if (!CheckOrder(message.header, topic) || !StartFlight(message.header, topic)) return;
    const cv::Mat image = DecodeImage(message, PixelFormat::kGray, topic);
    CheckImageSize(flight_->intrinsics(), image.cols, image.rows, topic);
    --refused_;
    flight_->Push({topic, message.header.stamp, image}, arrival);
  });
}

// Counts the images that never came, and begins anew where the clock went back: a bag that is
// played again.
bool LandingNode::CheckOrder(const HeaderMessage& header, const std::string& topic) {
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
  newest_ = header.stamp;
  if (sequence_ && header.sequence > *sequence_) missed_ += header.sequence - *sequence_ - 1;
  sequence_ = header.sequence;
  return true;
}

bool LandingNode::StartFlight(const HeaderMessage& header, const std::string& topic) {
  if (flight_) return true;
  const std::string camera_frame = FrameName(header.frame_id);
  const auto calibration = CalibrationFor(camera_frame, topic);
  if (!calibration) return false;
  LandingFlight::Frames frames{camera_frame, std::nullopt};
  if (options_.poses != "none") {
    if (poses_.empty()) {
      Warn(fmt::format("no poses yet by {}; poses:=none goes without", options_.poses));
      return false;
    }
    frames.world = world_;
  }
  flight_ = std::make_unique<LandingFlight>(*calibration, options_, frames, connection_);
  for (const PoseSample& pose : poses_) flight_->Push(pose);
  return true;
}

std::optional<CameraCalibration> LandingNode::CalibrationFor(const std::string& camera_frame,
                                                             const std::string& topic) {
  if (!file_calibration_ && !camera_info_) {
    Warn("no camera_info yet; _camera:=FILE tells the calibration instead");
    return std::nullopt;
  }
  CameraCalibration calibration =
      file_calibration_ ? *file_calibration_
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

void LandingNode::TakePose(std::string_view type, std::string_view bytes,
                           const std::string& topic) {
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

void LandingNode::TakeTransforms(std::string_view bytes, bool is_static, const std::string& topic) {
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

void LandingNode::AddPose(const PoseSample& pose, const std::string& world) {
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

void LandingNode::Stop() {
  is_stopped_ = true;
  Forget();
}

void LandingNode::Forget() {
  flight_.reset();
  newest_.reset();
  sequence_.reset();
}

void LandingNode::Reset(const NodeOptions& options) {
  if (options.poses != options_.poses || options.image_transport != options_.image_transport) {
    throw InputError("poses and image_transport cannot change while the node runs: start it anew");
  }
  auto file_calibration = ReadCalibrationFile(options);
  Forget();
  options_ = options;
  file_calibration_ = std::move(file_calibration);
  received_ = missed_ = refused_ = diagnosed_images_ = 0;
}

void LandingNode::PublishDiagnostics() {
  const Time now = Now();
  const double rate_hz =
      static_cast<double>(received_ - diagnosed_images_) / ToSeconds(now - diagnosed_);
  diagnosed_ = now;
  diagnosed_images_ = received_;
  const LandingFlight::Counters counters =
      flight_ ? flight_->counters() : LandingFlight::Counters();

  DiagnosticStatusMessage status;
  status.name = "kestrel: landing pattern";
  status.level =
      is_stopped_ || rate_hz > 0 ? DiagnosticStatusMessage::kOk : DiagnosticStatusMessage::kWarn;
  status.message = is_stopped_ ? "stopped" : rate_hz > 0 ? "running" : "no images";
  if (!is_stopped_ && rate_hz > 0 && !flight_) {
    status.level = DiagnosticStatusMessage::kWarn;
    status.message = "waiting: " + last_warning_;
  }
  status.values = {{"image rate", fmt::format("{:.1f} Hz", rate_hz)},
                   Value("images received", received_),
                   Value("images processed", counters.events.frames),
                   Value("images with the pattern", counters.detections),
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
