// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/camera/camera_console.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <thread>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "kestrel/app/console/camera/picture_quality.h"
#include "kestrel/app/console/console_page.h"
#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

constexpr Duration kWait = std::chrono::milliseconds(20);
constexpr Duration kRetry = std::chrono::seconds(1);
constexpr Duration kAgeInterval = std::chrono::milliseconds(250);
constexpr Duration kMeasurement = std::chrono::milliseconds(500);

ConsoleFeed::Description DescriptionOf(const std::string& title) {
  return {.title = title,
          .is_live = true,
          .series = {{"rate", "Hz", "Rate"},
                     {"exposure", "ms", "Exposure"},
                     {"brightness", "%", "Brightness"},
                     {"clipped", "%", "Clipped"},
                     {"sharpness", "", "Sharpness"},
                     {"best_sharpness", "", "Sharpest so far"}},
          .layers = {OverlayLayer::kDetection},
          .views = {},
          .offers = {ConsoleCommandKind::kRecord, ConsoleCommandKind::kSnapshot,
                     ConsoleCommandKind::kLens}};
}

}  // namespace

CameraConsole::CameraConsole(const std::optional<ConsoleOptions>& page, Camera camera,
                             const std::string& folder,
                             const LandingPatternDetectorOptions& detector)
    : camera_(std::move(camera)),
      feed_(DescriptionOf(camera_.name)),
      lens_({camera_.name, folder, detector}, &feed_),
      source_(camera_.source),
      reported_{.state = "opening", .reason = "waits for the first picture"},
      measured_(Now()) {
  if (page) server_.emplace(ServeConsole(*page, &feed_));
  feed_.Add(reported_);
}

void CameraConsole::Play(const std::function<bool()>& is_stopped) {
  while (!is_stopped()) {
    while (const auto command = feed_.TakeCommand()) Obey(*command);
    if (source_ == nullptr) {
      Open();
    } else {
      Watch();
    }
    lens_.Follow();
    ReportState();
    ReportAge();
  }
}

void CameraConsole::Obey(const ConsoleCommand& command) {
  try {
    if (command.kind == ConsoleCommandKind::kRecord) {
      Report(EventLevel::kInfo, camera_.record(command.value != 0));
    } else if (command.kind == ConsoleCommandKind::kSnapshot) {
      Report(EventLevel::kInfo, Snapshot());
    } else {
      lens_.Obey(command);
    }
  } catch (const InputError& error) {
    Report(EventLevel::kError, error.what());
  }
}

std::string CameraConsole::Snapshot() const {
  if (frame_.image.empty()) return "no snapshot: there is no image yet";
  return camera_.keep_snapshot(frame_.image, frame_.captured);
}

void CameraConsole::Open() {
  if (Now() < next_attempt_) return std::this_thread::sleep_for(kWait);
  try {
    source_ = camera_.open();
    measured_ = Now();
  } catch (const InputError& error) {
    SetFault(error.what());
    next_attempt_ = Now() + kRetry;
  }
}

void CameraConsole::Watch() {
  const std::optional<Event> event = source_->Next(kWait);
  if (event && std::holds_alternative<EndOfStream>(*event)) {
    source_ = nullptr;  // a recorded source begins again
    return;
  }
  const Frame* const frame = event ? std::get_if<Frame>(&*event) : nullptr;
  if (frame != nullptr) Take(*frame);
  SetFault(source_->error());
}

void CameraConsole::Take(const Frame& frame) {
  ++frames_;
  cv::Mat gray = frame.image;
  if (gray.channels() == 3) cv::cvtColor(frame.image, gray, cv::COLOR_BGR2GRAY);
  if (Now() - measured_ >= kMeasurement) AddSample(gray);
  lens_.Look(gray, frame.time);
  frame_.captured = frame.time;
  frame_.image = frame.image;
  frame_.shapes = lens_.shapes();
  feed_.SetFrame(&frame_);
}

void CameraConsole::AddSample(const cv::Mat& gray) {
  const Time now = Now();
  const double rate_hz = frames_ / ToSeconds(now - measured_);
  const PictureQuality quality = MeasurePicture(gray);
  best_sharpness_ = std::max(best_sharpness_, quality.sharpness);
  const double exposure_s = camera_.exposure_s().value_or(std::numeric_limits<double>::quiet_NaN());
  feed_.Add(ViewSample{now,
                       {rate_hz, 1e3 * exposure_s, quality.brightness, quality.clipped,
                        quality.sharpness, best_sharpness_}});
  measured_ = now;
  frames_ = 0;
}

// The page shows nothing old as what is now.
void CameraConsole::ReportAge() {
  const Time now = Now();
  if (now - aged_ < kAgeInterval) return;
  aged_ = now;
  std::optional<Duration> age;
  if (!frame_.image.empty()) age = now - frame_.captured;
  feed_.Add(ConsoleSources{now, {{ValueSource::kFrames, age}}});
}

void CameraConsole::SetFault(const std::string& fault) {
  if (fault == fault_) return;
  fault_ = fault;
  if (!fault.empty()) camera_.notify("trying again: " + fault);
}

void CameraConsole::ReportState() {
  if (fault_.empty() && frame_.image.empty()) return;  // not open yet
  const ViewStatus status{.state = fault_.empty() ? "live" : "no picture",
                          .reason = fault_.empty() ? "" : "trying again: " + fault_,
                          .is_recording = camera_.is_recording()};
  if (status == reported_) return;
  reported_ = status;
  feed_.Add(status);
}

}  // namespace kestrel
