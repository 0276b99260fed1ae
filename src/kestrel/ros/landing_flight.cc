// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/ros/landing_flight.h"

#include <utility>
#include <variant>

#include "kestrel/onboard/thread_setup.h"

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

LandingResultsOptions ResultsOf(const NodeOptions& options, const LandingFlight::Frames& frames) {
  return {.format = WireFormat::kRos1,
          .camera_frame = frames.camera,
          .world_frame = frames.world,
          .pattern_frame = options.pattern_frame,
          .target_frame = options.target_frame,
          .publish_tf = options.publish_tf,
          .horizon = DurationFromSeconds(options.prediction_s),
          .step = DurationFromSeconds(options.prediction_step_s),
          .pattern = options.kestrel.landing.detector.pattern,
          .noise = options.kestrel.landing.tracker.Noise()};
}

}  // namespace

LandingFlight::LandingFlight(const CameraCalibration& calibration, const NodeOptions& options,
                             const Frames& frames, NodeConnection* connection)
    : options_(options),
      connection_(connection),
      pipeline_(calibration, options.kestrel.landing),
      events_(EventsOf(options), LeadOf(calibration)),
      results_(ResultsOf(options, frames), connection),
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
  results_.PublishDetection(observation);
  CountLatency(observation);
  results_.PublishTrack(observation);
  results_.PublishImage(frame.image, pipeline_.detector().camera(), observation);
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

}  // namespace kestrel
