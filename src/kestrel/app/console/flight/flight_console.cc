// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/flight/flight_console.h"

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>

#include "kestrel/app/console/console_page.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/base/parse_number.h"
#include "kestrel/core/base/thread_setup.h"

namespace kestrel {
namespace {

// Frames that wait to be shown. A longer queue would make the live picture late.
constexpr std::size_t kFrames = 2;
// Times of frames that wait for the checks: those of some seconds.
constexpr std::size_t kArrivals = 256;
constexpr Duration kCheckInterval = std::chrono::seconds(2);
constexpr Duration kAnswerInterval = std::chrono::milliseconds(50);
// A browser that is lost to the network comes back within this time.
constexpr Duration kReturn = std::chrono::seconds(20);
constexpr Duration kLastWords = std::chrono::milliseconds(300);

ConsoleFeed::Description DescriptionOf(const std::string& title, const TaskView& view,
                                       bool has_colors,
                                       const std::vector<ConsoleCommandKind>& offers) {
  const ViewParts parts = PartsOf(view);
  ConsoleFeed::Description description{
      .title = title,
      .is_live = true,
      .series = parts.series,
      .layers = parts.layers,
      .views = parts.images,
      .offers = {ConsoleCommandKind::kRecord, ConsoleCommandKind::kSnapshot,
                 ConsoleCommandKind::kSettings},
      .has_colors = has_colors};
  if (std::holds_alternative<FollowView>(view)) {
    description.offers.push_back(ConsoleCommandKind::kMark);
  }
  description.offers.insert(description.offers.end(), offers.begin(), offers.end());
  description.series.push_back({"latency", "ms", "Capture to result", {ValueSource::kFrames}});
  description.series.push_back({"link", "1/s", "Packets", {ValueSource::kAutopilot}});
  return description;
}

}  // namespace

// Makes the content of the page; used by one thread.
class FlightConsole::Page : public SinkWriter {
 public:
  Page(FlightConsole* console, std::vector<TaskView> views, FlightExamination examination)
      : console_(*console),
        feed_(console->feed_),
        views_(std::move(views)),
        examination_(std::move(examination)) {}

  void Write(const Observation& observation, std::size_t /*waiting*/) override {
    Examine(observation);
    if (!IsShown(observation, Now())) return;
    frame_.captured = observation.frame.time;
    frame_.image = observation.frame.image;
    sources_.Look(frame_.captured, WorldFromCamera(observation).has_value());
    Show(observation);
    {
      const std::lock_guard lock(console_.mutex_);
      console_.shown_ = {frame_.image, frame_.captured};
    }
    feed_.SetFrame(&frame_);
  }

  void Write(const FlightReport& report) override {
    if (const auto health = health_.Update(report, Now())) feed_.Add(*health);
    report_ = report;
    feed_.Add(sources_.Update(report, Now()));
    ShowStatus();
    ShowVehicle();
  }

  void Write(const TeamReport& report) override {
    if (auto team = TeamOf(views_.front(), report)) feed_.Add(*std::move(team));
  }

  void Rest(bool /*had_frame*/) override {
    while (const auto frame = console_.arrivals_.TryPop()) examination_.AddFrame(*frame);
    ShowChecks();
  }

 private:
  // Returns null where something else is looked for.
  static const LandingObservation* LandingIn(const Observation& observation) {
    return std::get_if<LandingObservation>(&observation.seen);
  }

  void Examine(const Observation& observation) {
    if (observation.frame.camera > 0) return;
    if (const auto* const landing = LandingIn(observation)) examination_.Look(*landing);
    examination_.Look(observation.frame.image, Now());
  }

  // True for a frame of the camera that is shown. It changes to one that sees the target when it
  // has not for a while itself, or is gone.
  bool IsShown(const Observation& observation, Time now) {
    constexpr Duration kStay = std::chrono::seconds(1);
    const auto* const landing = LandingIn(observation);
    const bool has_target = landing != nullptr && landing->report.detection;
    const std::size_t camera = observation.frame.camera;
    const bool is_gone = now - shown_at_ > kStay;
    const bool is_blind = has_target && now - shown_target_at_ > kStay;
    if (camera != shown_camera_ && !is_gone && !is_blind) return false;
    shown_camera_ = camera;
    shown_at_ = now;
    if (has_target) shown_target_at_ = now;
    return true;
  }

  void Show(const Observation& observation) {
    ViewFrame shown = ViewFrameOf(views_[observation.frame.camera], observation);
    frame_.shapes = std::move(shown.shapes);
    AddSample(std::move(shown.sample), observation.latency.value_or(Duration::zero()));
    feed_.Add(std::move(shown.map));
    vision_ = std::move(shown.status);
  }

  void AddSample(ViewSample sample, Duration latency) {
    constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    sample.values.push_back(1e3 * ToSeconds(latency));
    sample.values.push_back(health_.link_rate_hz().value_or(kUnknown));
    feed_.Add(std::move(sample));
  }

  void ShowStatus() {
    const ViewStatus status = FlightStatus(report_, vision_);
    if (status == reported_) return;
    reported_ = status;
    feed_.Add(status);
  }

  void ShowVehicle() {
    const auto vehicle = VehicleOf(report_);
    if (!vehicle || *vehicle == reported_vehicle_) return;
    reported_vehicle_ = *vehicle;
    feed_.Add(*vehicle);
  }

  void ShowChecks() {
    const Time now = Now();
    if (!feed_.IsWatched() || now - examined_ < kCheckInterval) return;
    examined_ = now;
    ConsoleDoctor doctor;
    for (const Finding& finding : examination_.Check(report_)) {
      doctor.checks.push_back(
          {finding.check, ToString(finding.verdict), finding.measured, finding.advice});
    }
    feed_.Add(std::move(doctor));
  }

  FlightConsole& console_;
  ConsoleFeed& feed_;
  std::vector<TaskView> views_;  // one for each camera
  std::size_t shown_camera_ = 0;
  Time shown_at_{}, shown_target_at_{};  // its newest frame, and the newest with the target
  ConsoleFrame frame_;
  FlightExamination examination_;
  Time examined_{};
  FlightHealth health_;
  SourceWatch sources_;
  FlightReport report_;  // the newest
  ViewStatus vision_;    // status from the newest frame
  ViewStatus reported_;  // the last status that the page got
  ConsoleVehicle reported_vehicle_;
};

FlightConsole::FlightConsole(const ConsoleOptions& options, const std::string& title,
                             const std::vector<TaskView>& views, FlightExamination examination,
                             ChannelFeed* channels, std::optional<FlightColors> colors,
                             const std::vector<ConsoleCommandKind>& offers)
    : feed_(DescriptionOf(title, views.front(), colors.has_value(), offers)),
      arrivals_(kArrivals),
      server_(ServeConsole(options, &feed_, WebAssets(), channels)),
      pictures_({.thread_name = "console frames",
                 .frames = kFrames,
                 .notify =
                     [this](const std::string& error) {
                       Report(EventLevel::kError, "this page shows no more frames: " + error);
                     }},
                std::make_unique<Page>(this, views, std::move(examination))) {
  if (colors) TeachColors(*colors, views.front());
}

// The page begins with the model that the flight uses.
void FlightConsole::TeachColors(const FlightColors& colors, const TaskView& view) {
  kept_.emplace(colors.frames);
  const auto keep = [this] {
    const Image newest = Newest();
    return kept_->Keep(newest.image, newest.captured);
  };
  colors_.emplace(
      ColorSource{.recording = std::filesystem::absolute(colors.frames).lexically_normal().string(),
                  .frame_count = 0,
                  .read = [this](std::size_t frame) { return kept_->Read(frame); },
                  .model = *ModelOf(view),
                  .folder = colors.folder,
                  .keep = keep,
                  .warn = colors.warn},
      &feed_);
}

// A page that is open gets the end of the flight before the server goes.
void FlightConsole::Finish() {
  if (is_over_.exchange(true)) return;
  if (answering_thread_.joinable()) answering_thread_.join();
  pictures_.Finish();
  if (feed_.IsWatched()) std::this_thread::sleep_for(kLastWords);
}

void FlightConsole::Stay(const std::function<bool()>& is_stopped) {
  Time seen = feed_.IsWatched() ? Now() : Time{};
  while (Now() - seen < kReturn && !is_stopped()) {
    std::this_thread::sleep_for(kAnswerInterval);
    if (feed_.IsWatched()) seen = Now();
  }
}

void FlightConsole::Take(const Observation& observation) {
  if (!feed_.IsWatched()) return;
  const Time captured = observation.frame.time;
  const Duration latency = observation.latency.value_or(Duration::zero());
  if (observation.frame.camera == 0) {
    arrivals_.Push({captured, captured + latency - DetectTime(observation)});
  }
  pictures_.Take(observation);
}

void FlightConsole::Answer(FlightRequests requests) {
  answering_thread_ = std::thread([this, requests = std::move(requests)] {
    SetUpThisThread("console asks", {});
    feed_.Add(requests.settings({}));
    while (!is_over_) {
      while (const auto command = feed_.TakeCommand()) Answer(requests, *command);
      std::this_thread::sleep_for(kAnswerInterval);
    }
  });
}

void FlightConsole::Answer(const FlightRequests& requests, const ConsoleCommand& command) {
  try {
    if (command.kind == ConsoleCommandKind::kRecord) {
      Report(EventLevel::kInfo, requests.record(command.value != 0));
    } else if (command.kind == ConsoleCommandKind::kSnapshot) {
      KeepSnapshot(requests);
    } else if (command.kind == ConsoleCommandKind::kSettings) {
      feed_.Add(requests.settings(command.settings));
    } else if (command.kind == ConsoleCommandKind::kMark) {
      Mark(requests, command.settings);
    } else if (command.kind == ConsoleCommandKind::kPoint) {
      Report(EventLevel::kInfo, requests.point());
    } else if (command.kind == ConsoleCommandKind::kConfirm) {
      Report(EventLevel::kInfo, requests.confirm());
    } else if (command.kind == ConsoleCommandKind::kStop) {
      Report(EventLevel::kInfo, requests.stop());
    }
  } catch (const InputError& error) {
    Report(EventLevel::kError, error.what());
  }
}

// 'mark': the time of the picture (ns), and x, y, width and height (px) in it.
void FlightConsole::Mark(const FlightRequests& requests, const std::vector<std::string>& mark) {
  const auto time = mark.size() == 5 ? ParseNumber<std::int64_t>(mark[0]) : std::nullopt;
  std::array<double, 4> box{};
  for (std::size_t i = 0; time && i < box.size(); ++i) {
    const auto value = ParseNumber<double>(mark[i + 1]);
    if (!value) throw InputError("mark: expected numbers");
    box[i] = *value;
  }
  if (!time) throw InputError("mark: expected the time of a picture and a box");
  Report(EventLevel::kInfo,
         requests.mark(TimeFromNanoseconds(*time), {box[0], box[1], box[2], box[3]}));
}

void FlightConsole::KeepSnapshot(const FlightRequests& requests) {
  const Image newest = Newest();
  if (newest.image.empty()) {
    return Report(EventLevel::kWarning, "no snapshot: there is no image yet");
  }
  Report(EventLevel::kInfo, requests.keep_snapshot(newest.image, newest.captured));
}

FlightConsole::Image FlightConsole::Newest() {
  const std::lock_guard lock(mutex_);
  return shown_;
}

}  // namespace kestrel
