// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/replay/recording_player.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "kestrel/app/console/replay/frame_picture.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/codec/png_codec.h"

namespace kestrel {
namespace {

// Interval of the reports on a second run's progress.
constexpr Duration kSendInterval = std::chrono::milliseconds(250);

std::vector<SeriesDescription> ReplaySeries(const ReplaySubject& subject) {
  std::vector<SeriesDescription> series = subject.series;
  if (subject.has_truth) series.push_back({"error", "px", "Error", {ValueSource::kFrames}});
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

// The times since the first frame.
std::vector<Duration> TimesOf(const ReplayResult& run) {
  std::vector<Duration> times;
  for (const ReplayFrame& frame : run.frames) times.push_back(frame.time - run.frames.front().time);
  return times;
}

}  // namespace

ConsoleFeed::Description DescriptionOf(const std::string& title, const ReplaySubject& subject) {
  return {
      .title = title,
      .is_live = false,
      .series = ReplaySeries(subject),
      .layers = ReplayLayers(subject),
      .views = subject.views,
      .offers = {ConsoleCommandKind::kPlay, ConsoleCommandKind::kSeek, ConsoleCommandKind::kStep,
                 ConsoleCommandKind::kDetect, ConsoleCommandKind::kCancel},
      .has_exports = true};
}

RecordingPlayer::RecordingPlayer(const ReplaySubject& subject, ReplayResult first,
                                 Recording recording, ConsoleFeed* feed)
    : has_truth_(subject.has_truth),
      feed_(feed),
      recording_(std::move(recording)),
      read_(recording_.open()),
      first_(std::make_shared<const ReplayResult>(std::move(first))),
      playhead_(TimesOf(*first_)),
      clips_(feed) {
  playhead_.Step(static_cast<double>(FirstFound(first_->frames)));
  SendTimeline();
  SendSeries();
  feed_->Add(subject.options);
  feed_->Add(ConsoleLog{recording_.autopilot.events});
}

void RecordingPlayer::Obey(const ConsoleCommand& command) {
  switch (command.kind) {
    case ConsoleCommandKind::kPlay:
      is_shown_ = false;  // the speed is sent with the frame
      return playhead_.Play(command.value);
    case ConsoleCommandKind::kSeek:
      is_shown_ = false;
      return playhead_.Seek(command.value);
    case ConsoleCommandKind::kStep:
      is_shown_ = false;
      return playhead_.Step(command.value);
    case ConsoleCommandKind::kDetect:
      // Settings that are not valid end the run.
      return StartSecondRun(command.settings,
                            [detect = recording_.detect, settings = command.settings](
                                const SecondRun::GoOn& go_on) { return detect(settings)(go_on); });
    case ConsoleCommandKind::kCancel:
      if (second_run_.Cancel()) SendSecondRun(SecondRunState::kCancelled);
      return;
    default:
      return;  // others execute it
  }
}

void RecordingPlayer::Seek(Time time) {
  is_shown_ = false;
  playhead_.Seek(ToSeconds(time - first_->frames.front().time));
}

void RecordingPlayer::Follow() {
  FollowSecondRun();
  clips_.Follow();
  const Time now = Now();
  // The recording waits while nobody looks.
  if (feed_->IsWatched() && playhead_.Advance(now - played_)) is_shown_ = false;
  played_ = now;
  if (!is_shown_) ShowFrame();
}

void RecordingPlayer::StartSecondRun(const std::vector<std::string>& settings, SecondRun::Job job) {
  second_.reset();
  is_shown_ = false;
  settings_ = settings;
  second_run_.Start("second run", std::move(job));
  SendSecondRun(SecondRunState::kRunning);
}

void RecordingPlayer::FollowSecondRun() {
  if (auto outcome = second_run_.TakeOutcome()) return EndSecondRun(*std::move(outcome));
  if (second_run_.is_running() && Now() - reported_ > kSendInterval) {
    SendSecondRun(SecondRunState::kRunning);
  }
}

void RecordingPlayer::EndSecondRun(SecondRun::Outcome outcome) {
  if (!outcome.result) return SendSecondRun(SecondRunState::kFailed, outcome.error);
  if (outcome.result->frames.size() != first_->frames.size()) {
    return SendSecondRun(SecondRunState::kFailed, "the recording has changed meanwhile");
  }
  second_ = std::make_shared<const ReplayResult>(*std::move(outcome.result));
  is_shown_ = false;
  SendSecondRun(SecondRunState::kDone);
}

void RecordingPlayer::SendSecondRun(SecondRunState state, const std::string& error) {
  reported_ = Now();
  ConsoleSecondRun run{state, settings_, second_run_.done(), error, {}};
  if (second_) {
    for (const ReplayFrame& frame : second_->frames) run.marks.push_back(frame.mark);
  }
  feed_->Add(std::move(run));
}

void RecordingPlayer::ShowFrame() {
  is_shown_ = true;
  SendFrame();
  const std::size_t index = playhead_.frame();
  picture_.captured = first_->frames[index].time;
  picture_.shapes = ShapesOf(*first_, second_.get(), index);
  try {
    picture_.image = read_(index);
  } catch (const InputError& error) {  // it cannot be read, or its file is gone
    feed_->Add(SessionEvent{picture_.captured, EventLevel::kError, error.what()});
    constexpr int kWidth_px = 640, kHeight_px = 480;
    const cv::Size size =
        picture_.image.empty() ? cv::Size(kWidth_px, kHeight_px) : picture_.image.size();
    picture_.image = cv::Mat::zeros(size, CV_8UC1);
  }
  feed_->SetFrame(&picture_);
}

// Sends everything that belongs to the picture.
void RecordingPlayer::SendFrame() {
  const std::size_t index = playhead_.frame();
  const ReplayFrame& frame = first_->frames[index];
  feed_->Add(ViewSample{frame.time, ValuesOf(frame)});
  ViewMap map = frame.map;
  for (const MapEntry& entry : first_->map) {
    if (entry.since <= frame.time) map.mapped.push_back(entry.object);
  }
  feed_->Add(std::move(map));
  feed_->Add(frame.status);
  if (!recording_.autopilot.states.empty()) feed_->Add(recording_.autopilot.At(frame.time));
  ConsoleFindings findings{index, {frame.facts}};
  if (second_) findings.runs.push_back(second_->frames[index].facts);
  feed_->Add(std::move(findings));
  feed_->Add(ConsolePlayback{index, playhead_.speed()});
}

void RecordingPlayer::AnswerExport(const PendingExport& pending) {
  const ExportRequest& request = pending.request;
  if (IsClip(request) && request.last < first_->frames.size()) {
    return clips_.Make(pending, ClipOf(request));
  }
  pending.answer(MakeExport(request));
}

// Returns an answer without content when there is no such file.
ExportAnswer RecordingPlayer::MakeExport(const ExportRequest& request) const {
  // The pages of colours and of calibrations answer those.
  if (IsOfColors(request) || request.kind == ExportRequest::Kind::kCalibration) return {};
  if (request.kind == ExportRequest::Kind::kDetections) {
    const std::string table = request.number == 1 ? first_->table : second_ ? second_->table : "";
    return {table, "text/csv; charset=utf-8", fmt::format("detections-{}.csv", request.number)};
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
Clip RecordingPlayer::ClipOf(const ExportRequest& request) const {
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

std::vector<double> RecordingPlayer::ValuesOf(const ReplayFrame& frame) const {
  std::vector<double> values = frame.sample.values;
  if (has_truth_) values.push_back(frame.error_px.value_or(std::nan("")));
  return values;
}

void RecordingPlayer::SendSeries() {
  ConsoleSeries series{TimesOf(*first_), {}};
  for (const ReplayFrame& frame : first_->frames) {
    const std::vector<double> values = ValuesOf(frame);
    series.values.resize(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) series.values[i].push_back(values[i]);
  }
  feed_->Add(std::move(series));
}

void RecordingPlayer::SendTimeline() {
  ConsoleTimeline timeline{first_->frames.front().time, TimesOf(*first_), {}};
  for (const ReplayFrame& frame : first_->frames) timeline.marks.push_back(frame.mark);
  feed_->Add(std::move(timeline));
}

}  // namespace kestrel
