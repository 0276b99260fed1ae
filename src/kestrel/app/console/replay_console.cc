// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/replay_console.h"

#include <cmath>
#include <thread>

#include <fmt/format.h>

#include "kestrel/app/console/frame_picture.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/codec/png_codec.h"

namespace kestrel {
namespace {

// Interval of the checks for requests, and the shortest between two pictures.
constexpr Duration kLookInterval = std::chrono::milliseconds(20);
// Interval of the reports on a second run's progress.
constexpr Duration kTellInterval = std::chrono::milliseconds(250);

std::vector<SeriesDescription> ReplaySeries(const ReplaySubject& subject) {
  std::vector<SeriesDescription> series = subject.series;
  if (subject.has_truth) series.push_back({"error", "px", "Error"});
  return series;
}

std::vector<OverlayLayer> ReplayLayers(const ReplaySubject& subject) {
  std::vector<OverlayLayer> layers = subject.layers;
  if (subject.has_truth) layers.push_back(OverlayLayer::kTruth);
  layers.push_back(OverlayLayer::kSecond);
  return layers;
}

// Frames per second between two frames.
double RateOf(const ReplayResult& run, std::size_t first, std::size_t last) {
  const Duration time = run.frames[last].time - run.frames[first].time;
  return time > Duration::zero() ? static_cast<double>(last - first) / ToSeconds(time) : 1;
}

}  // namespace

ReplayConsole::ReplayConsole(const ConsoleOptions& options, const std::string& title,
                             ReplaySubject subject, std::optional<ColorSource> colors)
    : subject_(std::move(subject)),
      feed_({.title = title,
             .is_live = false,
             .series = ReplaySeries(subject_),
             .layers = ReplayLayers(subject_),
             .views = subject_.views,
             .offers = {ConsoleCommandKind::kPlay, ConsoleCommandKind::kSeek,
                        ConsoleCommandKind::kStep, ConsoleCommandKind::kDetect,
                        ConsoleCommandKind::kCancel, ConsoleCommandKind::kCalibrate,
                        ConsoleCommandKind::kCalibrateCancel, ConsoleCommandKind::kCalibrateSave},
             .has_exports = true,
             .has_colors = colors.has_value()}),
      server_(options, &feed_),
      clips_(&feed_) {
  if (colors) colors_.emplace(*std::move(colors), &feed_);
}

void ReplayConsole::Play(ReplayResult first, Recording recording,
                         const std::function<bool()>& is_stopped) {
  first_ = std::make_shared<const ReplayResult>(std::move(first));
  recording_ = std::move(recording);
  read_ = recording_.open();
  playhead_.emplace(FrameTimes());
  playhead_->Step(static_cast<double>(FirstFound(first_->frames)));
  SendTimeline();
  feed_.Add(subject_.options);
  if (tools_.calibrate) calibration_.emplace(tools_, first_->frames.size(), &feed_);
  Time last = Now();
  while (!is_stopped()) {
    while (const auto command = feed_.TakeCommand()) Obey(*command);
    FollowSecondRun();
    clips_.Follow();
    if (calibration_) calibration_->Follow();
    if (const auto pending = feed_.TakeExport()) AnswerExport(*pending);
    const Time now = Now();
    // The recording waits while nobody looks.
    if (feed_.IsWatched() && playhead_->Advance(now - last)) is_shown_ = false;
    last = now;
    if (!is_shown_) ShowFrame();
    std::this_thread::sleep_for(kLookInterval);
  }
}

void ReplayConsole::Obey(const ConsoleCommand& command) {
  switch (command.kind) {
    case ConsoleCommandKind::kPlay:
      is_shown_ = false;  // the speed is sent with the frame
      return playhead_->Play(command.value);
    case ConsoleCommandKind::kSeek:
      is_shown_ = false;
      return playhead_->Seek(command.value);
    case ConsoleCommandKind::kStep:
      is_shown_ = false;
      return playhead_->Step(command.value);
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
  try {
    second_run_.Start("second run", recording_.detect(settings));
  } catch (const InputError& error) {
    return TellSecondRun(SecondRunState::kFailed, error.what());
  }
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
  if (outcome.result->frames.size() != first_->frames.size()) {
    return TellSecondRun(SecondRunState::kFailed, "the recording has changed meanwhile");
  }
  second_ = std::make_shared<const ReplayResult>(*std::move(outcome.result));
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

void ReplayConsole::ShowFrame() {
  is_shown_ = true;
  TellFrame();
  const std::size_t index = playhead_->frame();
  picture_.captured = first_->frames[index].time;
  picture_.shapes = ShapesOf(*first_, second_.get(), index);
  try {
    picture_.image = read_(index);
  } catch (const InputError& error) {  // the image's file is gone
    playhead_->Hold();
    feed_.Add(SessionEvent{picture_.captured, EventLevel::kError, error.what()});
    return;
  }
  feed_.SetFrame(&picture_);
}

// Sends everything that belongs to the picture.
void ReplayConsole::TellFrame() {
  const std::size_t index = playhead_->frame();
  const ReplayFrame& frame = first_->frames[index];
  ConsoleSample sample = frame.sample;
  if (subject_.has_truth) sample.values.push_back(frame.error_px.value_or(std::nan("")));
  feed_.Add(std::move(sample));
  ConsoleMap map = frame.map;
  for (const MapEntry& entry : first_->map) {
    if (entry.since <= frame.time) map.mapped.push_back(entry.object);
  }
  feed_.Add(std::move(map));
  feed_.Add(frame.status);
  ConsoleFindings findings{index, {frame.facts}};
  if (second_) findings.runs.push_back(second_->frames[index].facts);
  feed_.Add(std::move(findings));
  feed_.Add(ConsolePlayback{index, playhead_->speed()});
}

void ReplayConsole::AnswerExport(const PendingExport& pending) {
  const ExportRequest& request = pending.request;
  if (IsClip(request) && request.last < first_->frames.size()) {
    return clips_.Make(pending, ClipOf(request));
  }
  pending.answer(MakeExport(request));
}

// Returns an answer without content when there is no such file.
ExportAnswer ReplayConsole::MakeExport(const ExportRequest& request) const {
  if (IsOfColors(request)) return {};  // without colours; otherwise the page of colours answers
  if (request.kind == ExportRequest::Kind::kDetections) {
    const std::string table = request.number == 1 ? first_->table : second_ ? second_->table : "";
    return {table, "text/csv; charset=utf-8", fmt::format("detections-{}.csv", request.number)};
  }
  if (request.kind == ExportRequest::Kind::kCalibration) {
    return calibration_ ? calibration_->File(request.number) : ExportAnswer();
  }
  if (IsClip(request) || request.number >= first_->frames.size()) return {};
  const bool has_shapes = request.kind == ExportRequest::Kind::kOverlays;
  const std::string name = fmt::format("{}-{}.png", has_shapes ? "overlays" : "frame",
                                       ToNanoseconds(first_->frames[request.number].time));
  try {
    const cv::Mat image = read_(request.number);
    if (!has_shapes) return {EncodePng(image), "image/png", name};
    return {EncodePng(WithShapes(image, ShapesOf(*first_, second_.get(), request.number))),
            "image/png", name};
  } catch (const InputError&) {  // the image's file is gone
    return {};
  }
}

// A clip with what both runs have found so far.
Clip ReplayConsole::ClipOf(const ExportRequest& request) const {
  const bool has_shapes = request.kind == ExportRequest::Kind::kOverlaysClip;
  const auto start = [open = recording_.open, first = first_, second = second_, has_shapes,
                      begin = request.number] {
    return [read = open(), first, second, has_shapes, begin](std::size_t index) {
      const std::size_t frame = begin + index;
      std::vector<OverlayShape> shapes;
      if (has_shapes) shapes = ShapesOf(*first, second.get(), frame);
      return WithShapes(read(frame), shapes);
    };
  };
  return {start, request.last - request.number + 1, RateOf(*first_, request.number, request.last),
          fmt::format("{}-{}-{}", has_shapes ? "overlays" : "clip", request.number, request.last)};
}

std::vector<Duration> ReplayConsole::FrameTimes() const {
  std::vector<Duration> times;
  for (const ReplayFrame& frame : first_->frames) {
    times.push_back(frame.time - first_->frames.front().time);
  }
  return times;
}

void ReplayConsole::SendTimeline() {
  ConsoleTimeline timeline{first_->frames.front().time, FrameTimes(), {}};
  for (const ReplayFrame& frame : first_->frames) timeline.marks.push_back(frame.mark);
  feed_.Add(std::move(timeline));
}

}  // namespace kestrel
