// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/doctor/examination.h"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <thread>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "kestrel/comms/mavlink/silence.h"
#include "kestrel/flight/doctor/calibration_checks.h"
#include "kestrel/flight/doctor/camera_checks.h"
#include "kestrel/flight/doctor/camera_pair_checks.h"
#include "kestrel/flight/doctor/computer_checks.h"
#include "kestrel/flight/doctor/gimbal_checks.h"
#include "kestrel/flight/doctor/link_checks.h"
#include "kestrel/flight/doctor/mount_checks.h"
#include "kestrel/flight/doctor/parameter_checks.h"
#include "kestrel/flight/doctor/statistics.h"
#include "kestrel/flight/doctor/zoom_checks.h"

namespace kestrel {
namespace {

constexpr Duration kPatience = std::chrono::milliseconds(100);  // longest wait of a thread
constexpr Duration kLinkPatience = std::chrono::milliseconds(5);
// Time until the requested streams run at their rate.
constexpr Duration kStreamsStart = std::chrono::milliseconds(2500);
constexpr std::size_t kRememberedPoses = 1024;
constexpr Duration kLargestGap = std::chrono::milliseconds(500);

CameraCalibration WithoutMount(CameraCalibration calibration) {
  calibration.body_from_camera.reset();
  return calibration;
}

Duration ClockOffsetOf(const CameraCalibration& calibration) {
  return calibration.clock_offset.value_or(Duration::zero());
}

}  // namespace

Examination::Examination(const LandingPipelineOptions& options, const LiveEventsOptions& events,
                         const ExaminationParts& parts)
    : parts_(parts),
      events_(events, ClockOffsetOf(parts.calibration), 1 + parts.further.size()),
      poses_(kRememberedPoses, kLargestGap) {
  if (parts.source != nullptr) {
    eyes_.push_back({parts.calibration, LandingPipeline(WithoutMount(parts.calibration), options)});
    for (const CameraCalibration& camera : parts.further) {
      eyes_.push_back({camera, LandingPipeline(WithoutMount(camera), options)});
    }
  }
  if (const auto& gimbal = parts.calibration.gimbal; gimbal && parts.autopilot != nullptr) {
    manager_.emplace(gimbal->device_id, parts.autopilot, parts.connection);
  }
}

void Examination::Run(Duration duration, const std::function<bool()>& is_stopped,
                      DoctorObservations* observations) {
  std::vector<std::thread> threads;
  if (parts_.source != nullptr) {
    threads.emplace_back([this] { See(); });
    threads.emplace_back([this] { Capture(); });
  }
  const Time start = Now();
  while (Now() - start < duration && !is_stopped()) {
    if (parts_.connection == nullptr) {
      std::this_thread::sleep_for(kPatience);
    } else {
      Communicate(Now());
    }
  }
  is_over_ = true;
  events_.Close();
  for (std::thread& thread : threads) thread.join();
  Summarize(start, Now(), observations);
}

// --- The capture thread ---

void Examination::Capture() {
  while (!is_over_) {
    std::optional<Event> event = parts_.source->Next(kPatience);
    if (!event) continue;
    if (std::holds_alternative<EndOfStream>(*event)) return;
    if (const auto* pose = std::get_if<PoseSample>(&*event)) {
      events_.Push(*pose);
      continue;
    }
    if (const auto* report = std::get_if<GimbalSample>(&*event)) {
      events_.Push(*report);
      continue;
    }
    if (const auto* report = std::get_if<ZoomSample>(&*event)) {
      events_.Push(*report);
      continue;
    }
    auto& frame = std::get<Frame>(*event);
    Eye& eye = eyes_.at(frame.camera);
    eye.frames.push_back({frame.time, Now()});
    eye.width_px = frame.image.cols;
    eye.height_px = frame.image.rows;
    events_.Push(std::move(frame));
  }
}

// --- The vision thread ---

void Examination::See() {
  for (;;) {
    const Event event = events_.Next();
    if (std::holds_alternative<EndOfStream>(event)) return;
    if (const auto* pose = std::get_if<PoseSample>(&event)) {
      poses_.Add(*pose);
    } else if (const auto* gimbal = std::get_if<GimbalSample>(&event)) {
      for (Eye& eye : eyes_) eye.pipeline.AddGimbal(*gimbal);
    } else if (const auto* zoom = std::get_if<ZoomSample>(&event)) {
      for (Eye& eye : eyes_) eye.pipeline.AddZoom(*zoom);
    } else {
      Look(std::get<Frame>(event));
    }
  }
}

void Examination::Look(const Frame& frame) {
  constexpr Duration kFurthestPose = std::chrono::milliseconds(100);
  Eye& eye = eyes_.at(frame.camera);
  const LandingObservation seen = eye.pipeline.Process(frame.image, frame.time);
  eye.detect_s.push_back(ToSeconds(seen.detect_time));
  const Time taken = frame.time + ClockOffsetOf(eye.calibration);
  eye.latency_s.push_back(ToSeconds(Now() - taken));
  eye.qualities.push_back(MeasureImageQuality(frame.image));
  eye.other_tag = seen.other_tag;
  const auto& detection = seen.report.detection;
  if (!detection) return;
  PatternSample sample = PatternSampleOf(*detection);
  sample.time = taken;
  if (const auto pose = poses_.Predict(taken, kFurthestPose, {})) {
    sample.world_from_body = pose->world_from_body;
  }
  eye.patterns.push_back(sample);
}

// --- The link ---

void Examination::Communicate(Time now) {
  parts_.connection->Receive(kLinkPatience, [this](const mavlink::Packet& packet, Time received) {
    TakePacket(packet, received);
    parts_.autopilot->Handle(packet, received);
    if (manager_) manager_->Handle(packet);
  });
  parts_.autopilot->Tick(now);
  if (manager_) manager_->Tick(now);
  if (parts_.autopilot->is_here()) WantParameters();
}

void Examination::TakePacket(const mavlink::Packet& packet, Time received) {
  hears_signed_ = hears_signed_ || packet.is_signed;
  if (packet.system != parts_.autopilot->system()) return;
  if (!heard_) heard_ = received;
  if (!listening_ && received - *heard_ > kStreamsStart) listening_ = received;
  if (packet.id == mavlink::Heartbeat::kId) ++heartbeats_;
  const bool is_attitude = packet.id == mavlink::AttitudeQuaternion::kId;
  const bool is_position = packet.id == mavlink::LocalPositionNed::kId;
  if (is_attitude) attitude_time_ = received;
  if (is_position) position_time_ = received;
  if (!listening_) return;
  attitudes_ += is_attitude ? 1 : 0;
  positions_ += is_position ? 1 : 0;
}

void Examination::TakePose(const PoseSample& pose) {
  events_.Push(pose);
  world_from_body_ = pose.world_from_body.rotation;
}

void Examination::TakeGimbal(const GimbalSample& report) {
  constexpr std::size_t kMost = 5000;
  events_.Push(report);
  gimbal_reports_ += listening_ ? 1 : 0;
  if (world_from_body_ && gimbal_.size() < kMost) gimbal_.push_back({report, *world_from_body_});
}

void Examination::TakeZoom(const ZoomSample& report) {
  events_.Push(report);
  zoom_reports_ += listening_ ? 1 : 0;
  view_rad_ = report.view_rad;
}

void Examination::WantParameters() {
  if (requested_parameters_) return;
  requested_parameters_ = true;
  for (const ListedCheck& checked : CheckedParameters(parts_.autopilot->kind())) {
    parts_.autopilot->parameters().Want(checked.name);
  }
}

void Examination::TakeEvent(const AutopilotEvent& event) {
  constexpr std::size_t kMost = 8;
  switch (event.kind) {
    case AutopilotEventKind::kOtherAutopilot:
    case AutopilotEventKind::kIdClash:
    case AutopilotEventKind::kOwnIdIsAutopilots:
    case AutopilotEventKind::kTargetEcho:
    case AutopilotEventKind::kNotFinite:
    case AutopilotEventKind::kTimeBackwards:
      if (reported_.size() < kMost) reported_.push_back(event.text);
      break;
    case AutopilotEventKind::kNoTimeSync:
      is_one_way_ = true;
      break;
    default:
      break;  // reported by other checks
  }
}

// --- At the end ---

void Examination::Summarize(Time start, Time end, DoctorObservations* observations) const {
  observations->calibration = parts_.calibration;
  if (parts_.source != nullptr) {
    const double duration_s = ToSeconds(end - start);
    SummarizeCamera(eyes_.front(), duration_s, observations);
    observations->camera.counters = parts_.source->counters();  // of all cameras
    observations->further.resize(parts_.further.size());
    for (std::size_t i = 0; i < parts_.further.size(); ++i) {
      SummarizeCamera(eyes_[1 + i], duration_s, &observations->further[i]);
    }
    constexpr double kMega = 1e6;
    for (const Eye& eye : eyes_) {
      observations->computer.frame_mb += eye.width_px * eye.height_px / kMega;
    }
  }
  if (parts_.autopilot == nullptr) return;
  observations->camera.is_on_ground =
      !parts_.autopilot->is_armed() && parts_.autopilot->landed_state() == LandedState::kOnGround;
  SummarizeLink(end, &observations->link);
  SummarizeGimbal(&observations->gimbal);
  SummarizeParameters(&observations->parameters);
}

void Examination::SummarizeCamera(const Eye& eye, double duration_s, CameraSetup* setup) const {
  setup->calibration = eye.calibration;
  CameraObservations& camera = setup->camera;
  camera.error = parts_.source->error();
  camera.duration_s = duration_s;
  camera.width_px = eye.width_px;
  camera.height_px = eye.height_px;
  camera.frames = eye.frames;
  camera.qualities = eye.qualities;
  SummarizeVision(eye, &setup->vision);
}

void Examination::SummarizeVision(const Eye& eye, VisionObservations* vision) const {
  constexpr double kMostOf = 0.9;
  vision->frames = static_cast<int>(eye.detect_s.size());
  vision->dropped_frames = static_cast<int>(events_.counters().dropped_frames);
  vision->patterns = eye.patterns;
  vision->other_tag = eye.other_tag;
  vision->focal = eye.pipeline.calibration_monitor().Focal();
  vision->focal_contradiction = eye.pipeline.calibration_monitor().Contradiction();
  if (eye.detect_s.empty()) return;
  vision->detect_s = MedianOf(eye.detect_s);
  vision->detect_p90_s = QuantileOf(eye.detect_s, kMostOf);
  vision->latency_s = MedianOf(eye.latency_s);
}

void Examination::SummarizeLink(Time end, LinkObservations* link) const {
  const Autopilot& autopilot = *parts_.autopilot;
  link->counters = parts_.connection->counters();
  link->own_system = parts_.connection->system();
  link->autopilot_system = autopilot.system();
  link->hears_signed = hears_signed_;
  link->is_heard = autopilot.is_here();
  if (!link->is_heard) link->silence = WhySilent(*parts_.connection);
  link->kind = autopilot.kind();
  link->version = autopilot.version();
  link->mode = autopilot.mode_name();
  link->is_armed = autopilot.is_armed();
  link->heartbeats = heartbeats_;
  if (autopilot.is_here()) link->vehicle_type = autopilot.vehicle_type();
  link->listened_s = listening_ ? ToSeconds(end - *listening_) : 0;
  link->attitudes = attitudes_;
  link->positions = positions_;
  if (parts_.calibration.gimbal) link->gimbal_reports = gimbal_reports_;
  link->zoom_reports = zoom_reports_;
  link->view_rad = view_rad_;
  link->attitude_age_s = ToSeconds(end - attitude_time_);
  link->position_age_s = ToSeconds(end - position_time_);
  link->has_origin = autopilot.origin().has_value();
  link->has_good_position = autopilot.is_position_good(end);
  link->lost_packets = autopilot.counters().lost_packets;
  const TimeSync& clock = autopilot.time_sync();
  link->knows_clock = clock.is_known();
  if (clock.is_known()) {
    link->round_trip_s = ToSeconds(clock.round_trip());
    link->drift = clock.drift();
    link->clock_sigma_s = clock.sigma_s(end);
  }
  link->is_one_way = is_one_way_;
  link->clock_jumps = clock.jumps();
  link->restarts = autopilot.restarts();
  link->events = reported_;
}

void Examination::SummarizeGimbal(GimbalObservations* gimbal) const {
  if (!manager_) return;
  gimbal->reports = gimbal_;
  gimbal->range = manager_->range();
  if (const auto& status = manager_->status()) {
    gimbal->controller = {status->primary_control_sysid, status->primary_control_compid};
  }
}

void Examination::SummarizeParameters(ParameterValues* values) const {
  const ParameterReader& reader = parts_.autopilot->parameters();
  for (const auto& [name, wants] : CheckedParameters(parts_.autopilot->kind())) {
    const auto value = reader.Find(name);
    const auto entry = reader.EntryOf(name);
    if (!value || !entry) continue;
    values->insert_or_assign(std::string(name),
                             ReportedParameter{*value, entry->name, entry->scale});
  }
}

namespace {

// The checks of one camera.
std::vector<Finding> CheckSetup(const DoctorObservations& observations) {
  std::vector<Finding> findings = CheckCalibration(observations);
  std::ranges::copy(CheckCamera(observations.camera, observations.use),
                    std::back_inserter(findings));
  std::ranges::copy(CheckMount(observations), std::back_inserter(findings));
  return findings;
}

std::vector<Finding> CheckFurther(const DoctorObservations& observations,
                                  const CameraSetup& further) {
  DoctorObservations own = observations;
  static_cast<CameraSetup&>(own) = further;
  std::vector<Finding> findings = CheckSetup(own);
  std::erase_if(findings, [](const Finding& one) { return one.check == "missed images"; });
  findings.push_back(CheckCamerasTogether(observations, further));
  for (Finding& finding : findings) {
    finding.check = fmt::format("{}: {}", further.calibration.name, finding.check);
  }
  return findings;
}

}  // namespace

PatternSample PatternSampleOf(const TargetDetection& detection) {
  PatternSample sample;
  sample.camera_from_target = detection.camera_from_target;
  sample.mirror_camera_from_target = detection.diagnostics.mirror_camera_from_target;
  sample.ring_px = 2 * detection.semi_minor_px;
  sample.misfit_px = detection.diagnostics.misfit_px;
  sample.contradicts = detection.diagnostics.calibration.contradicts;
  return sample;
}

std::vector<Finding> Check(const DoctorObservations& observations) {
  std::vector<Finding> findings;
  const auto add = [&](const std::vector<Finding>& part) {
    findings.insert(findings.end(), part.begin(), part.end());
  };
  add(CheckSetup(observations));
  for (const CameraSetup& further : observations.further) add(CheckFurther(observations, further));
  for (const std::string& fault : observations.unopened) {
    CameraObservations unopened;
    unopened.open_error = fault;
    add({CheckImages(unopened)});
  }
  add(CheckLink(observations.link, observations.use));
  add(CheckGimbal(observations));
  if (observations.calibration.zoom) add({CheckZoom(observations)});
  add(CheckParameters(observations));
  add(CheckComputer(observations));
  return findings;
}

}  // namespace kestrel
