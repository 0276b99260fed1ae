// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/ros/ros_node.h"

#include <algorithm>
#include <chrono>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/options.h"
#include "kestrel/io/bags/serialization.h"

namespace kestrel {
namespace {

constexpr Duration kWarnAgainAfter = std::chrono::seconds(5);

TopicSourceOptions SourceOf(const NodeOptions& options) {
  TopicSourceOptions source;
  source.format = options.is_hunt() ? PixelFormat::kBgr : PixelFormat::kGray;
  source.needs_colors = options.is_hunt();
  source.poses_by_tf = options.poses == "tf";
  source.body_frame = options.ros.body_frame;
  source.world_frame = options.world_frame;
  source.keeps_stamps = true;
  return source;
}

std::string Joined(const char* what, const std::vector<std::string>& names) {
  return names.empty() ? "" : fmt::format("{}: {}", what, fmt::join(names, ", "));
}

}  // namespace

RosNode::RosNode(const NodeOptions& options, NodeConnection* connection)
    : options_(options),
      connection_(connection),
      files_(ReadFiles(options)),
      source_(SourceOf(options)) {}

NodeFiles RosNode::ReadFiles(const NodeOptions& options) const {
  const auto warn = [this](const std::string& text) { connection_->Warn(text); };
  if (!options.is_hunt()) std::ranges::for_each(options.landing.target.Warnings(), warn);
  return ReadNodeFiles(options, warn);
}

void RosNode::Warn(const std::string& text) {
  const Time now = Now();
  if (text == last_warning_ && now - last_warning_time_ < kWarnAgainAfter) return;
  last_warning_ = text;
  last_warning_time_ = now;
  connection_->Warn(text);
}

void RosNode::Take(const BagTopic& topic, std::string_view bytes) {
  try {
    try {
      source_.Take(topic, bytes);
    } catch (const ClockWentBack& error) {
      Warn(fmt::format("{}: starting anew", error.what()));
      Forget();
      source_.Take(topic, bytes);
    }
    if (!session_ && !is_stopped_ && source_.has_images()) BeginSession(IsImageType(topic.type));
  } catch (const InputError& error) {
    Warn(error.what());
  }
}

std::optional<CameraCalibration> RosNode::Calibration() const {
  if (!files_.calibration) return source_.Calibration();
  CameraCalibration calibration = *files_.calibration;
  if (!calibration.body_from_camera) calibration.body_from_camera = source_.Mount();
  return calibration;
}

// Returns what a session still needs, in words; empty when it can begin.
std::string RosNode::Missing(const std::optional<CameraCalibration>& calibration) const {
  if (source_.camera_frame().empty()) {
    return "the images have no frame_id, expected the camera's optical frame";
  }
  if (!calibration) return "no camera_info yet; _camera:=FILE gives the calibration instead";
  if (!options_.has_poses()) return "";
  if (!calibration->body_from_camera) {
    return fmt::format(
        "no mount: expected a static transform from {} to {}, or a calibration file with T_BS "
        "(_camera:=FILE); poses:=none goes without",
        source_.body_frame(), source_.camera_frame());
  }
  if (source_.has_poses()) return "";
  return fmt::format("no poses yet by {}; poses:=none goes without", options_.poses);
}

void RosNode::BeginSession(bool says_why_not) {
  const std::optional<CameraCalibration> calibration = Calibration();
  const std::string missing = Missing(calibration);
  if (missing.empty()) {
    session_.emplace(options_, files_, *calibration, &source_, connection_);
  } else if (says_why_not) {
    Warn(missing);
  }
}

void RosNode::Forget() {
  session_.reset();
  source_.Restart(options_.ros.body_frame, options_.world_frame);
}

void RosNode::SetStopped(bool is_stopped) {
  is_stopped_ = is_stopped;
  source_.Pause(is_stopped);
}

// Throws InputError for options that would change the topics.
void RosNode::RequireChangeable(const NodeOptions& options) const {
  if (options.task == options_.task && options.poses == options_.poses &&
      options.image_transport == options_.image_transport) {
    return;
  }
  throw InputError(
      "task, poses and image_transport cannot change while the node runs: start it anew");
}

std::string RosNode::Update(const NodeOptions& options) {
  RequireChangeable(options);
  NodeOptions updated = options_;
  const OptionUpdate update = UpdateOptions(options, &updated);
  RequireValid(updated);
  if (session_ && !update.taken.empty()) session_->Change(updated);
  options_ = updated;
  if (update.taken.empty() && update.left.empty()) return "nothing has changed";
  const bool are_both = !update.taken.empty() && !update.left.empty();
  return Joined("taken", update.taken) + (are_both ? "; " : "") +
         Joined("not taken without a reset", update.left);
}

std::string RosNode::SaveMap() {
  if (!session_) throw InputError("there is no map: no image was processed yet");
  return session_->SaveMap(options_);
}

void RosNode::Reset(const NodeOptions& options) {
  RequireChangeable(options);
  files_ = ReadFiles(options);
  options_ = options;
  Forget();
}

void RosNode::Tick() {
  if (session_) session_->PublishMap();
  FlightReport report = session_ ? session_->Report() : FlightReport();
  report.capture = source_.counters();
  const double rate_hz = rate_.Next(report.capture.captured + report.capture.refused);
  if (!session_ && rate_hz > 0) report.trouble = "waiting: " + last_warning_;
  DiagnosticStatusMessage status =
      DiagnosticsOf(options_.is_hunt() ? "kestrel: coloured objects" : "kestrel: landing pattern",
                    rate_hz, report, session_ ? session_->Counts() : ResultCounts());
  if (is_stopped_) {
    status.level = DiagnosticStatusMessage::kOk;
    status.message = "stopped";
  }
  connection_->Publish(
      ResultTopic::kDiagnostics,
      SerializeMessage(ArrayOf(std::move(status), connection_->StampNow()), WireFormat::kRos1));
}

}  // namespace kestrel
