// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/ros/landing_flight.h"

#include <utility>
#include <variant>

#include "kestrel/onboard/thread_setup.h"
#include "kestrel/recording/landing_overlay.h"
#include "kestrel/ros/landing_messages.h"

namespace kestrel {
namespace {

constexpr std::size_t kWaitingArrivals = 16;  // more than frames can wait

Duration LeadOf(const CameraCalibration& calibration) {
  return calibration.clock_offset.value_or(Duration::zero());
}

// Without poses there is nothing that a frame could wait for.
LiveEventsOptions EventsOf(const NodeOptions& options) {
  LiveEventsOptions events = options.kestrel.fly.flight.events;
  if (options.poses == "none") events.pose_wait_s = 0;
  return events;
}

}  // namespace

LandingFlight::LandingFlight(const CameraCalibration& calibration, const NodeOptions& options,
                             const Frames& frames, NodeConnection* connection)
    : options_(options),
      frames_(frames),
      connection_(connection),
      pipeline_(calibration, options.kestrel.landing),
      events_(EventsOf(options), LeadOf(calibration)),
      arrivals_(kWaitingArrivals) {
  if (options.altitude_m > 0) pipeline_.SetAltitude(options.altitude_m);
  thread_ = std::thread([this] { Run(); });
}

LandingFlight::~LandingFlight() {
  events_.Close();
  thread_.join();
}

void LandingFlight::Push(Frame frame, Time arrival) {
  arrivals_.Push({frame.time, arrival});
  events_.Push(std::move(frame));
}

LandingFlight::Counters LandingFlight::counters() const {
  return {events_.counters(), detections_, latency_.Summary(), beyond_detect_.Summary(),
          detect_.Summary()};
}

void LandingFlight::Run() {
  const std::string refused = SetUpThisThread("vision", options_.kestrel.fly.flight.vision_thread);
  if (!refused.empty()) connection_->Warn(refused);
  for (;;) {
    const Event event = events_.Next();
    if (std::holds_alternative<EndOfStream>(event)) return;
    if (const auto* pose = std::get_if<PoseSample>(&event)) pipeline_.AddPose(*pose);
    if (const auto* frame = std::get_if<Frame>(&event)) Process(*frame);
  }
}

void LandingFlight::Process(const Frame& frame) {
  const LandingObservation observation = pipeline_.Process(frame.image, frame.time);
  detections_ += observation.report.detection.has_value();
  PublishDetection(observation);
  CountLatency(observation);
  PublishTrack(observation);
  PublishPictures(frame, observation);
}

void LandingFlight::PublishDetection(const LandingObservation& observation) {
  Publish(NodeTopic::kDetections, DetectionsOf(observation, frames_.camera, pattern()));
  const auto& detection = observation.report.detection;
  if (!detection) return;
  Publish(NodeTopic::kTargetPose, TargetPoseOf(*detection, observation.time, frames_.camera));
  if (!options_.publish_tf) return;
  Publish(NodeTopic::kTransforms,
          PatternTransformOf(*detection, observation.time, frames_.camera, options_.pattern_frame));
}

void LandingFlight::CountLatency(const LandingObservation& observation) {
  const Time now = Now();
  while (const auto arrival = arrivals_.TryPop()) {
    if (arrival->stamp != observation.time) continue;  // of a frame that was dropped
    latency_.Add(now - arrival->arrival);
    beyond_detect_.Add(now - arrival->arrival - observation.detect_time);
    detect_.Add(observation.detect_time);
    return;
  }
}

void LandingFlight::PublishTrack(const LandingObservation& observation) {
  if (!frames_.world || !observation.target) return;
  Publish(NodeTopic::kTrack, TrackOf(*observation.target, *frames_.world, options_.target_frame));
  if (!connection_->HasSubscribers(NodeTopic::kPrediction)) return;
  Publish(NodeTopic::kPrediction,
          PredictionOf(pipeline_.tracker(), observation.time,
                       DurationFromSeconds(options_.prediction_s),
                       DurationFromSeconds(options_.prediction_step_s), *frames_.world));
}

void LandingFlight::PublishPictures(const Frame& frame, const LandingObservation& observation) {
  if (connection_->HasSubscribers(NodeTopic::kMarkers)) {
    Publish(NodeTopic::kMarkers, MarkersOf(observation, pattern(), frames_.camera, frames_.world));
  }
  if (!connection_->HasSubscribers(NodeTopic::kAnnotatedImage)) return;
  const cv::Mat annotated =
      DrawLandingOverlay(frame.image, pipeline_.detector().camera(), pattern(), observation);
  Publish(NodeTopic::kAnnotatedImage, ImageMessageOf(annotated, observation.time, frames_.camera));
}

}  // namespace kestrel
