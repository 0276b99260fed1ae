// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/camera_console.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <thread>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "kestrel/app/console/picture_quality.h"
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
          .offers = {ConsoleCommandKind::kSnapshot, ConsoleCommandKind::kLens}};
}

}  // namespace

CameraConsole::CameraConsole(const ConsoleOptions& options, Camera camera,
                             const std::string& folder,
                             const LandingPatternDetectorOptions& detector)
    : camera_(std::move(camera)),
      feed_(DescriptionOf(camera_.name)),
      server_(options, &feed_),
      lens_({camera_.name, folder, detector}, &feed_) {
  feed_.Add(ConsoleStatus{.state = "opening", .reason = "waits for the first picture"});
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
    TellAge();
  }
}

void CameraConsole::Obey(const ConsoleCommand& command) {
  if (command.kind == ConsoleCommandKind::kSnapshot) return Snapshot();
  lens_.Obey(command);
}

void CameraConsole::Snapshot() {
  const auto say = [&](EventLevel level, const std::string& text) {
    feed_.Add(SessionEvent{Now(), level, text});
  };
  if (frame_.image.empty()) return say(EventLevel::kWarning, "no snapshot: there is no image yet");
  try {
    say(EventLevel::kInfo, camera_.keep_snapshot(frame_.image, frame_.captured));
  } catch (const InputError& error) {
    say(EventLevel::kError, error.what());
  }
}

void CameraConsole::Open() {
  if (Now() < next_attempt_) return std::this_thread::sleep_for(kWait);
  try {
    source_ = camera_.open();
    measured_ = Now();
  } catch (const InputError& error) {
    TellState(error.what());
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
  TellState(source_->error());
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
  feed_.Add(ConsoleSample{now,
                          {rate_hz, 1e3 * exposure_s, quality.brightness, quality.clipped,
                           quality.sharpness, best_sharpness_}});
  measured_ = now;
  frames_ = 0;
}

// The page shows nothing old as what is now.
void CameraConsole::TellAge() {
  const Time now = Now();
  if (now - aged_ < kAgeInterval) return;
  aged_ = now;
  std::optional<Duration> age;
  if (!frame_.image.empty()) age = now - frame_.captured;
  feed_.Add(ConsoleSources{now, {{ConsoleSource::kFrames, age}}});
}

void CameraConsole::TellState(const std::string& fault) {
  if (fault.empty() && frame_.image.empty()) return;  // not open yet
  if (fault == fault_) return;
  fault_ = fault;
  const std::string reason = fault.empty() ? "" : "trying again: " + fault;
  if (!fault.empty()) camera_.tell(reason);
  feed_.Add(ConsoleStatus{.state = fault.empty() ? "live" : "no picture", .reason = reason});
}

}  // namespace kestrel
