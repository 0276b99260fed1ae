// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/cli/fly_command.h"

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "kestrel/app/cli/camera_run.h"
#include "kestrel/app/cli/fly_arguments.h"
#include "kestrel/app/cli/interrupt.h"
#include "kestrel/app/cli/page_links.h"
#include "kestrel/app/cli/terminal.h"
#include "kestrel/app/cli/video_argument.h"
#include "kestrel/app/console/flight/flight_console.h"
#include "kestrel/app/fly/fly_autopilot.h"
#include "kestrel/app/fly/fly_source.h"
#include "kestrel/app/foxglove/flight_live.h"
#include "kestrel/app/foxglove/mcap_sink.h"
#include "kestrel/app/options/field_settings.h"
#include "kestrel/app/views/task_view.h"
#include "kestrel/comms/team/team_link.h"
#include "kestrel/core/base/bounded_queue.h"
#include "kestrel/core/base/error.h"
#include "kestrel/flight/onboard/camera_automatics.h"
#include "kestrel/flight/onboard/flight_keeper.h"
#include "kestrel/flight/onboard/look_pictures.h"
#include "kestrel/flight/onboard/session.h"
#include "kestrel/flight/onboard/video_server.h"
#include "kestrel/flight/onboard/video_sink.h"
#include "kestrel/flight/ros/ros_sink.h"
#include "kestrel/flight/session/observation_sinks.h"
#include "kestrel/flight/session/task.h"
#include "kestrel/flight/session/team_sharing.h"
#include "kestrel/io/recording/media/video_address.h"
#include "kestrel/io/recording/open_source.h"

namespace kestrel {
namespace {

constexpr double kStatePeriod_s = 5;
constexpr char kEndsByLanding[] =
    "runs until Ctrl-C, SIGTERM or the landing; goes on when its terminal closes\n";
constexpr char kEndsWithoutAutopilot[] =
    "runs until Ctrl-C, SIGTERM or the end of the source; goes on when its terminal closes\n";

// A camera that is slow, or delivers nothing, must not look like a program that hangs.
void OpenAloud(const std::string& source, const std::function<void()>& open) {
  const std::jthread notice([&source](const std::stop_token& is_open) {
    constexpr Duration kQuiet = std::chrono::seconds(1);
    std::mutex mutex;
    std::unique_lock lock(mutex);
    std::condition_variable_any().wait_for(lock, is_open, kQuiet, [] { return false; });
    if (is_open.stop_requested() || !IsCamera(source)) return;
    Print("waits for the camera: the first image of " + WithoutPassword(source) + "\n");
  });
  open();
}

// Prints events with the time since the start. Any thread may give one and does not wait for the
// terminal; the flight's own thread shows them.
class FlightLog : public ObservationSink {
 public:
  void Take(const Observation&) override {}
  void Take(const SessionEvent& event) override {
    lines_.Push(fmt::format("{:8.1f} s  {}\n", ToSeconds(event.time - start_), event.text));
  }
  bool IsWanted() const override { return false; }

  void Show() {
    while (const auto line = lines_.TryPop()) Print(*line);
  }

 private:
  static constexpr std::size_t kLines = 256;
  BoundedQueue<std::string> lines_{kLines};
  Time start_ = Now();
};

std::shared_ptr<const Task> TaskOf(const FlyArguments& arguments, const KestrelOptions& options) {
  return MakeTask(arguments.task.name, options,
                  {.model = ReadModel(arguments.model),
                   .go = arguments.job.target == GoTarget::kObject ? arguments.go : ""});
}

// A flight: its sinks and its team around a session.
class Flight {
 public:
  // 'options': those that the arguments give.
  Flight(const FlyArguments& arguments, const KestrelOptions& options)
      : arguments_(arguments),
        options_(options),
        settings_(arguments.source.options.config, arguments.given, options),
        task_(TaskOf(arguments, options)),
        source_(options_, arguments_.source.dds.NodeOpener(options_.dds)) {
    OpenAloud(arguments_.source.sources.front(), [this] { OpenSource(); });
    RequireAutopilot();
    log_ = sinks_.Add(std::make_unique<FlightLog>());
    OpenConsole();
    OpenVideo();
    OpenTeam();
    OpenMcap();
    OpenDds();
    OpenPictures();
    autopilot_ = MakeFlyAutopilot(arguments.autopilot, options_.fly, arguments.guide, &source_);
    session_ = MakeSession(source_.live, *task_, Options());
    session_->sinks().Add(std::move(own_sinks_));
    if (video_) ShowVideo();
    if (team_) ShareWithTeam();
  }

  // Leaves the page, with how the flight ended, to those who look at it.
  void ShowEnd(const FlightEnd& end) {
    if (console_ == nullptr || !console_->IsWanted()) return;
    fmt::print(stderr, "{}; the page stays while somebody looks, Ctrl-C ends it\n", InWords(end));
    console_->Stay(WasInterrupted);
  }

  // The console asks nothing of a session that is gone.
  ~Flight() { session_->sinks().Finish(); }
  Flight(const Flight&) = delete;
  Flight& operator=(const Flight&) = delete;

  FlightEnd Run() {
    CatchInterrupts();
    keeper_.emplace(options_.fly.keep_folder, &session_->recording());
    if (console_ != nullptr) console_->Answer(Requests());
    if (autopilot_.simulated) autopilot_.simulated->Start();
    Time next_state = Now();
    FlightEnd end = session_->Run([&] {
      log_->Show();
      if (sharing_ != nullptr) FlyWithTeam();
      if (Now() >= next_state) {
        Log(session_->State());
        next_state += DurationFromSeconds(kStatePeriod_s);
      }
      return WasInterrupted();
    });
    if (autopilot_.simulated) autopilot_.simulated->Stop();
    PrintSummary();
    return end;
  }

 private:
  void OpenSource() {
    if (arguments_.source.sources.size() > 1) {
      source_.Open(arguments_.Cameras(task_->format()), [](const std::string& fault) {
        fmt::print(stderr, "kestrel: {}; the flight goes on with the others\n", fault);
      });
    } else {
      RecordingChoice choice = arguments_.source.Recording(task_->format());
      choice.all_cameras = task_->takes_several_cameras();
      source_.Open(choice, arguments_.loop);
    }
    if (source_.live.further.empty() || task_->takes_several_cameras()) return;
    throw WrongUsage(fmt::format("--{}: expected one camera", arguments_.task.name));
  }

  // A simulated camera renders where the autopilot says that the UAV is: without one, nothing.
  void RequireAutopilot() const {
    const std::string& source = arguments_.source.sources.front();
    if (!SimulatedSource::IsNamed(source) || !arguments_.autopilot.empty()) return;
    throw WrongUsage(source + ": expected --autopilot URL, as sim:ardupilot or sim:px4");
  }

  void Notify(const std::string& text, EventLevel level = EventLevel::kInfo) {
    sinks_.Take(SessionEvent{Now(), level, text});
  }

  // Prints a line on the terminal; no other sink gets it.
  void Log(const std::string& text) { log_->Take(SessionEvent{Now(), EventLevel::kInfo, text}); }

  TaskView View() const { return ViewOf(*task_, source_.live.calibration); }

  // The first step: an error about a port in use comes before anything is written.
  void OpenConsole() {
    if (!arguments_.console) return;
    const ConsoleOptions& options = options_.console;
    std::vector<TaskView> views = {View()};
    std::vector<FlightLive::FurtherCamera> further;
    for (const CameraCalibration& camera : source_.live.further) {
      views.push_back(ViewOf(*task_, camera));
      further.push_back({camera.name, camera.intrinsics, views.back()});
    }
    FlightLive* const live = sinks_.Add(std::make_unique<FlightLive>(
        source_.live.calibration.intrinsics, View(), options.max_image_rate_hz, further));
    const FlightExamination examination(
        source_.live.calibration,
        arguments_.record.empty() ? options_.fly.keep_folder : arguments_.record,
        options_.fly.recorder.free_space_mb);
    console_ = sinks_.Add(
        std::make_unique<FlightConsole>(options, WithoutPassword(arguments_.source.sources.front()),
                                        views, examination, live->channels(), Colors(), Offers()));
    PrintLinks(console_->urls());
    Log("for Foxglove: " + console_->viewer_url());
  }

  // The commands of the page that only some flights have.
  std::vector<ConsoleCommandKind> Offers() const {
    std::vector<ConsoleCommandKind> offers;
    const bool follows = std::holds_alternative<FollowView>(View());
    if (source_.live.calibration.gimbal && (arguments_.point || (arguments_.guide && !follows))) {
      offers.push_back(ConsoleCommandKind::kPoint);
    }
    if (follows && arguments_.guide) {
      offers.insert(offers.end(), {ConsoleCommandKind::kConfirm, ConsoleCommandKind::kStop});
    }
    return offers;
  }

  // As early as the page, for the same reason.
  void OpenVideo() {
    if (arguments_.video.empty()) return;
    const VideoServerOptions options = ParseVideoUrl(arguments_.video, options_.console);
    video_ = std::make_unique<VideoServer>(options);
    video_urls_ = VideoUrls(options, video_->port());
    for (const std::string& url : video_urls_) fmt::print(stderr, "video: {}\n", url);
  }

  void ShowVideo() {
    session_->sinks().Add(MakeVideoSink(
        video_.get(), session_->vision().MakePainter(),
        [this](const std::string& text) { Notify("video: " + text, EventLevel::kWarning); }));
  }

  // Folders where the page of colours of a hunt keeps frames and models.
  std::optional<FlightColors> Colors() const {
    const TaskView view = View();
    if (ModelOf(view) == nullptr) return std::nullopt;
    const std::filesystem::path folder = options_.fly.keep_folder;
    return FlightColors{PathOfNow(folder, "colors_"), (folder / "taught").string(),
                        [camera = arguments_.source.sources.front()] {
                          return ColorWarnings(ReadCameraAutomatics(camera));
                        }};
  }

  bool HasWorld() const {
    return source_.live.calibration.body_from_camera &&
           (source_.live.has_poses || !arguments_.autopilot.empty());
  }

  // Names of the frames, as the topic or the options have them; stamps are ROS' time.
  RosFrames Frames() const {
    if (source_.dds.frames()) return *source_.dds.frames();
    RosFrames frames = OwnFrames(options_.dds, HasWorld(), source_.live.further);
    frames.to_stamps = RosTimeAhead();
    return frames;
  }

  void OpenDds() {
    if (!arguments_.source.dds.is_given()) return;
    std::shared_ptr<Ros2Node> node = source_.dds.node();
    if (!node) node = arguments_.source.dds.OpenNode(options_.dds);
    sinks_.Add(
        MakeRosSink(MakeRos2Results(node, options_, Frames(), *task_, source_.live.calibration,
                                    source_.live.further, ReadModel(arguments_.model)),
                    [this](const std::string& text) { Log(text); }));
  }

  void OpenMcap() {
    const SourceArguments& source = arguments_.source;
    if (source.mcap.empty()) return;
    RequireNoSource(source.mcap, source.sources);
    sinks_.Add(OpenMcapSink(
        source.mcap, source.force, *task_, source_.live.calibration, source_.live.further,
        [this](const std::string& text) { Notify(text, EventLevel::kWarning); }));
  }

  // In the folder of the tables, or else in that of what is kept.
  void OpenPictures() {
    if (arguments_.go.empty() || arguments_.job.action != GoAction::kLook) return;
    const std::string& output = arguments_.source.output;
    const std::string folder = output.empty() ? options_.fly.keep_folder : output;
    sinks_.Add(MakeLookPictures(PathOfNow(folder, "look_"),
                                [this](const std::string& text) { Notify(text); }));
  }

  // Called before anything is written.
  void OpenTeam() {
    if (arguments_.team.team.empty()) return;
    if (!HasWorld()) {
      throw InputError(
          "--team: expected --autopilot or a source with poses, and the camera's mount");
    }
    team_ = std::make_unique<TeamLink>(
        arguments_.team.team, arguments_.source.dds.Domain(), options_.team, options_.hunt.map,
        ReadModel(arguments_.model), [this](const std::string& text) { Notify(text); });
    if (!arguments_.go.empty()) team_->Seek(arguments_.go);
  }

  SessionOptions Options() const {
    SessionOptions options = SessionOptionsFor(autopilot_, options_.fly, arguments_.guide);
    if (arguments_.profile != "auto") options.profile = ParseLinkProfile(arguments_.profile);
    options.points = arguments_.point;
    options.job = arguments_.job;
    options.place = arguments_.place;
    options.box = arguments_.box_place;
    options.sends_pad_position = arguments_.pad_position;
    options.without_position = arguments_.WithoutPosition();
    options.output = arguments_.source.output;
    options.record = arguments_.record;
    options.replace = arguments_.source.force;
    if (video_) {
      options.stream = CameraStream{.uri = video_urls_.back(),
                                    .rate_hz = kVideoRate_hz,
                                    .delay = [video = video_.get()] { return video->delay(); }};
    }
    return options;
  }

  void ShareWithTeam() {
    const SourceArguments& source = arguments_.source;
    std::optional<OutputFolder> folder;
    if (!source.output.empty()) folder.emplace(source.output, source.force);
    sharing_ = session_->sinks().Add(std::make_unique<LiveTeamSharing>(
        std::move(team_), session_->vision().map(), std::move(folder), &sinks_, WasInterrupted));
  }

  void FlyWithTeam() {
    TeamLink& team = sharing_->team();
    team.SetFlight(session_->ToObjects());
    sharing_->Share();
    if (const TeamGoal* goal = team.goal()) session_->Take(*goal);
  }

  FlightRequests Requests() {
    const auto logged = [this](const std::string& reported) {
      Log(reported);
      return reported;
    };
    return {.record =
                [this, logged](bool is_on) {
                  return logged(is_on ? keeper_->StartRecording() : keeper_->StopRecording());
                },
            .keep_snapshot =
                [this, logged](const cv::Mat& image, Time captured) {
                  return logged(keeper_->KeepSnapshot(image, captured));
                },
            .mark =
                [this, logged](Time captured, const cv::Rect2d& box) {
                  session_->Mark(captured, box);
                  return logged(
                      fmt::format("follows a box of {:.0f} x {:.0f} px", box.width, box.height));
                },
            .point =
                [this, logged] {
                  session_->ResumePointing();
                  return logged("requests the gimbal again");
                },
            .confirm =
                [this, logged] {
                  session_->Confirm();
                  return logged("confirmed: the UAV may fly to what is marked");
                },
            .stop =
                [this, logged] {
                  session_->StopFollowing();
                  return logged("stopped: the UAV stands still and looks");
                },
            .settings =
                [this](const std::vector<std::string>& settings) {
                  if (settings.empty()) return settings_.State();
                  return settings_.Save(settings, session_->Report().autopilot);
                }};
  }

  void PrintSummary() {
    log_->Show();
    Print(session_->Summary());
    if (autopilot_.simulated) Print(InWords(autopilot_.simulated->result()));
    if (sharing_ != nullptr) Print(sharing_->Found() + "\n");
  }

  FlyArguments arguments_;
  KestrelOptions options_;
  FieldSettings settings_;  // used by the page's thread
  std::shared_ptr<const Task> task_;
  FlySource source_;
  std::unique_ptr<ObservationSinks> own_sinks_ = std::make_unique<ObservationSinks>();
  ObservationSinks& sinks_ = *own_sinks_;  // the session's, once there is one
  FlightLog* log_ = nullptr;               // one of the sinks
  FlightConsole* console_ = nullptr;       // one of the sinks; null: none
  std::unique_ptr<VideoServer> video_;     // null: none
  std::vector<std::string> video_urls_;    // for other devices last
  std::unique_ptr<TeamLink> team_;         // until 'sharing_' has it; null: none
  FlyAutopilot autopilot_;
  std::unique_ptr<LiveSession> session_;
  LiveTeamSharing* sharing_ = nullptr;  // one of the sinks; null: no team
  std::optional<FlightKeeper> keeper_;
};

// True for a camera of whose lens nothing is known, if it is the only one.
bool IsUncalibrated(const FlyArguments& arguments) {
  const std::vector<std::string>& sources = arguments.source.sources;
  return sources.size() == 1 && IsCamera(sources.front()) && arguments.source.cameras.empty();
}

// Throws WrongUsage for what needs a measurement. 'advice': how there would be one.
void RequireNoResults(const FlyArguments& arguments, const std::string& advice) {
  const SourceArguments& source = arguments.source;
  const std::pair<const char*, bool> results[] = {{"--autopilot", !arguments.autopilot.empty()},
                                                  {"--dds", source.dds.is_given()},
                                                  {"--team", !arguments.team.team.empty()},
                                                  {"--output", !source.output.empty()},
                                                  {"--mcap", !source.mcap.empty()},
                                                  {"--video", !arguments.video.empty()}};
  for (const auto& [option, is_given] : results) {
    if (is_given) throw WrongUsage(fmt::format("{}: nothing to send or write: {}", option, advice));
  }
}

// Shows and records a camera that cannot measure.
void RunUncalibrated(const FlyArguments& arguments, const KestrelOptions& options) {
  const std::string name = WithoutPassword(arguments.source.sources.front());
  const std::string advice = fmt::format(
      "{0} has no lens calibration, so nothing is measured: `kestrel console {1}` or `kestrel "
      "calibrate lens` makes one for --camera FILE",
      name, ShellWord(name));
  RequireNoResults(arguments, advice);
  FlySource source(options, {});
  CameraRunChoice choice{.camera = arguments.source.Recording(TaskOf(arguments, options)->format()),
                         .is_looped = arguments.loop,
                         .keep_folder = options.fly.keep_folder,
                         .record = arguments.record,
                         .replaces = arguments.source.force};
  choice.camera.may_assume_lens = true;
  if (arguments.console) choice.page = options.console;
  OpenAloud(name, [&] { source.Open(choice.camera, choice.is_looped); });
  CameraRun run(options, choice, &source);
  Print("kestrel: " + advice + "\n");
  Print(kEndsWithoutAutopilot);
  CatchInterrupts();
  Time next_state = Now();
  run.Play([&] {
    if (Now() >= next_state) {
      Print(run.State() + "\n");
      next_state += DurationFromSeconds(kStatePeriod_s);
    }
    return WasInterrupted();
  });
  Print(run.State() + "\n");
  const auto outcome = WasInterrupted() ? FlightOutcome::kStopped : FlightOutcome::kSourceEnded;
  Print(InWords({.outcome = outcome}) + "\n");
}

void RunFly(FlyArguments arguments) {
  OutliveTerminal();
  const KestrelOptions options = arguments.ReadOptions();
  if (IsUncalibrated(arguments)) return RunUncalibrated(arguments, options);
  Flight flight(arguments, options);
  Print(arguments.autopilot.empty() ? kEndsWithoutAutopilot : kEndsByLanding);
  const FlightEnd end = flight.Run();
  flight.ShowEnd(end);
  if (ExitStatus(end) != 0) throw BadFlightEnd(end);
  Print(InWords(end) + "\n");
}

}  // namespace

void FlyUntilInterrupted(FlyArguments arguments) {
  const KestrelOptions options = arguments.ReadOptions();
  while (!WasInterrupted()) {
    Flight flight(arguments, options);
    Print(InWords(flight.Run()) + "\n");
  }
}

void AddFlyCommand(CLI::App* app) {
  CLI::App* command =
      app->add_subcommand("fly", "On board: live camera and autopilot in, landing target out");
  const auto arguments = std::make_shared<FlyArguments>();
  arguments->AddTo(command);
  command->callback([arguments] { RunFly(*arguments); });
}

}  // namespace kestrel
