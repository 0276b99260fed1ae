// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/console/replay_console.h"

#include <algorithm>
#include <cmath>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "kestrel/base/error.h"
#include "kestrel/console/frame_picture.h"
#include "kestrel/console/replay_options.h"

namespace kestrel {
namespace {

constexpr double kMaxSpeed = 100;
// How often is looked for what users ask, and the fastest that pictures change.
constexpr Duration kLookInterval = std::chrono::milliseconds(20);
// How often the page is told how far a second run is.
constexpr Duration kTellInterval = std::chrono::milliseconds(250);

std::vector<SeriesDescription> ReplaySeries(bool has_truth) {
  std::vector<SeriesDescription> series = LandingSeries();
  if (has_truth) series.push_back({"error", "px", "Error"});
  return series;
}

std::vector<OverlayLayer> ReplayLayers() {
  std::vector<OverlayLayer> layers = LandingLayers();
  layers.push_back(OverlayLayer::kSecond);
  return layers;
}

// What the second run found, told apart from the first by its layer.
void AddSecondShapes(const LandingView& view, const LandingObservation& observation,
                     std::vector<OverlayShape>* shapes) {
  for (OverlayShape& shape : LandingShapes(view, observation)) {
    if (shape.layer == OverlayLayer::kPrediction) continue;
    shape.layer = OverlayLayer::kSecond;
    if (!shape.label.empty()) shape.label = "second: " + shape.label;
    shapes->push_back(std::move(shape));
  }
}

}  // namespace

void MarkByTrack(std::vector<ReplayFrame>* frames) {
  const auto is_found = [](const ReplayFrame& frame) {
    return frame.observation.report.detection.has_value();
  };
  const auto first = std::find_if(frames->begin(), frames->end(), is_found);
  const auto last = std::find_if(frames->rbegin(), frames->rend(), is_found).base();
  for (auto frame = first; frame < last; ++frame) {
    const bool is_false = frame->observation.fate == MeasurementFate::kFarFromTrack;
    frame->mark = !is_found(*frame) ? FrameMark::kLost
                  : is_false        ? FrameMark::kFalse
                                    : FrameMark::kFound;
  }
}

ReplayConsole::ReplayConsole(const ConsoleOptions& options, const std::string& title,
                             const LandingPipelineOptions& used, bool has_truth,
                             std::optional<ColorSource> colors)
    : used_(used),
      has_truth_(has_truth),
      feed_({.title = title,
             .is_live = false,
             .series = ReplaySeries(has_truth),
             .layers = ReplayLayers(),
             .views = LandingImageViews(),
             .offers = {ConsoleCommandKind::kPlay, ConsoleCommandKind::kSeek,
                        ConsoleCommandKind::kStep, ConsoleCommandKind::kDetect,
                        ConsoleCommandKind::kCancel, ConsoleCommandKind::kCalibrate,
                        ConsoleCommandKind::kCalibrateCancel, ConsoleCommandKind::kCalibrateSave},
             .has_exports = true,
             .has_colors = colors.has_value()}),
      server_(options, &feed_) {
  if (colors) colors_.emplace(*std::move(colors), &feed_);
}

void ReplayConsole::Play(ReplayResult first, ReadFrame read, Detect detect,
                         const std::function<bool()>& is_stopped) {
  view_ = std::move(first.view);
  frames_ = std::move(first.frames);
  table_ = std::move(first.table);
  read_ = std::move(read);
  detect_ = std::move(detect);
  SendTimeline();
  feed_.Add(ReplayOptions(used_));
  if (tools_.calibrate) calibration_.emplace(tools_, frames_.size(), &feed_);
  Time last = Now();
  while (!is_stopped()) {
    while (const auto command = feed_.TakeCommand()) Obey(*command);
    FollowSecondRun();
    if (calibration_) calibration_->Follow();
    if (const auto pending = feed_.TakeExport()) pending->answer(MakeExport(pending->request));
    const Time now = Now();
    // With nobody there to see it the recording waits.
    if (feed_.IsWatched()) Advance(now - last);
    last = now;
    if (!is_shown_) ShowFrame();
    std::this_thread::sleep_for(kLookInterval);
  }
}

void ReplayConsole::Obey(const ConsoleCommand& command) {
  switch (command.kind) {
    case ConsoleCommandKind::kPlay:
      speed_ = std::clamp(command.value, -kMaxSpeed, kMaxSpeed);
      if (speed_ > 0 && frame_ + 1 == frames_.size()) GoTo(0);
      is_shown_ = false;  // the speed is told with the frame
      return;
    case ConsoleCommandKind::kSeek:
      return GoTo(NearestFrame(command.value));
    case ConsoleCommandKind::kStep: {
      const auto last = static_cast<double>(frames_.size() - 1);
      speed_ = 0;
      return GoTo(static_cast<std::size_t>(
          std::clamp(static_cast<double>(frame_) + command.value, 0.0, last)));
    }
    case ConsoleCommandKind::kDetect:
      return StartSecondRun(command.settings);
    case ConsoleCommandKind::kCancel:
      if (second_run_.Cancel()) TellSecondRun(SecondRunState::kCancelled);
      return;
    case ConsoleCommandKind::kCalibrate:
    case ConsoleCommandKind::kCalibrateCancel:
    case ConsoleCommandKind::kCalibrateSave:
      if (calibration_) calibration_->Obey(command);
      return;
    case ConsoleCommandKind::kRecord:
    case ConsoleCommandKind::kSnapshot:
      return;  // not offered
  }
}

void ReplayConsole::StartSecondRun(const std::vector<std::string>& settings) {
  second_run_.Cancel();
  second_.reset();
  is_shown_ = false;
  settings_ = settings;
  LandingPipelineOptions options;
  try {
    options = WithSettings(used_, settings);
  } catch (const InputError& error) {
    return TellSecondRun(SecondRunState::kFailed, error.what());
  }
  second_run_.Start("second run", [this, options](const SecondRun::GoOn& go_on) {
    return detect_(options, go_on);
  });
  TellSecondRun(SecondRunState::kRunning);
}

void ReplayConsole::FollowSecondRun() {
  if (auto outcome = second_run_.TakeOutcome()) return EndSecondRun(*std::move(outcome));
  if (second_run_.is_running() && Now() - told_ > kTellInterval) {
    TellSecondRun(SecondRunState::kRunning);
  }
}

void ReplayConsole::EndSecondRun(SecondRun::Outcome outcome) {
  if (!outcome.result) return TellSecondRun(SecondRunState::kFailed, outcome.error);
  if (outcome.result->frames.size() != frames_.size()) {
    return TellSecondRun(SecondRunState::kFailed, "the recording has changed meanwhile");
  }
  second_ = std::move(outcome.result);
  is_shown_ = false;
  TellSecondRun(SecondRunState::kDone);
}

void ReplayConsole::TellSecondRun(SecondRunState state, const std::string& error) {
  told_ = Now();
  ConsoleSecondRun run{state, settings_, second_run_.done(), error, {}};
  if (second_) {
    for (const ReplayFrame& frame : second_->frames) run.marks.push_back(frame.mark);
  }
  feed_.Add(std::move(run));
}

// At the ends it holds.
void ReplayConsole::Advance(Duration elapsed) {
  if (speed_ == 0) return;
  const double end_s = SecondsOf(frames_.size() - 1);
  position_s_ = std::clamp(position_s_ + speed_ * ToSeconds(elapsed), 0.0, end_s);
  const std::size_t frame = NearestFrame(position_s_);
  if (frame != frame_) is_shown_ = false;
  frame_ = frame;
  if (position_s_ > 0 && position_s_ < end_s) return;
  speed_ = 0;
  is_shown_ = false;
}

void ReplayConsole::GoTo(std::size_t frame) {
  frame_ = frame;
  position_s_ = SecondsOf(frame);
  is_shown_ = false;
}

double ReplayConsole::SecondsOf(std::size_t frame) const {
  return ToSeconds(frames_[frame].observation.time - frames_.front().observation.time);
}

std::size_t ReplayConsole::NearestFrame(double seconds) const {
  const auto is_before = [&](const ReplayFrame& frame, double time_s) {
    return ToSeconds(frame.observation.time - frames_.front().observation.time) < time_s;
  };
  const auto later = std::lower_bound(frames_.begin(), frames_.end(), seconds, is_before);
  const auto index = static_cast<std::size_t>(later - frames_.begin());
  if (index == 0) return 0;
  if (index == frames_.size()) return index - 1;
  return SecondsOf(index) - seconds < seconds - SecondsOf(index - 1) ? index : index - 1;
}

void ReplayConsole::ShowFrame() {
  is_shown_ = true;
  const ReplayFrame& frame = frames_[frame_];
  ConsoleSample sample = LandingSample(frame.observation);
  if (has_truth_) sample.values.push_back(frame.error_px.value_or(std::nan("")));
  feed_.Add(std::move(sample));
  feed_.Add(LandingMap(*view_, frame.observation));
  feed_.Add(LandingStatus(frame.observation));
  feed_.Add(ConsolePlayback{frame_, speed_});
  picture_.captured = frame.observation.time;
  picture_.shapes = ShapesOf(frame_);
  try {
    picture_.image = read_(frame_);
  } catch (const InputError& error) {  // its file is gone
    speed_ = 0;
    feed_.Add(ConsoleEvent{frame.observation.time, EventLevel::kError, error.what()});
    return;
  }
  feed_.SetFrame(&picture_);
}

std::vector<OverlayShape> ReplayConsole::ShapesOf(std::size_t frame) const {
  std::vector<OverlayShape> shapes = LandingShapes(*view_, frames_[frame].observation);
  if (second_) AddSecondShapes(second_->view, second_->frames[frame].observation, &shapes);
  return shapes;
}

// Without content where there is none.
ExportAnswer ReplayConsole::MakeExport(const ExportRequest& request) const {
  if (IsOfColors(request)) return {};  // there are none: else that page would answer
  if (request.kind == ExportRequest::Kind::kDetections) {
    const std::string table = request.number == 1 ? table_ : second_ ? second_->table : "";
    return {table, "text/csv; charset=utf-8", fmt::format("detections-{}.csv", request.number)};
  }
  if (request.kind == ExportRequest::Kind::kCalibration) {
    return calibration_ ? calibration_->File(request.number) : ExportAnswer();
  }
  if (request.number >= frames_.size()) return {};
  const bool has_shapes = request.kind == ExportRequest::Kind::kOverlays;
  const std::string name = fmt::format("{}-{}.png", has_shapes ? "overlays" : "frame",
                                       ToNanoseconds(frames_[request.number].observation.time));
  try {
    const cv::Mat image = read_(request.number);
    return {PngOf(has_shapes ? WithShapes(image, ShapesOf(request.number)) : image), "image/png",
            name};
  } catch (const InputError&) {  // its file is gone
    return {};
  }
}

void ReplayConsole::SendTimeline() {
  ConsoleTimeline timeline;
  timeline.begin = frames_.front().observation.time;
  for (const ReplayFrame& frame : frames_) {
    timeline.times.push_back(frame.observation.time - timeline.begin);
    timeline.marks.push_back(frame.mark);
  }
  feed_.Add(std::move(timeline));
}

}  // namespace kestrel
