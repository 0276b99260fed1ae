// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/bags/recording_sink.h"

#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <opencv2/core.hpp>

#include "kestrel/core/base/error.h"
#include "kestrel/core/codec/png_codec.h"
#include "kestrel/io/bags/bag_writer.h"
#include "kestrel/io/recording/euroc/euroc_writer.h"
#include "kestrel/io/recording/euroc/recording_place.h"
#include "kestrel/io/ros_messages/camera_info.h"
#include "kestrel/io/ros_messages/frame_tree.h"
#include "kestrel/io/ros_messages/messages.h"
#include "kestrel/io/ros_messages/serialization.h"

namespace kestrel {
namespace {

namespace fs = std::filesystem;

constexpr const char* kWorldFrame = "map";
constexpr const char* kBodyFrame = "base_link";
constexpr const char* kCameraFrame = "camera_optical_frame";

// Returns the image, with one channel if its three channels are equal.
cv::Mat Smallest(const cv::Mat& bgr) {
  if (bgr.channels() == 1) return bgr;
  cv::Mat channels[3];
  cv::split(bgr, channels);
  const bool is_gray = cv::norm(channels[0], channels[1], cv::NORM_INF) == 0 &&
                       cv::norm(channels[0], channels[2], cv::NORM_INF) == 0;
  return is_gray ? channels[0] : bgr;
}

Vector3Message Vector3Of(const Eigen::Vector3d& vector) {
  return {vector.x(), vector.y(), vector.z()};
}

class BagSink : public RecordingSink {
 public:
  BagSink(std::unique_ptr<BagWriter> bag, const RecordingHead& head)
      : bag_(std::move(bag)), head_(head) {
    image_ = bag_->AddTopic("/camera/image_raw", ImageMessage::kType);
    if (head_.calibration) {
      camera_info_ = bag_->AddTopic("/camera/camera_info", CameraInfoMessage::kType);
      if (head_.calibration->body_from_camera && !head_.calibration->gimbal) {
        mount_ = bag_->AddTopic("/tf_static", TfMessage::kType, /*is_latched=*/true);
      }
    }
    if (head_.has_poses) {
      pose_ = head_.has_motion ? bag_->AddTopic("/odom", OdometryMessage::kType)
                               : bag_->AddTopic("/pose", PoseStampedMessage::kType);
    }
  }

  void AddPose(const PoseSample& pose) override {
    WriteMount(pose.time);
    if (head_.has_motion) {
      Write(*pose_, pose.time, OdometryOf(pose));
    } else {
      const PoseStampedMessage message{HeaderOf(pose.time, kWorldFrame, &pose_count_),
                                       PoseMessageOf(pose.world_from_body)};
      Write(*pose_, pose.time, message);
    }
  }

  void AddFrame(const Frame& frame) override {
    WriteMount(frame.time);
    cv::Mat image = Smallest(frame.image);
    if (!image.isContinuous()) image = image.clone();
    ImageMessage message;
    message.header = HeaderOf(frame.time, kCameraFrame, &image_count_);
    message.height = static_cast<std::uint32_t>(image.rows);
    message.width = static_cast<std::uint32_t>(image.cols);
    message.encoding = image.channels() == 1 ? "mono8" : "bgr8";
    message.step = static_cast<std::uint32_t>(image.step[0]);
    message.data = {reinterpret_cast<const char*>(image.data), image.total() * image.elemSize()};
    Write(image_, frame.time, message);
    if (!camera_info_) return;
    CameraInfoMessage info = CameraInfoOf(head_.calibration->intrinsics);
    info.header = message.header;
    Write(*camera_info_, frame.time, info);
  }

  void Close() override { bag_->Close(); }

 private:
  static HeaderMessage HeaderOf(Time time, const char* frame, std::uint32_t* count) {
    return {(*count)++, time, frame};
  }

  OdometryMessage OdometryOf(const PoseSample& pose) {
    OdometryMessage message;
    message.header = HeaderOf(pose.time, kWorldFrame, &pose_count_);
    message.child_frame_id = kBodyFrame;
    message.pose.pose = PoseMessageOf(pose.world_from_body);
    if (pose.motion) {
      const Eigen::Quaterniond body_from_world = pose.world_from_body.rotation.conjugate();
      message.twist.twist = {Vector3Of(body_from_world * pose.motion->velocity_in_world),
                             Vector3Of(pose.motion->rate_in_body)};
    }
    return message;
  }

  // Called before everything else; writes the mount only once.
  void WriteMount(Time time) {
    if (!mount_ || std::exchange(is_mount_written_, true)) return;
    TfMessage message;
    std::uint32_t count = 0;
    message.transforms.push_back({HeaderOf(time, kBodyFrame, &count), kCameraFrame,
                                  TransformMessageOf(*head_.calibration->body_from_camera)});
    Write(*mount_, time, message);
  }

  template <class Message>
  void Write(std::size_t topic, Time time, const Message& message) {
    bag_->Write(topic, time, SerializeMessage(message, bag_->format()));
  }

  std::unique_ptr<BagWriter> bag_;
  RecordingHead head_;
  std::size_t image_ = 0;
  std::optional<std::size_t> camera_info_;
  std::optional<std::size_t> mount_;
  std::optional<std::size_t> pose_;
  bool is_mount_written_ = false;
  std::uint32_t image_count_ = 0;
  std::uint32_t pose_count_ = 0;
};

// Makes the empty folder of a recording that is not complete.
fs::path BeginRecording(const std::string& path, bool replace) {
  RequireFreeForRecording(path, replace);
  fs::path part = PartOfRecording(path);
  std::error_code error;
  fs::remove_all(part, error);
  fs::create_directories(part, error);
  if (error) throw InputError(part.string() + ": cannot be made: " + error.message());
  return part;
}

std::vector<EurocTable> TablesOf(const RecordingHead& head) {
  std::vector<EurocTable> tables{EurocTable::kImages};
  if (head.has_poses) tables.push_back(EurocTable::kPoses);
  if (head.calibration && head.calibration->gimbal) tables.push_back(EurocTable::kGimbal);
  if (head.calibration && head.calibration->zoom) tables.push_back(EurocTable::kZoom);
  return tables;
}

// An old recording is replaced as a whole, by Close; a sink that is not closed leaves nothing.
class EurocSink : public RecordingSink {
 public:
  EurocSink(const std::string& path, const RecordingHead& head, bool replace)
      : place_(PlaceOfRecording(path)),
        part_(BeginRecording(path, replace)),
        writer_(part_, TablesOf(head)),
        gimbal_(head.calibration ? head.calibration->gimbal : std::nullopt),
        zoom_(head.calibration ? head.calibration->zoom : std::nullopt) {
    if (head.calibration) writer_.WriteCamera(*head.calibration, head.rate_hz);
  }
  ~EurocSink() override {
    std::error_code ignored;
    fs::remove_all(part_, ignored);
  }
  EurocSink(const EurocSink&) = delete;
  EurocSink& operator=(const EurocSink&) = delete;

  void AddPose(const PoseSample& pose) override {
    writer_.AddPose(pose);
    writer_.CommitMany();
    if (!first_pose_) first_pose_ = pose.time;
    last_pose_ = pose.time;
    ++pose_count_;
  }

  void AddGimbal(const std::vector<GimbalSample>& reports) override {
    if (!gimbal_ || reports.empty()) return;
    const double span_s = ToSeconds(reports.back().time - reports.front().time);
    writer_.WriteGimbalSensor(*gimbal_, reports.front().yaw_frame,
                              span_s > 0 ? static_cast<double>(reports.size() - 1) / span_s : 0);
    for (const GimbalSample& report : reports) writer_.AddGimbal(report);
    writer_.CommitMany();
  }

  void AddZoom(const std::vector<ZoomSample>& reports) override {
    if (!zoom_) return;
    const double span_s =
        reports.empty() ? 0 : ToSeconds(reports.back().time - reports.front().time);
    writer_.WriteZoomSensor(*zoom_,
                            span_s > 0 ? static_cast<double>(reports.size() - 1) / span_s : 0);
    for (const ZoomSample& report : reports) writer_.AddZoom(report);
    writer_.CommitMany();
  }

  void AddFrame(const Frame& frame) override {
    writer_.WriteImage(frame.time, "png", EncodePng(Smallest(frame.image)));
    writer_.ListImage(frame.time, "png");
    writer_.CommitMany();
  }

  void Close() override {
    writer_.CommitOrThrow();
    const double span_s = first_pose_ ? ToSeconds(last_pose_ - *first_pose_) : 0;
    if (span_s > 0) writer_.WritePoseSensor(static_cast<double>(pose_count_ - 1) / span_s);
    PublishRecording(part_, place_);
  }

 private:
  fs::path place_;
  fs::path part_;
  EurocWriter writer_;
  std::optional<GimbalMount> gimbal_;
  std::optional<ZoomLens> zoom_;
  std::optional<Time> first_pose_;
  Time last_pose_;
  std::size_t pose_count_ = 0;
};

}  // namespace

std::unique_ptr<RecordingSink> NewRecording(const std::string& path, const RecordingHead& head,
                                            Compression compression, bool replace) {
  if (IsBagName(path)) {
    return std::make_unique<BagSink>(NewBag(path, compression, replace), head);
  }
  if (compression != Compression::kNone) {
    throw InputError(path + ": is to be a folder, expected no --compression with it");
  }
  return std::make_unique<EurocSink>(path, head, replace);
}

}  // namespace kestrel
