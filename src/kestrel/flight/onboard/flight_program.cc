// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/flight_program.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <thread>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/comms/mavlink/silence.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/base/options.h"
#include "kestrel/flight/onboard/guidance_permission.h"
#include "kestrel/flight/onboard/team_in_flight.h"
#include "kestrel/flight/session/autopilot_report.h"

namespace kestrel {
namespace {

constexpr Duration kPatience = std::chrono::milliseconds(100);  // longest wait of a thread
constexpr Duration kLinkPatience = std::chrono::milliseconds(2);
constexpr int kLinkPriority = 24;    // with a guard, whose own is 25
constexpr std::size_t kPoses = 512;  // from the link: some seconds
constexpr Duration kPoseGap = std::chrono::milliseconds(500);
constexpr Duration kLandingPeriod = std::chrono::milliseconds(20);
// So long camera and autopilot may take to begin until what is waited for is said.
constexpr Duration kQuietStart = std::chrono::milliseconds(1500);
constexpr char kNoImageYet[] = "waits for the camera: no image yet";

}  // namespace

FlightProgram::FlightProgram(const FlightOptions& options, const FlightParts& parts,
                             std::function<void(const std::string&)> report)
    : options_(Checked(options)),
      parts_(parts),
      report_(std::move(report)),
      events_(options.events, parts.vision->pose_lead(), parts.cameras),
      poses_(kPoses, kPoseGap),
      latency_({"capture to arrival", "capture to vision", "detection", "capture to message",
                "capture to set-point"}),
      pad_(parts.vision->pad()),
      tracker_(pad_ ? pad_->tracker : parts.vision->marked().value_or(TargetTrackerOptions())),
      noise_(tracker_.Noise()),
      landing_(pad_.value_or(PadInSight()).size_m / 2) {
  if (parts.connection == nullptr) return;
  if (pad_) {
    sender_.emplace(options, tracker_, parts.profile, pad_->size_m, pad_->range_m,
                    parts.guidance != nullptr, parts.autopilot, parts.connection, report_);
  }
  set_point_flight_.emplace(options, tracker_,
                            SetPointTask{.guidance = parts.guidance,
                                         .without_position = parts.without_position,
                                         .sends_pad_position = parts.sends_pad_position,
                                         .box = parts.box,
                                         .place = parts.place,
                                         .is_in_its_frame = !parts.source_has_poses},
                            parts.autopilot, parts.connection, report_);
  if (parts.pointed != nullptr) {
    gimbal_.emplace(options, *parts.pointed, pad_, tracker_, parts.autopilot, parts.connection,
                    report_);
  }
  if (parts.tracking != nullptr) {
    const CameraStream stream =
        parts.stream != nullptr
            ? *parts.stream
            : CameraStream{.uri = {}, .delay = [this] { return arrival_.load(); }};
    camera_.emplace(options, *parts.tracking, stream, parts.autopilot, parts.connection, report_);
  }
  if (parts.guard != nullptr) {
    guard_.emplace(parts.guard, parts.autopilot, parts.connection, options.guard, report_);
  }
}

FlightEnd FlightProgram::Run(const std::function<bool()>& is_stopped) {
  std::vector<std::thread> threads;
  threads.emplace_back([this] { See(); });
  threads.emplace_back([this] { Capture(); });
  if (parts_.connection != nullptr) threads.emplace_back([this] { Communicate(); });
  std::exception_ptr error;
  try {
    Watch(is_stopped);
  } catch (...) {
    error = std::current_exception();
    End({FlightOutcome::kNotLanded, {}, "the program failed"});
  }
  events_.Close();
  for (std::thread& thread : threads) thread.join();
  ReportEnd();
  if (error) std::rethrow_exception(error);
  return end_;
}

void FlightProgram::ReportEnd() {
  report_(InWords(end_));
  if (parts_.sink != nullptr) parts_.sink->Take(Report());
}

void FlightProgram::Watch(const std::function<bool()>& is_stopped) {
  service_manager_.Notify("READY=1");
  while (!is_over_) {
    NotifyServiceManager(Now());
    if (is_stopped()) End({FlightOutcome::kStopped});
    if (parts_.sink != nullptr) parts_.sink->Take(Report());
    std::this_thread::sleep_for(kPatience);
  }
  // To write what waits may take a while.
  service_manager_.Notify("WATCHDOG_USEC=60000000");
}

// A thread that hangs keeps the sign of life from systemd's watchdog, which then kills the program;
// the guard sees to the UAV.
void FlightProgram::NotifyServiceManager(Time now) {
  constexpr Duration kLinkLimit = std::chrono::seconds(1);
  constexpr Duration kLimit = std::chrono::seconds(5);
  if (link_life_.IsAlive(now, kLinkLimit) && vision_life_.IsAlive(now, kLimit) &&
      capture_life_.IsAlive(now, kLimit)) {
    service_manager_.Notify("WATCHDOG=1");
  }
}

// Only the first reason counts.
void FlightProgram::End(const FlightEnd& end) {
  std::call_once(ended_, [&] {
    end_ = end;
    is_over_ = true;
  });
}

// A simulation knows the offset that a flight can only estimate.
void FlightProgram::EndByLanding(FlightEnd end) {
  const auto true_m = parts_.true_offset_m ? parts_.true_offset_m() : std::nullopt;
  if (end.offset_m && true_m) {
    end.estimated_m = end.offset_m;
    end.offset_m = true_m;
    end.has_true_offset = true;
  }
  End(end);
}

// --- The capture thread ---

void FlightProgram::Capture() {
  SetUpThisThread("capture", {});
  std::string trouble;
  std::vector<std::string> delays(parts_.late.size());
  Time last = Now();
  while (!is_over_) {
    capture_life_.Give(Now());
    std::optional<Event> event = parts_.source->Next(kPatience);
    if (event && std::holds_alternative<EndOfStream>(*event)) {
      // The last frame may still wait for its pose.
      std::this_thread::sleep_for(DurationFromSeconds(options_.events.pose_wait_s) + kPatience);
      return End({FlightOutcome::kSourceEnded});
    }
    if (event) {
      last = Now();
      Take(std::move(*event));
    }
    if (const std::string now = SourceTrouble(); now != trouble) {
      const char* const end = trouble == kNoImageYet ? "images come" : "the camera is back";
      report_(now.empty() ? end : now);
      trouble = now;
    }
    for (std::size_t i = 0; i < delays.size(); ++i) {
      const LateCamera& late = parts_.late[i];
      if (std::string now = late.video->InWords(); now != delays[i]) {
        report_(late.name.empty() ? now : fmt::format("{}: {}", late.name, now));
        delays[i] = std::move(now);
      }
    }
    if (ToSeconds(Now() - last) < options_.source_timeout_s) continue;
    return End({FlightOutcome::kNotLanded,
                {},
                fmt::format("no image for {:g} s", options_.source_timeout_s)});
  }
}

std::string FlightProgram::SourceTrouble() const {
  const bool waits = parts_.source->counters().captured == 0 && Now() - began_ > kQuietStart;
  const std::string error = parts_.source->error();
  return error.empty() && waits ? kNoImageYet : error;
}

void FlightProgram::Take(Event event) {
  if (const auto* pose = std::get_if<PoseSample>(&event)) {
    source_pose_.Set(*pose);
    return TakePose(*pose);
  }
  if (const auto* report = std::get_if<GimbalSample>(&event)) return TakeGimbal(*report);
  if (const auto* report = std::get_if<ZoomSample>(&event)) return TakeZoom(*report);
  auto& frame = std::get<Frame>(event);
  arrival_ = Now() - frame.time;
  latency_.step(kArrival).Add(arrival_);
  if (const auto recorder = Recorder()) {
    const bool has_truth = parts_.truth && frame.camera == 0;
    recorder->AddFrame(frame, has_truth ? parts_.truth(frame) : std::nullopt);
  }
  events_.Push(std::move(frame));
}

void FlightProgram::TakePose(const PoseSample& pose) {
  events_.Push(pose);
  if (const auto recorder = Recorder()) recorder->AddPose(pose);
}

void FlightProgram::TakeGimbal(const GimbalSample& report) {
  events_.Push(report);
  if (const auto recorder = Recorder()) recorder->AddGimbal(report);
}

void FlightProgram::TakeZoom(const ZoomSample& report) {
  events_.Push(report);
  if (const auto recorder = Recorder()) recorder->AddZoom(report);
}

// --- The vision thread ---

void FlightProgram::See() {
  if (const std::string problem = SetUpThisThread("vision", options_.vision_thread);
      !problem.empty()) {
    report_(problem);
  }
  for (;;) {
    vision_life_.Rest();
    const Event event = events_.Next();
    vision_life_.Give(Now());
    if (std::holds_alternative<EndOfStream>(event)) return;
    const std::lock_guard lock(vision_mutex_);
    if (const auto* pose = std::get_if<PoseSample>(&event)) {
      parts_.vision->AddPose(*pose);
      continue;
    }
    if (const auto* report = std::get_if<GimbalSample>(&event)) {
      parts_.vision->AddGimbal(*report);
      continue;
    }
    if (const auto* report = std::get_if<ZoomSample>(&event)) {
      parts_.vision->AddZoom(*report);
      continue;
    }
    const auto& frame = std::get<Frame>(event);
    // The vision itself judges which one of several cameras it can use.
    if (parts_.cameras == 1 && !parts_.sees_repeated && IsFrozen(frame)) continue;
    latency_.step(kVision).Add(Now() - frame.time);
    if (camera_) camera_->ApplyMarks(Now(), parts_.vision);
    AssignObject();
    parts_.vision->Leave(ended_mark_);
    parts_.vision->SetGroundZero(ground_zero_m_);
    const TrackSnapshot snapshot = See(frame);
    latency_.step(kDetection).Add(snapshot.detect_time);
    frames_ = snapshot.frames;
    detections_ = snapshot.detections;
    if (snapshot.other_tag) {
      const std::lock_guard other_lock(other_tag_mutex_);
      other_tag_ = snapshot.other_tag;
    }
    track_.Set(snapshot);
    if (parts_.connection != nullptr) parts_.connection->Wake();
    WarnOnce();
    ReportCameras();
  }
}

void FlightProgram::AssignObject() {
  std::optional<AssignedObject> assigned;
  {
    const std::lock_guard lock(team_mutex_);
    assigned = std::exchange(assigned_, std::nullopt);
  }
  if (assigned) parts_.vision->Assign(*assigned);
}

TrackSnapshot FlightProgram::See(const Frame& frame) {
  Observation observation = parts_.vision->Process(frame);
  observation.latency = Now() - frame.time;
  TrackSnapshot snapshot = parts_.vision->snapshot();
  if (parts_.exposure != nullptr && frame.camera == 0) {
    parts_.exposure->Update(frame.image, snapshot.area);
  }
  // Without pixels many frames can wait for the disk.
  if (parts_.tables != nullptr) {
    parts_.tables->Take(
        {{frame.name, frame.time, {}, {}, frame.camera}, observation.seen, observation.latency});
  }
  if (parts_.sink != nullptr && parts_.sink->IsWanted()) parts_.sink->Take(observation);
  return snapshot;
}

void FlightProgram::BetweenFrames(const std::function<void()>& action) {
  const std::lock_guard lock(vision_mutex_);
  action();
}

// Warns once that the set-up contradicts the images; the summary repeats it, with all that is
// known by then.
void FlightProgram::WarnOnce() {
  if (was_warned_) return;
  const std::string warning = parts_.vision->Warning();
  if (warning.empty()) return;
  was_warned_ = true;
  report_(warning);
}

void FlightProgram::ReportCameras() {
  const auto events = parts_.vision->camera_events();
  for (; reported_camera_events_ < events.size(); ++reported_camera_events_) {
    report_(events[reported_camera_events_]);
  }
}

void FlightProgram::Take(const TeamGoal& goal) {
  TeamInFlight team = InFlight(goal);
  const std::lock_guard lock(team_mutex_);
  team_ = std::move(team);
  assigned_ = AssignedObject{goal.number, goal.own_id, goal.object};
}

FlightToObjects FlightProgram::ToObjects() const {
  const std::lock_guard lock(team_mutex_);
  return to_objects_;
}

void FlightProgram::Order(int mark) { order_ = FollowOrder{++orders_, mark}; }

// True when the camera repeats an image: it shows where the target was, not where it is.
bool FlightProgram::IsFrozen(const Frame& frame) {
  constexpr int kFrozen = 5;  // so many repetitions are no accident of a driver
  const bool was_frozen = repeated_image_.in_a_row() >= kFrozen;
  const bool is_repeated = repeated_image_.IsRepeated(frame.image);
  if (is_repeated) ++repeated_frames_;
  if (repeated_image_.in_a_row() == kFrozen) report_("the camera repeats its image");
  if (was_frozen && !is_repeated) report_("the camera's images move again");
  return is_repeated;
}

// --- The link thread ---

void FlightProgram::Communicate() {
  // A sign of life must not be late because others keep the processors busy. Where the system does
  // not permit the priority it stays as usual.
  ThreadOptions setup;
  if (guard_) setup.priority = kLinkPriority;
  SetUpThisThread("link", setup);
  heard_ = Now();
  while (!is_over_) {
    link_life_.Give(Now());
    parts_.connection->Receive(kLinkPatience, [this](const mavlink::Packet& packet, Time received) {
      parts_.autopilot->Handle(packet, received);
      if (gimbal_) gimbal_->Handle(packet);
      if (camera_) camera_->Handle(packet, received);
    });
    if (parts_.source_has_poses) poses_.Add(source_pose_.Get());  // a repeated one is ignored
    const Time now = Now();
    parts_.autopilot->Tick(now);
    SendTarget(now);
    if (gimbal_) Point(now);
    if (camera_) camera_->Tick(now, track_.Get(), poses_);
    WatchFlight(now);
    if (guard_ && !guard_->Watch(now, set_point_flight_->TaskOfGuard(now))) {
      End({FlightOutcome::kNotLanded, {}, guard_->reason()});
    }
  }
  const auto severity = ExitStatus(end_) == 0 ? mavlink::kSeverityInfo : mavlink::kSeverityWarning;
  parts_.autopilot->Announce(severity, "Kestrel: " + InWords(end_));
  if (parts_.guard != nullptr) parts_.guard->SendGoodbye();
}

void FlightProgram::Point(Time now) {
  if (resumes_pointing_.exchange(false)) gimbal_->Resume();
  gimbal_->Point(now, track_.Get(), poses_);
}

void FlightProgram::ResumePointing() {
  if (parts_.pointed == nullptr) throw InputError("no gimbal is pointed: expected --point");
  resumes_pointing_ = true;
}

void FlightProgram::SendTarget(Time now) {
  const TrackSnapshot& track = track_.Get();
  if (const NoPositionFlight* const flight = set_point_flight_->by_pad()) {
    phase_ = flight->target_phase();
    height_m_ = flight->height_m();
  } else if (sender_) {
    sender_->set_may_stand(!set_point_flight_->is_flying());
    if (sender_->Send(now, track, poses_)) latency_.step(kMessage).Add(Now() - track.captured);
    phase_ = sender_->phase();
    height_m_ = sender_->height_m();
    messages_ = sender_->messages();
  }
  Fly(now, track);
}

void FlightProgram::Fly(Time now, const TrackSnapshot& track) {
  if (GuidedFlight* const guided = set_point_flight_->by_position()) {
    guided->Take(order_);
    guided->set_video_delay(VideoDelay());
    guided->set_take_off_ground(ground_.height_m());
    const std::lock_guard lock(team_mutex_);
    if (auto team = std::exchange(team_, std::nullopt)) guided->Take(*std::move(team));
    to_objects_ = kestrel::ToObjects(*guided, poses_, now, to_objects_);
  }
  if (set_point_flight_->Fly(now, track, poses_))
    latency_.step(kSetPoint).Add(Now() - track.captured);
  if (const GuidedFlight* const guided = set_point_flight_->by_position())
    ended_mark_ = guided->ended().mark;
  guidance_phase_ = set_point_flight_->phase();
  set_points_ = set_point_flight_->set_points();
  // Without a position there are none.
  const bool awaits_poses = parts_.source_has_poses || !set_point_flight_->is_without_position();
  if (awaits_poses != std::exchange(awaits_poses_, awaits_poses)) events_.AwaitPoses(awaits_poses);
}

// The delay that all cameras have, as far as it is known.
Duration FlightProgram::VideoDelay() const {
  if (parts_.late.empty() || parts_.late.size() < parts_.cameras) return {};
  Duration delay = Duration::max();
  for (const LateCamera& late : parts_.late) delay = std::min(delay, late.video->known_delay());
  return delay;
}

void FlightProgram::TakeAutopilotPose(const PoseSample& pose) {
  if (!set_point_flight_->TakePose(pose, Now()) || parts_.source_has_poses) return;
  poses_.Add(pose);
  TakePose(pose);
}

void FlightProgram::TakeAutopilotAttitude(const PoseSample& attitude) {
  set_point_flight_->TakeAttitude(attitude);
}

void FlightProgram::TakeAutopilotAcceleration(Time time, const Eigen::Vector3d& acceleration) {
  set_point_flight_->TakeAcceleration(time, acceleration);
}

void FlightProgram::TakeAutopilotClimb(double climb_mps) {
  set_point_flight_->TakeClimb(climb_mps);
}

void FlightProgram::TakeAutopilotGimbal(const GimbalSample& report) {
  if (gimbal_) gimbal_->TakeReport(report);
  TakeGimbal(report);
}

void FlightProgram::WatchFlight(Time now) {
  if (now < landing_due_) return;
  landing_due_ = now + kLandingPeriod;
  ShowAutopilot(now);
  if (parts_.autopilot->is_here()) {
    was_heard_ = true;
    heard_ = now;
    const LandingWatchInput input = LandingInput(now);
    landing_.Observe(input);
    WatchGround(input);
    if (landing_.end()) EndByLanding(*landing_.end());
    return;
  }
  ReportWhatItWaitsFor(now);
  if (ToSeconds(now - heard_) < options_.autopilot_timeout_s) return;
  End({FlightOutcome::kLinkLost,
       {},
       fmt::format("no heartbeat of the autopilot for {:g} s", options_.autopilot_timeout_s)});
}

// Poses of the source are in a world of their own.
void FlightProgram::WatchGround(const LandingWatchInput& input) {
  const bool is_in_its_world = !parts_.source_has_poses;
  std::optional<double> feet_z_m;
  if (is_in_its_world && input.body) feet_z_m = input.body->feet.z();
  ground_.Update(input.state, input.reboots, feet_z_m,
                 GroundUnderHome(*parts_.autopilot, options_.guidance.leg_m));
  if (is_in_its_world) ground_zero_m_ = ground_.height_m().value_or(0);
}

// Until the first heartbeat. That one which was there is gone is reported by its events.
void FlightProgram::ReportWhatItWaitsFor(Time now) {
  constexpr Duration kPeriod = std::chrono::milliseconds(500);
  if (was_heard_ || now - began_ < kQuietStart || now < wait_due_) return;
  wait_due_ = now + kPeriod;
  const std::string waits = "waits for the autopilot: " + WhySilent(*parts_.connection);
  {
    const std::lock_guard lock(autopilot_mutex_);
    if (autopilot_state_.waits == waits) return;
    autopilot_state_.waits = waits;
  }
  report_(waits);
}

void FlightProgram::ShowAutopilot(Time now) {
  const Autopilot& autopilot = *parts_.autopilot;
  const std::lock_guard lock(autopilot_mutex_);
  AutopilotState& state = autopilot_state_;
  UpdateState(autopilot, now, &state);
  const GuidedFlight* const guided = set_point_flight_->by_position();
  if (guided == nullptr) return;
  const FollowingDemand& demand = guided->demand();
  LimitsInUse& limits = state.limits.emplace();
  limits.lean_share = demand.lean_share();
  limits.speed_share = demand.speed_share();
  limits.climb_share = demand.climb_share();
  if (guided->cannot_follow()) limits.cannot_follow = "needs " + demand.InWords();
}

LandingWatchInput FlightProgram::LandingInput(Time now) {
  const Autopilot& autopilot = *parts_.autopilot;
  LandingWatchInput input{.now = now,
                          .is_armed = autopilot.is_armed(),
                          .state = autopilot.landed_state(),
                          .reboots = autopilot.reboots(),
                          .stamped = autopilot.stamped(),
                          .body = {},
                          .pattern = {},
                          .sight = {},
                          .has_contact = phase_ == TargetPhase::kContact,
                          .gave_up = {}};
  if (const auto pose = poses_.Predict(now, kPoseGap, {})) {
    const Eigen::Vector3d leg(0, 0, options_.guidance.leg_m);
    input.body = {pose->world_from_body.translation - pose->world_from_body.rotation * leg,
                  pose->motion.velocity_in_world};
  }
  const TrackSnapshot& track = track_.Get();
  if (track.sight) {
    input.sight = {track.sight->time,
                   track.sight->target_from_body * Eigen::Vector3d(0, 0, -options_.guidance.leg_m)};
  }
  if (pad_ && track.target && track.state != TrackState::kSearching) {
    const double ahead_s = std::max(ToSeconds(now - track.captured), 0.0);
    const TurnState target = Propagate(track.target->motion, ahead_s, noise_);
    input.pattern = {target.position(), target.covariance.topLeftCorner<3, 3>()};
  }
  input.has_contact = input.has_contact || set_point_flight_->phase() == GuidancePhase::kLanded;
  if (set_point_flight_->is_flying()) gave_up_.clear();
  input.heading_error = set_point_flight_->heading_error();
  if (const std::string reason = set_point_flight_->gave_up(); !reason.empty()) gave_up_ = reason;
  input.gave_up = gave_up_;
  return input;
}

// --- How it is ---

std::shared_ptr<FlightRecorder> FlightProgram::Recorder() const {
  return parts_.recording != nullptr ? parts_.recording->Get() : nullptr;
}

FlightReport FlightProgram::Report() const {
  FlightReport report{.trouble = SourceTrouble(),
                      .capture = parts_.source->counters(),
                      .events = events_.counters(),
                      .repeated_frames = repeated_frames_,
                      .autopilot = {},
                      .recorder = {},
                      .recording = {},
                      .end = {}};
  if (is_over_) report.end = end_;
  if (const auto recorder = Recorder()) {
    report.recorder = recorder->counters();
    report.recording = recorder->folder().string();
  }
  if (parts_.connection == nullptr) return report;
  AutopilotState& autopilot = report.autopilot.emplace();
  {
    const std::lock_guard lock(autopilot_mutex_);
    autopilot = autopilot_state_;
  }
  if (flies_by_set_points()) autopilot.guidance = guidance_phase_.load();
  autopilot.target = phase_;
  autopilot.link = parts_.connection->counters();
  return report;
}

std::string FlightProgram::State() const {
  const CaptureCounters capture = parts_.source->counters();
  std::string state =
      fmt::format("{} frames, {} with the target", frames_.load(), detections_.load());
  {
    const std::lock_guard lock(other_tag_mutex_);
    if (other_tag_ && detections_ == 0) state += fmt::format(" ({})", InWords(*other_tag_));
  }
  if (capture.missed > 0) state += fmt::format(", {} missed", capture.missed);
  if (parts_.autopilot == nullptr) return state;
  {
    const std::lock_guard lock(autopilot_mutex_);
    if (!autopilot_state_.waits.empty()) return state + "; " + autopilot_state_.waits;
  }
  if (pad_) state += fmt::format("; target {}", ToString(phase_.load()));
  if (phase_ == TargetPhase::kFound) state += fmt::format(", {:.1f} m below", height_m_.load());
  if (flies_by_set_points())
    return state + fmt::format("; guidance: {}", ToString(guidance_phase_.load()));
  return state + fmt::format("; {} messages sent", messages_.load());
}

std::string FlightProgram::Summary() const {
  const LiveEvents::Counters events = events_.counters();
  const CaptureCounters capture = parts_.source->counters();
  std::string summary = fmt::format("{} frames, {}", frames_.load(), parts_.vision->Found());
  summary += fmt::format(
      "; {} missed and {} repeated by the camera, {} dropped before the vision, {} without "
      "a pose in time\n",
      capture.missed, repeated_frames_.load(), events.dropped_frames, events.unposed_frames);
  if (const std::string warning = parts_.vision->Warning(); !warning.empty()) {
    summary += warning + "\n";
  }
  for (const std::string& event : parts_.vision->camera_events()) summary += event + "\n";
  summary += latency_.InWords();
  if (parts_.connection == nullptr) return summary;
  const ConnectionCounters link = parts_.connection->counters();
  summary += fmt::format(
      "{} targets and {} set-points sent; {} packets received, {} sent, {} not sent; {} damaged\n",
      messages_.load(), set_points_.load(), link.received, link.sent, link.unsent,
      link.bad_checksums);
  return summary;
}

}  // namespace kestrel
