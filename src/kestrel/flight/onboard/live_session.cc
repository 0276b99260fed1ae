// SPDX-License-Identifier: BSD-3-Clause
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "kestrel/comms/guard/guard_link.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/base/write_file.h"
#include "kestrel/flight/guidance/follow_guidance.h"
#include "kestrel/flight/guidance/go_guidance.h"
#include "kestrel/flight/guidance/landing_guidance.h"
#include "kestrel/flight/guidance/view_limits.h"
#include "kestrel/flight/onboard/exposure_drive.h"
#include "kestrel/flight/onboard/flight_program.h"
#include "kestrel/flight/onboard/recording_switch.h"
#include "kestrel/flight/onboard/session.h"
#include "kestrel/flight/session/asynchronous_sink.h"
#include "kestrel/flight/session/autopilot_report.h"
#include "kestrel/io/recording/output_folder.h"

namespace kestrel {
namespace {

// Records every exposure that the camera is set to.
class RecordedActuator : public ExposureActuator {
 public:
  RecordedActuator(ExposureActuator* camera, const RecordingSwitch* recording)
      : camera_(camera), recording_(recording) {}

  bool SetExposure(double exposure_s) override {
    if (!camera_->SetExposure(exposure_s)) return false;
    if (const auto recorder = recording_->Get()) recorder->AddExposure(Now(), exposure_s);
    return true;
  }

 private:
  ExposureActuator* camera_;
  const RecordingSwitch* recording_;
};

// Writes the tables. The rows after one that the disk does not take are tried all the same.
class TableWriter : public SinkWriter {
 public:
  // 'notify' is called for the first such row.
  TableWriter(std::unique_ptr<ObservationSink> tables,
              std::function<void(const std::string&)> notify)
      : tables_(std::move(tables)), notify_(std::move(notify)) {}

  void Write(const Observation& observation, std::size_t /*waiting*/) override {
    Try([&] { tables_->Take(observation); });
  }
  void Finish(std::size_t /*dropped*/) override {
    Try([&] { tables_->Finish(); });
  }

 private:
  template <class Action>
  void Try(const Action& action) {
    try {
      action();
    } catch (const InputError&) {
      if (std::exchange(has_failed_, true)) return;
      notify_("the results cannot be written any more: is the disk full? The flight goes on");
    }
  }

  std::unique_ptr<ObservationSink> tables_;
  std::function<void(const std::string&)> notify_;
  bool has_failed_ = false;
};

// Results have places in the world: there is a mount, and somebody has poses.
SessionCamera CameraOf(const OpenedLiveSource& live, const SessionOptions& options) {
  return {.calibration = live.calibration,
          .further = live.further,
          .altitude_m = options.altitude_m,
          .has_world =
              live.calibration.body_from_camera && (live.has_poses || !options.autopilot.empty()),
          .is_live = true};
}

class Flight : public LiveSession {
 public:
  Flight(const OpenedLiveSource& live, const Task& task, const SessionOptions& options);
  ~Flight() override { recording_.Close(); }  // it may still report to the sinks

  using Session::Run;
  FlightEnd Run(const std::function<bool()>& is_stopped) override;
  std::string Summary() const override;
  void Change(const TaskOptions& options, std::optional<double> altitude_m) override {
    BetweenFrames([&] { mutable_vision().Change(options, altitude_m); });
  }
  void Mark(Time frame, const cv::Rect2d& box_px) override {
    BetweenFrames([&] { mutable_vision().Mark(frame, box_px); });
  }
  void ResumePointing() override { program_->ResumePointing(); }
  void Confirm() override;
  void StopFollowing() override { program_->Order(0); }
  void Take(const TeamGoal& goal) override { program_->Take(goal); }
  FlightToObjects ToObjects() const override { return program_->ToObjects(); }
  void BetweenFrames(const std::function<void()>& action) override {
    program_->BetweenFrames(action);
  }
  RecordingSwitch& recording() override { return recording_; }
  FlightReport Report() const override { return program_->Report(); }
  std::string State() const override { return program_->State(); }

 private:
  FlightOptions& flight() { return options_.flight; }
  bool Points() const;
  std::optional<ViewLimits> FixedView() const;
  GuidanceMaker Guide() const;
  void OpenTables();
  void OpenExposure();
  void StayWithinSight(double range_m);
  AutopilotOptions WantedOfAutopilot() const;
  void OpenAutopilot();
  std::unique_ptr<FlightRecorder> OpenRecorder(const std::filesystem::path& folder, bool replace);
  FlightParts ProgramParts();
  void Notify(const std::string& text, EventLevel level = EventLevel::kInfo) {
    sinks().Take(SessionEvent{Now(), level, text});
  }
  void TakePose(const PoseSample& pose);
  void TakeGimbal(const GimbalSample& report);
  void TakeZoom(const ZoomSample& report) { program_->TakeZoom(report); }
  void TakeTruePose(const PoseSample& pose);

  const OpenedLiveSource& live_;
  SessionOptions options_;
  std::vector<SessionEvent> opening_;  // events before Run, when there are no sinks yet
  RecordingSwitch recording_;
  std::filesystem::path end_file_;  // empty: none
  std::unique_ptr<ExposureActuator> actuator_;
  std::optional<ExposureDrive> exposure_;
  std::optional<AsynchronousSink> tables_;
  GuardLink* guard_ = nullptr;  // one end of the connection; null: none
  std::optional<Connection> connection_;
  std::optional<Autopilot> autopilot_;
  std::optional<FlightProgram> program_;
};

Flight::Flight(const OpenedLiveSource& live, const Task& task, const SessionOptions& options)
    : LiveSession(task.MakeVision(CameraOf(live, options)), SinkErrors::kLeaveOut),
      live_(live),
      options_(options),
      recording_([this](const std::filesystem::path& folder, bool replace) {
        return OpenRecorder(folder, replace);
      }) {
  const bool has_autopilot = !options_.autopilot.empty();
  // A frame waits for a pose only if the source or an autopilot sends poses.
  if (!has_autopilot && !live_.has_poses) flight().events.pose_wait_s = 0;
  if (!options_.record.empty()) recording_.Start(options_.record, options_.replace);
  if (!options_.output.empty()) OpenTables();
  const auto pad = vision().pad();
  if (pad && flight().control_exposure) OpenExposure();
  if (has_autopilot && pad && options_.job.target == GoTarget::kObject) {
    StayWithinSight(pad->range_m);
  }
  if (has_autopilot) OpenAutopilot();
  program_.emplace(flight(), ProgramParts(), [this](const std::string& text) { Notify(text); });
}

FlightEnd Flight::Run(const std::function<bool()>& is_stopped) {
  for (const SessionEvent& event : opening_) sinks().Take(event);
  FlightEnd end = program_->Run(is_stopped);
  recording_.Close();
  if (tables_) tables_->Finish();
  sinks().Finish();
  if (!end_file_.empty()) WriteFile(end_file_.string(), FlightEndCsv(end));
  return end;
}

std::string Flight::Summary() const {
  std::string summary = program_->Summary();
  if (const std::string failure = sinks().failure(); !failure.empty()) {
    summary += fmt::format("a sink of the results has failed: {}\n", failure);
  }
  return summary;
}

bool Flight::Points() const {
  if (options_.points && !live_.calibration.gimbal) {
    throw InputError("the camera's file has no gimbal to point (docs/mounts.md)");
  }
  return (options_.points || options_.guides) && live_.calibration.gimbal &&
         (vision().pad() || vision().marked());
}

// Nothing where a gimbal turns the camera.
std::optional<ViewLimits> Flight::FixedView() const {
  const CameraCalibration& camera = live_.calibration;
  if (camera.gimbal || !camera.body_from_camera) return std::nullopt;
  return ViewLimits(camera.intrinsics, *camera.body_from_camera);
}

// Returns the guidance of the task; null: nobody is guided.
GuidanceMaker Flight::Guide() const {
  if (!options_.guides) return nullptr;
  const std::optional<ViewLimits> view = FixedView();
  const GoJob& job = options_.job;
  if (job.target == GoTarget::kMarked && view && !view->Sees(0, job.height_m)) {
    throw InputError("--go marked: the camera, fixed as it is, does not look straight down");
  }
  if (vision().seeks_object() || job.target != GoTarget::kObject) {
    return [job](const GuidanceOptions& options) {
      return std::make_unique<GoGuidance>(options, job);
    };
  }
  if (!vision().marked()) {
    return
        [](const GuidanceOptions& options) { return std::make_unique<LandingGuidance>(options); };
  }
  return [view](const GuidanceOptions& options) {
    return std::make_unique<FollowGuidance>(options, view);
  };
}

void Flight::Confirm() {
  const auto autopilot = program_->Report().autopilot;
  if (!options_.guides || !autopilot) throw InputError("nothing flies: expected --guide");
  if (autopilot->guidance.value_or(GuidancePhase::kIdle) == GuidancePhase::kIdle) {
    throw InputError("guidance does not fly the UAV: the pilot must give the mode first");
  }
  BetweenFrames([this] {
    const int mark = vision().snapshot().mark;
    if (mark == 0) throw InputError("nothing is marked yet");
    program_->Order(mark);
  });
}

void Flight::OpenTables() {
  // That of an earlier flight would be taken for this one's, should this one not come to its end.
  end_file_ = OutputFolder(options_.output, options_.replace).NewFile("flight_end.csv");
  std::filesystem::remove(end_file_);
  auto tables = vision().MakeTables({.folder = options_.output, .force = options_.replace});
  if (!tables) return;
  constexpr std::size_t kFrames = 256;  // that may wait for the disk
  tables_.emplace(AsynchronousSinkOptions{.thread_name = "output", .frames = kFrames, .notify = {}},
                  std::make_unique<TableWriter>(std::move(tables),
                                                [this](const std::string& text) { Notify(text); }));
}

// A small pad, or a coarse image, shows nothing from the search altitude.
void Flight::StayWithinSight(double range_m) {
  const auto note = [this](const std::string& text, EventLevel level = EventLevel::kInfo) {
    opening_.push_back({Now(), level, text});
  };
  const auto& relative = options_.without_position;
  const bool searches = options_.guides && (!relative || relative->is_reserve);
  if (!searches) {
    return note(fmt::format("this camera sees the pad from {:.1f} m at most: begin{} below that",
                            range_m, options_.guides ? "" : " the autopilot's landing"));
  }
  GuidanceOptions& guidance = flight().guidance;
  const double requested_m = guidance.search_altitude_m;
  guidance = guidance.WithinSight(range_m);
  if (guidance.search_altitude_m == requested_m) return;
  note(
      fmt::format("this camera sees the pad from {:.1f} m at most: guidance searches at {:.1f} m, "
                  "not at search_altitude_m {:g}, and out to {:.1f} m around the place",
                  range_m, guidance.search_altitude_m, requested_m, guidance.search_radius_m));
  if (range_m < guidance.limits.floor_m) {
    note(fmt::format("limits.floor_m {:g} is above that: a lost pad will not be found again",
                     guidance.limits.floor_m),
         EventLevel::kWarning);
  }
}

void Flight::OpenExposure() {
  if (live_.actuator == nullptr) {
    throw InputError("fly.control_exposure: the source is no camera whose exposure can be set");
  }
  actuator_ = std::make_unique<RecordedActuator>(live_.actuator, &recording_);
  exposure_.emplace(flight().exposure, flight().exposure.max_exposure_s, actuator_.get());
}

std::unique_ptr<FlightRecorder> Flight::OpenRecorder(const std::filesystem::path& folder,
                                                     bool replace) {
  return std::make_unique<FlightRecorder>(
      folder, replace, live_.calibration, live_.rate_hz, flight().recorder,
      [this](const std::string& text) { Notify(text); }, live_.further);
}

AutopilotOptions Flight::WantedOfAutopilot() const {
  AutopilotOptions wanted = options_.flight.autopilot;
  // Guidance must stop as soon as the mode changes, for which the autopilot's one report a second
  // is too few.
  constexpr double kMode_hz = 20;
  if (options_.guides && wanted.mode_rate_hz == 0) wanted.mode_rate_hz = kMode_hz;
  if (live_.true_pose) wanted.wants_true_pose = true;
  const bool is_without = options_.without_position.has_value();
  wanted.wants_acceleration = options_.sends_pad_position || is_without;
  wanted.wants_sticks = wanted.wants_climb = is_without;
  if (const auto& gimbal = live_.calibration.gimbal) {
    if (options_.without_position) {
      throw InputError(
          "a flight without a position (--no-position, --floor): the camera is on a gimbal, "
          "expected one that is fixed");
    }
    wanted.gimbal_device_id = gimbal->device_id;
    wanted.points_gimbal = Points();
  }
  if (const auto& zoom = live_.calibration.zoom) wanted.zoom_device_id = zoom->device_id;
  for (const CameraCalibration& further : live_.further) {
    if (further.zoom) throw InputError(further.name + " zooms: expected the first camera alone to");
  }
  return wanted;
}

void Flight::OpenAutopilot() {
  const Connection::Tap tap = [this](std::span<const std::uint8_t> frame, Time time) {
    if (const auto recorder = recording_.Get()) recorder->AddPacket(time, frame);
  };
  std::unique_ptr<GuardLink> guard;
  if (options_.guides && flight().guard.enabled) {
    guard =
        std::make_unique<GuardLink>(options_.autopilot, flight().guard, flight().link.signing_key);
  }
  guard_ = guard.get();
  connection_.emplace(options_.autopilot, flight().link, tap, std::move(guard));
  autopilot_.emplace(WantedOfAutopilot(), &*connection_,
                     AutopilotListener{
                         .pose = [this](const PoseSample& pose) { TakePose(pose); },
                         .true_pose = [this](const PoseSample& pose) { TakeTruePose(pose); },
                         .event = [this](const AutopilotEvent& e) { Notify(e.text); },
                         .text =
                             [this](std::uint8_t severity, std::string_view text) {
                               Notify(WordsOfAutopilot(text), LevelOf(severity));
                             },
                         .gimbal = [this](const GimbalSample& report) { TakeGimbal(report); },
                         .zoom = [this](const ZoomSample& report) { TakeZoom(report); },
                         .attitude =
                             [this](const PoseSample& pose) {
                               if (program_) program_->TakeAutopilotAttitude(pose);
                             },
                         .acceleration =
                             [this](Time time, const Eigen::Vector3d& acceleration) {
                               if (program_) {
                                 program_->TakeAutopilotAcceleration(time, acceleration);
                               }
                             },
                         .climb =
                             [this](double climb_mps) {
                               if (program_) program_->TakeAutopilotClimb(climb_mps);
                             },
                     });
}

FlightParts Flight::ProgramParts() {
  return {.source = live_.source.get(),
          .late = live_.late,
          .vision = &mutable_vision(),
          .exposure = exposure_ ? &*exposure_ : nullptr,
          .connection = connection_ ? &*connection_ : nullptr,
          .autopilot = autopilot_ ? &*autopilot_ : nullptr,
          .guard = guard_,
          .recording = &recording_,
          .tables = tables_ ? &*tables_ : nullptr,
          .sink = &sinks(),
          .pointed = Points() ? &live_.calibration : nullptr,
          .tracking = autopilot_ && vision().takes_marks() ? &live_.calibration : nullptr,
          .stream = options_.stream ? &*options_.stream : nullptr,
          .guidance = Guide(),
          .box = options_.box,
          .place = options_.place,
          .sends_pad_position = options_.sends_pad_position,
          .without_position = options_.without_position,
          .source_has_poses = live_.has_poses,
          .sees_repeated = live_.sees_repeated,
          .cameras = 1 + live_.further.size(),
          .profile = options_.profile,
          .truth = live_.truth,
          .true_offset_m = live_.true_offset_m};
}

void Flight::TakePose(const PoseSample& pose) {
  program_->TakeAutopilotPose(pose);
  if (live_.pose) live_.pose(pose);
  for (const LateCamera& late : live_.late) late.video->Add(pose);
}

void Flight::TakeGimbal(const GimbalSample& report) {
  program_->TakeAutopilotGimbal(report);
  for (const LateCamera& late : live_.late) late.video->Add(report);
}

void Flight::TakeTruePose(const PoseSample& pose) {
  if (live_.true_pose) live_.true_pose(pose);
  if (const auto recorder = recording_.Get()) recorder->AddTruePose(pose);
}

}  // namespace

std::unique_ptr<LiveSession> MakeSession(const OpenedLiveSource& source, const Task& task,
                                         const SessionOptions& options) {
  return std::make_unique<Flight>(source, task, options);
}

}  // namespace kestrel
