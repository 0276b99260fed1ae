// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/cli/fly_command.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "kestrel/app/cli/fly_arguments.h"
#include "kestrel/app/cli/fly_autopilot.h"
#include "kestrel/app/cli/fly_source.h"
#include "kestrel/app/cli/interrupt.h"
#include "kestrel/app/cli/team_link.h"
#include "kestrel/app/console/flight_console.h"
#include "kestrel/app/foxglove/flight_live.h"
#include "kestrel/app/foxglove/mcap_sink.h"
#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/core/base/bounded_queue.h"
#include "kestrel/core/base/error.h"
#include "kestrel/flight/onboard/camera_automatics.h"
#include "kestrel/flight/onboard/flight_keeper.h"
#include "kestrel/flight/onboard/hunt_vision.h"
#include "kestrel/flight/onboard/landing_vision.h"
#include "kestrel/flight/onboard/recording_switch.h"
#include "kestrel/flight/ros/ros2_result_connection.h"
#include "kestrel/flight/ros/ros_sink.h"
#include "kestrel/flight/ros1/ros1_result_connection.h"
#include "kestrel/io/recording/output_folder.h"

namespace kestrel {
namespace {

constexpr double kStatePeriod_s = 5;

// Lines for the user, with the time since the start. Any thread may say something and does not wait
// for the terminal; one shows what was said.
class FlightLog {
 public:
  void Say(const std::string& text) {
    lines_.Push(fmt::format("{:8.1f} s  {}\n", ToSeconds(Now() - start_), text));
  }
  void Show() {
    while (const auto line = lines_.TryPop()) fmt::print(stderr, "{}", *line);
  }

 private:
  static constexpr std::size_t kLines = 256;
  BoundedQueue<std::string> lines_{kLines};
  Time start_ = Now();
};

EventLevel LevelOf(std::uint8_t severity) {
  if (severity <= mavlink::kSeverityError) return EventLevel::kError;
  return severity <= mavlink::kSeverityWarning ? EventLevel::kWarning : EventLevel::kInfo;
}

// Records what a camera's exposure is from when on.
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

// Ends what is recorded.
class RecordingEnd {
 public:
  explicit RecordingEnd(RecordingSwitch* recording) : recording_(recording) {}
  ~RecordingEnd() { recording_->Close(); }
  RecordingEnd(const RecordingEnd&) = delete;
  RecordingEnd& operator=(const RecordingEnd&) = delete;

 private:
  RecordingSwitch* recording_;
};

// One flight: its parts, in the order in which they need each other.
class Flight {
 public:
  explicit Flight(const FlyArguments& arguments)
      : arguments_(arguments), all_options_(arguments.ReadOptions()) {
    const FlyOptions& options = all_options_.fly;
    const PixelFormat format = arguments.hunt ? PixelFormat::kBgr : PixelFormat::kGray;
    source_ = OpenFlySource(arguments.source, format, all_options_, arguments.loop);
    OpenConsole();
    OpenTeam();
    OpenMcap();
    OpenDds();
    OpenRos1();
    if (!arguments.record.empty()) recording_.Start(arguments.record, arguments.source.force);
    OpenVision();
    if (!arguments.autopilot.empty()) OpenAutopilot();
    program_.emplace(options.flight, all_options_.landing.tracker, Parts(),
                     [this](const std::string& text) { Say(text); });
  }

  FlightEnd Run() {
    CatchInterrupts();
    if (console_ != nullptr) console_->Answer(Requests());
    if (simulated_autopilot_) simulated_autopilot_->Start();
    Time next_state = Now();
    const FlightEnd end = program_->Run([&] {
      log_.Show();
      if (team_) ShareMap();
      if (Now() >= next_state) {
        log_.Say(program_->State());
        next_state += DurationFromSeconds(kStatePeriod_s);
      }
      return WasInterrupted();
    });
    if (simulated_autopilot_) simulated_autopilot_->Stop();
    Finish(end);
    return end;
  }

 private:
  void Say(const std::string& text, EventLevel level = EventLevel::kInfo) {
    log_.Say(text);
    sinks_.Take(SessionEvent{Now(), level, text});
  }

  ObjectModel ReadModel() const {
    return arguments_.model.empty() ? DefaultObjectModel() : ReadObjectModel(arguments_.model);
  }

  FlightView View() const {
    if (arguments_.hunt) return HuntView{ReadModel(), all_options_.hunt.detector};
    return ViewOf(source_.calibration, all_options_.landing);
  }

  // First of all: a port that is taken is said before anything is written.
  void OpenConsole() {
    if (!arguments_.console) return;
    const ConsoleOptions& options = all_options_.console;
    FlightLive* const live = sinks_.Add(std::make_unique<FlightLive>(
        source_.calibration.intrinsics, View(), options.max_image_rate_hz));
    const FlightExamination examination(
        source_.calibration,
        arguments_.record.empty() ? all_options_.fly.keep_folder : arguments_.record,
        all_options_.fly.recorder.free_space_mb);
    console_ = sinks_.Add(std::make_unique<FlightConsole>(options,
                                                          arguments_.source.sources.front(), View(),
                                                          examination, live->channels(), Colors()));
    log_.Say("console: " + console_->url());
    log_.Say("for Foxglove: " + console_->viewer_url());
  }

  // Of a hunt: where the page of colours keeps frames and models.
  std::optional<FlightColors> Colors() const {
    if (!arguments_.hunt) return std::nullopt;
    const std::filesystem::path folder = all_options_.fly.keep_folder;
    return FlightColors{PathOfNow(folder, "colors_"), (folder / "taught").string(),
                        [camera = arguments_.source.sources.front()] {
                          return ColorWarnings(ReadCameraAutomatics(camera));
                        }};
  }

  bool HasWorld() const {
    return source_.calibration.body_from_camera &&
           (source_.has_poses || !arguments_.autopilot.empty());
  }

  // What a topic's frames are called, or the options call them; stamps are ROS' time.
  RosFrames Frames() const {
    if (source_.frames) return *source_.frames;
    RosFrames frames = OwnFrames(all_options_.dds, HasWorld());
    frames.to_stamps = RosTimeAhead();
    return frames;
  }

  void OpenDds() {
    if (!arguments_.source.dds.is_given()) return;
    const DdsOptions& options = all_options_.dds;
    if (!source_.node) source_.node = arguments_.source.dds.OpenNode(options);
    OpenRos(std::make_unique<Ros2ResultConnection>(source_.node, options.node, Topics()),
            WireFormat::kCdr);
  }

  void OpenRos1() {
    if (!arguments_.ros) return;
    OpenRos(std::make_unique<Ros1ResultConnection>(
                kestrel::OpenRos1(all_options_.dds.node, "--ros"), Topics()),
            WireFormat::kRos1);
  }

  ResultTopics Topics() const {
    return arguments_.hunt ? ResultTopics(kHuntTopics) : kLandingTopics;
  }

  void OpenRos(std::unique_ptr<ResultConnection> connection, WireFormat format) {
    sinks_.Add(MakeRosSink(
        std::make_unique<RosResults>(std::move(connection), format, all_options_.dds, Frames(),
                                     source_.calibration, all_options_.landing, ReadModel()),
        [this](const std::string& text) { log_.Say(text); }));
  }

  void OpenMcap() {
    const SourceArguments& source = arguments_.source;
    if (source.mcap.empty()) return;
    RequireNoSource(source.mcap, source.sources);
    sinks_.Add(OpenMcapSink(source.mcap, source.force, source_.calibration.intrinsics, View(),
                            [this](const std::string& text) { Say(text, EventLevel::kWarning); }));
  }

  // Before anything is written.
  void OpenTeam() {
    if (arguments_.team.team.empty()) return;
    if (!HasWorld()) {
      throw InputError(
          "--team: expected --autopilot or a source with poses, and the camera's mount");
    }
    team_.emplace(arguments_.team, arguments_.source.dds.Domain(), all_options_.team,
                  all_options_.hunt.map, ReadModel(),
                  [this](const std::string& text) { Say(text); });
  }

  void OpenVision() {
    if (!arguments_.source.output.empty()) {
      output_.emplace(arguments_.source.output, arguments_.source.force);
    }
    const OutputFolder* const output = output_ ? &*output_ : nullptr;
    if (arguments_.hunt) {
      auto hunt =
          std::make_unique<HuntVision>(source_.calibration, ReadModel(), all_options_.hunt, output);
      hunt_ = hunt.get();
      if (team_) hunt_->ShareMap(DurationFromSeconds(all_options_.team.team.tell_period_s));
      vision_ = std::move(hunt);
      return;
    }
    vision_ = std::make_unique<LandingVision>(source_.calibration, all_options_.landing, output,
                                              Exposure());
  }

  std::optional<ExposureDrive> Exposure() {
    const FlyOptions& options = all_options_.fly;
    if (!options.control_exposure) return std::nullopt;
    if (source_.actuator == nullptr) {
      throw InputError("fly.control_exposure: the source is no camera whose exposure can be set");
    }
    actuator_.emplace(source_.actuator, &recording_);
    return ExposureDrive(options.exposure, options.exposure.max_exposure_s, &*actuator_);
  }

  std::unique_ptr<FlightRecorder> OpenRecorder(const std::filesystem::path& folder, bool replace) {
    return std::make_unique<FlightRecorder>(folder, replace, source_.calibration, source_.rate_hz,
                                            all_options_.fly.recorder,
                                            [this](const std::string& text) { Say(text); });
  }

  FlightRequests Requests() {
    const auto logged = [this](const std::string& said) {
      log_.Say(said);
      return said;
    };
    return {.record =
                [this, logged](bool is_on) {
                  return logged(is_on ? keeper_.StartRecording() : keeper_.StopRecording());
                },
            .keep_snapshot =
                [this, logged](const cv::Mat& image, Time captured) {
                  return logged(keeper_.KeepSnapshot(image, captured));
                }};
  }

  void OpenAutopilot() {
    FlyAutopilot opened = MakeFlyAutopilot(arguments_.autopilot, all_options_.fly, &source_);
    simulated_autopilot_ = std::move(opened.simulated);
    const Connection::Tap tap = [this](std::span<const std::uint8_t> frame, Time time) {
      if (const auto recorder = recording_.Get()) recorder->AddPacket(time, frame);
    };
    connection_.emplace(opened.url, all_options_.fly.link, tap);
    autopilot_.emplace(source_.Asking(all_options_.fly.autopilot), &*connection_,
                       AutopilotListener{
                           .pose = [this](const PoseSample& pose) { TakePose(pose); },
                           .true_pose = [this](const PoseSample& pose) { TakeTruePose(pose); },
                           .event = [this](const AutopilotEvent& e) { Say(e.text); },
                           .text =
                               [this](std::uint8_t severity, std::string_view text) {
                                 Say(fmt::format("autopilot: {}", text), LevelOf(severity));
                               },
                       });
  }

  FlightParts Parts() {
    FlightParts parts;
    parts.source = source_.source.get();
    parts.vision = vision_.get();
    parts.connection = connection_ ? &*connection_ : nullptr;
    parts.autopilot = autopilot_ ? &*autopilot_ : nullptr;
    parts.recording = &recording_;
    parts.sink = &sinks_;
    parts.guides = arguments_.guide;
    parts.source_has_poses = source_.has_poses;
    parts.pattern_size_m = all_options_.landing.detector.pattern.outer_diameter_m;
    if (arguments_.profile != "auto") parts.profile = ParseLinkProfile(arguments_.profile);
    if (source_.simulated != nullptr) {
      parts.truth = [camera = source_.simulated](const Frame& frame) {
        return camera->Truth(frame);
      };
    }
    return parts;
  }

  void ShareMap() {
    if (auto map = hunt_->TakeMap()) {
      if (map->position) team_->SetPosition(*map->position);
      team_->Tell(std::move(map->objects));
      sinks_.Take(TeamReport{map->captured, team_->Map()});
      seen_ = map->captured;
    }
    team_->Exchange();
  }

  void LeaveTeam() {
    team_->Finish(hunt_->Objects());
    sinks_.Take(TeamReport{seen_, team_->Map()});
    if (output_) team_->WriteMap(/*origin=*/{}, *output_);
  }

  void TakePose(const PoseSample& pose) {
    program_->TakeAutopilotPose(pose);
    source_.TakePose(pose);
  }

  void TakeTruePose(const PoseSample& pose) {
    source_.TakeTruePose(pose);
    if (const auto recorder = recording_.Get()) recorder->AddTruePose(pose);
  }

  // What waits is written, the recording first; then all that is known is said.
  void Finish(FlightEnd end) {
    recording_.Close();
    if (hunt_ != nullptr && output_) hunt_->WriteMap(*output_);
    if (team_) LeaveTeam();
    sinks_.Finish();
    log_.Show();
    fmt::print(stderr, "{}", program_->Summary());
    if (simulated_autopilot_) fmt::print(stderr, "{}", InWords(simulated_autopilot_->result()));
    if (end == FlightEnd::kLanded) fmt::print(stderr, "landed\n");
    if (team_) fmt::print(stderr, "{}\n", team_->Found());
  }

  FlyArguments arguments_;
  KestrelOptions all_options_;
  FlightLog log_;
  FlySource source_;
  RecordingSwitch recording_{[this](const std::filesystem::path& folder, bool replace) {
    return OpenRecorder(folder, replace);
  }};
  FlightKeeper keeper_{all_options_.fly.keep_folder, &recording_};
  ObservationSinks sinks_;
  FlightConsole* console_ = nullptr;         // of the sinks; null: none
  RecordingEnd recording_end_{&recording_};  // while the console can still be told of it
  std::optional<OutputFolder> output_;
  std::unique_ptr<FlightVision> vision_;
  HuntVision* hunt_ = nullptr;  // the vision, when it is one
  std::optional<TeamLink> team_;
  Time seen_{};  // the newest frame that the team was told of
  std::optional<RecordedActuator> actuator_;
  std::unique_ptr<SimulatedAutopilot> simulated_autopilot_;
  std::optional<Connection> connection_;
  std::optional<Autopilot> autopilot_;
  std::optional<FlightProgram> program_;
};

void RunFly(const FlyArguments& arguments) {
  Flight flight(arguments);
  if (flight.Run() == FlightEnd::kFailed) {
    throw FlightFailed("the flight ended because camera or autopilot failed for good");
  }
}

}  // namespace

void AddFlyCommand(CLI::App* app) {
  CLI::App* command =
      app->add_subcommand("fly", "On board: live camera and autopilot in, landing target out");
  const auto arguments = std::make_shared<FlyArguments>();
  arguments->AddTo(command);
  command->callback([arguments] { RunFly(*arguments); });
}

}  // namespace kestrel
