// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/live_session.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "kestrel/comms/guard/guard_link.h"
#include "kestrel/comms/mavlink/target_profile.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/base/options.h"
#include "kestrel/core/base/write_file.h"
#include "kestrel/flight/onboard/exposure_drive.h"
#include "kestrel/flight/onboard/flight_program.h"
#include "kestrel/flight/onboard/live_session_options.h"
#include "kestrel/flight/onboard/recording_switch.h"
#include "kestrel/flight/session/asynchronous_sink.h"
#include "kestrel/flight/session/autopilot_report.h"
#include "kestrel/flight/session/observation_sinks.h"
#include "kestrel/flight/session/task.h"
#include "kestrel/io/recording/euroc/truth_rows.h"
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

// The options by the names that `kestrel config` gives them.
struct FlyFields {
  LiveSessionOptions& options;

  static void Visit(auto& self, auto&& visit) {
    visit.Group(self.options.flight);
    visit.Group("link", self.options.link);
    visit.Group("autopilot", self.options.autopilot);
    visit.Group("recorder", self.options.recorder);
  }
};
struct SessionFields {
  TaskOptions tasks;
  LiveSessionOptions options;

  static void Visit(auto& self, auto&& visit) {
    FlyFields fly{self.options};
    TaskOptions::Visit(self.tasks, visit);
    visit.Group("fly", fly);
  }
};

SessionFields FieldsOf(const std::vector<std::string>& settings) {
  SessionFields fields;
  for (const std::string& setting : settings) SetOption(setting, &fields);
  return fields;
}

LiveSessionParts WithTask(LiveSessionParts parts, const TaskOptions& options) {
  if (!parts.task) parts.task = MakeTask("land", options);
  return parts;
}

// Guidance must stop as soon as the mode changes, for which the autopilot's one report a second is
// too few.
LiveSessionOptions ForFlight(LiveSessionOptions options, bool guides) {
  constexpr double kMode_hz = 20;
  double& mode_hz = options.autopilot.mode_rate_hz;
  if (guides && mode_hz == 0) mode_hz = kMode_hz;
  return options;
}

}  // namespace

class LiveSession::Impl {
 public:
  Impl(LiveSessionParts parts, LiveSessionOptions options);
  ~Impl();
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  FlightEnd Run(const std::function<bool()>& is_stopped);
  RecordingSwitch& recording() { return recording_; }
  const Vision& vision() const { return *vision_; }
  std::string State() const { return program_->State(); }
  FlightReport Report() const { return program_->Report(); }
  std::string Summary() const;
  void Change(const TaskOptions& options, std::optional<double> altitude_m);
  void BetweenFrames(const std::function<void()>& action) { program_->BetweenFrames(action); }

 private:
  bool HasWorld() const;
  bool Points() const;
  void OpenVision();
  void OpenTables();
  void OpenExposure();
  void StayWithinSight(double range_m);
  void OpenAutopilot();
  std::unique_ptr<FlightRecorder> OpenRecorder(const std::filesystem::path& folder, bool replace);
  FlightParts ProgramParts();
  void Notify(const std::string& text, EventLevel level = EventLevel::kInfo);
  void TakePose(const PoseSample& pose);
  void TakeTruePose(const PoseSample& pose);

  LiveSessionParts parts_;
  LiveSessionOptions options_;
  std::optional<GuardedSink> sink_;
  std::string sink_error_;  // what the sink has thrown; read after Run only
  RecordingSwitch recording_;
  std::filesystem::path end_file_;  // empty: none
  std::unique_ptr<ExposureActuator> actuator_;
  std::optional<ExposureDrive> exposure_;
  std::unique_ptr<Vision> vision_;
  std::optional<AsynchronousSink> tables_;
  GuardLink* guard_ = nullptr;  // of the connection; null: none
  std::optional<Connection> connection_;
  std::optional<Autopilot> autopilot_;
  std::optional<FlightProgram> program_;
};

LiveSession::Impl::Impl(LiveSessionParts parts, LiveSessionOptions options)
    : parts_(std::move(parts)),
      options_(ForFlight(std::move(options), parts_.guides)),
      recording_([this](const std::filesystem::path& folder, bool replace) {
        return OpenRecorder(folder, replace);
      }) {
  if (parts_.sink != nullptr) {
    sink_.emplace(parts_.sink, [this](const std::string& error) { sink_error_ = error; });
  }
  // A frame waits for a pose only if the source or an autopilot sends poses.
  if (parts_.autopilot.empty() && !parts_.has_poses) options_.flight.events.pose_wait_s = 0;
  if (!parts_.record.empty()) recording_.Start(parts_.record, parts_.replace);
  OpenVision();
  const auto pad = vision_->pad();
  if (pad && options_.exposure) OpenExposure();
  if (!parts_.autopilot.empty() && pad) StayWithinSight(pad->range_m);
  if (!parts_.autopilot.empty()) OpenAutopilot();
  program_.emplace(options_.flight, ProgramParts(),
                   [this](const std::string& text) { Notify(text); });
}

// The recorder may still give events to the sink, which outlives the session.
LiveSession::Impl::~Impl() { recording_.Close(); }

FlightEnd LiveSession::Impl::Run(const std::function<bool()>& is_stopped) {
  FlightEnd end = program_->Run(is_stopped);
  recording_.Close();
  if (tables_) tables_->Finish();
  if (!end_file_.empty()) WriteFile(end_file_.string(), FlightEndCsv(end));
  return end;
}

std::string LiveSession::Impl::Summary() const {
  std::string summary = program_->Summary();
  if (!sink_error_.empty()) {
    summary += fmt::format("the sink of the results has failed: {}\n", sink_error_);
  }
  return summary;
}

void LiveSession::Impl::Notify(const std::string& text, EventLevel level) {
  if (sink_) sink_->Take(SessionEvent{Now(), level, text});
}

void LiveSession::Impl::Change(const TaskOptions& options, std::optional<double> altitude_m) {
  BetweenFrames([&] { vision_->Change(options, altitude_m); });
}

// Results have places in the world: there is a mount, and somebody has poses.
bool LiveSession::Impl::HasWorld() const {
  return parts_.calibration.body_from_camera && (parts_.has_poses || !parts_.autopilot.empty());
}

bool LiveSession::Impl::Points() const {
  if (parts_.points && !parts_.calibration.gimbal) {
    throw InputError("the camera's file has no gimbal to point (docs/mounts.md)");
  }
  return (parts_.points || parts_.guides) && parts_.calibration.gimbal && vision_->pad();
}

void LiveSession::Impl::OpenVision() {
  vision_ = parts_.task->MakeVision({.calibration = parts_.calibration,
                                     .altitude_m = options_.altitude_m,
                                     .has_world = HasWorld(),
                                     .is_live = true});
  if (!parts_.output.empty()) OpenTables();
}

void LiveSession::Impl::OpenTables() {
  // That of an earlier flight would be taken for this one's, should this one not come to its end.
  end_file_ = OutputFolder(parts_.output, parts_.replace).NewFile("flight_end.csv");
  std::filesystem::remove(end_file_);
  auto tables = vision_->MakeTables({.folder = parts_.output, .force = parts_.replace});
  if (!tables) return;
  constexpr std::size_t kFrames = 256;  // that may wait for the disk
  tables_.emplace(AsynchronousSinkOptions{.thread_name = "output", .frames = kFrames, .notify = {}},
                  std::make_unique<TableWriter>(std::move(tables),
                                                [this](const std::string& text) { Notify(text); }));
}

// A small pad, or a coarse image, shows nothing from the search altitude.
void LiveSession::Impl::StayWithinSight(double range_m) {
  if (!parts_.guides) {
    return Notify(fmt::format(
        "this camera sees the pad from {:.1f} m at most: begin the autopilot's landing below that",
        range_m));
  }
  GuidanceOptions& guidance = options_.flight.guidance;
  const double requested_m = guidance.search_altitude_m;
  guidance = guidance.WithinSight(range_m);
  if (guidance.search_altitude_m == requested_m) return;
  Notify(
      fmt::format("this camera sees the pad from {:.1f} m at most: guidance searches at {:.1f} m, "
                  "not at search_altitude_m {:g}, and out to {:.1f} m around the place",
                  range_m, guidance.search_altitude_m, requested_m, guidance.search_radius_m));
  if (range_m < guidance.limits.floor_m) {
    Notify(fmt::format("limits.floor_m {:g} is above that: a lost pad will not be found again",
                       guidance.limits.floor_m),
           EventLevel::kWarning);
  }
}

void LiveSession::Impl::OpenExposure() {
  if (parts_.camera == nullptr) {
    throw InputError("fly.control_exposure: the source is no camera whose exposure can be set");
  }
  actuator_ = std::make_unique<RecordedActuator>(parts_.camera, &recording_);
  exposure_.emplace(*options_.exposure, options_.exposure->max_exposure_s, actuator_.get());
}

std::unique_ptr<FlightRecorder> LiveSession::Impl::OpenRecorder(const std::filesystem::path& folder,
                                                                bool replace) {
  return std::make_unique<FlightRecorder>(folder, replace, parts_.calibration, parts_.rate_hz,
                                          options_.recorder,
                                          [this](const std::string& text) { Notify(text); });
}

void LiveSession::Impl::OpenAutopilot() {
  const Connection::Tap tap = [this](std::span<const std::uint8_t> frame, Time time) {
    if (const auto recorder = recording_.Get()) recorder->AddPacket(time, frame);
  };
  std::unique_ptr<GuardLink> guard;
  if (parts_.guides && options_.flight.guard.enabled) {
    guard = std::make_unique<GuardLink>(parts_.autopilot, options_.flight.guard,
                                        options_.link.signing_key);
  }
  guard_ = guard.get();
  if (const auto& gimbal = parts_.calibration.gimbal) {
    options_.autopilot.gimbal_device_id = gimbal->device_id;
    options_.autopilot.points_gimbal = Points();
  }
  connection_.emplace(parts_.autopilot, options_.link, tap, std::move(guard));
  autopilot_.emplace(
      options_.autopilot, &*connection_,
      AutopilotListener{
          .pose = [this](const PoseSample& pose) { TakePose(pose); },
          .true_pose = [this](const PoseSample& pose) { TakeTruePose(pose); },
          .event = [this](const AutopilotEvent& e) { Notify(e.text); },
          .text = [this](
                      std::uint8_t severity,
                      std::string_view text) { Notify(WordsOfAutopilot(text), LevelOf(severity)); },
          .gimbal = [this](const GimbalSample& report) { program_->TakeAutopilotGimbal(report); },
      });
}

FlightParts LiveSession::Impl::ProgramParts() {
  return {.source = parts_.source,
          .vision = vision_.get(),
          .exposure = exposure_ ? &*exposure_ : nullptr,
          .connection = connection_ ? &*connection_ : nullptr,
          .autopilot = autopilot_ ? &*autopilot_ : nullptr,
          .guard = guard_,
          .recording = &recording_,
          .tables = tables_ ? &*tables_ : nullptr,
          .sink = sink_ ? &*sink_ : nullptr,
          .pointed = Points() ? &parts_.calibration : nullptr,
          .guides = parts_.guides,
          .source_has_poses = parts_.has_poses,
          .sees_repeated = parts_.sees_repeated,
          .profile = parts_.profile,
          .truth = parts_.truth,
          .true_offset_m = parts_.true_offset_m};
}

void LiveSession::Impl::TakePose(const PoseSample& pose) {
  program_->TakeAutopilotPose(pose);
  if (parts_.pose) parts_.pose(pose);
}

void LiveSession::Impl::TakeTruePose(const PoseSample& pose) {
  if (parts_.true_pose) parts_.true_pose(pose);
  if (const auto recorder = recording_.Get()) recorder->AddTruePose(pose);
}

LiveSession::LiveSession(LiveSessionParts parts, const std::vector<std::string>& settings)
    : LiveSession(WithTask(std::move(parts), FieldsOf(settings).tasks),
                  FieldsOf(settings).options) {}
LiveSession::LiveSession(LiveSessionParts parts, LiveSessionOptions options)
    : impl_(std::make_unique<Impl>(WithTask(std::move(parts), {}), std::move(options))) {}
LiveSession::~LiveSession() = default;

FlightEnd LiveSession::Run(const std::function<bool()>& is_stopped) {
  return impl_->Run(is_stopped);
}
RecordingSwitch& LiveSession::recording() { return impl_->recording(); }
const Vision& LiveSession::vision() const { return impl_->vision(); }
std::string LiveSession::State() const { return impl_->State(); }
std::string LiveSession::Summary() const { return impl_->Summary(); }
FlightReport LiveSession::Report() const { return impl_->Report(); }
void LiveSession::Change(const TaskOptions& options, std::optional<double> altitude_m) {
  impl_->Change(options, altitude_m);
}
void LiveSession::BetweenFrames(const std::function<void()>& action) {
  impl_->BetweenFrames(action);
}

}  // namespace kestrel
