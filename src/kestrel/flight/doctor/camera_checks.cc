// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/doctor/camera_checks.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include <fmt/format.h>

#include "kestrel/flight/doctor/statistics.h"
#include "kestrel/flight/guidance/guidance.h"

namespace kestrel {
namespace {

constexpr std::size_t kFewestFrames = 4;
constexpr char kTooFewFrames[] = "too few images";

bool HasTooFew(const CameraObservations& camera) { return camera.frames.size() < kFewestFrames; }

std::vector<double> Intervals(const CameraObservations& camera) {
  std::vector<double> intervals;
  for (std::size_t i = 1; i < camera.frames.size(); ++i) {
    intervals.push_back(ToSeconds(camera.frames[i].stamp - camera.frames[i - 1].stamp));
  }
  return intervals;
}

// Age of what is seen just before the next image, as guidance counts it, as it is in one of fifty
// images, s.
double AgeOfSight(const CameraObservations& camera) {
  constexpr double kMostOf = 0.98;
  const double more_s = -camera.delay->offset_s - GuidanceInput::kMostVideoDelay_s;
  return QuantileOf(Intervals(camera), kMostOf) + std::max(more_s, 0.0);
}

double MedianOfQualities(const CameraObservations& camera, double ImageQuality::*value) {
  std::vector<double> values;
  for (const ImageQuality& quality : camera.qualities) values.push_back(quality.*value);
  return MedianOf(std::move(values));
}

// Returns the largest number of images in a row that repeat the one before.
int LongestFreeze(const CameraObservations& camera) {
  int longest = 0;
  int now = 0;
  for (std::size_t i = 1; i < camera.qualities.size(); ++i) {
    now = camera.qualities[i].hash == camera.qualities[i - 1].hash ? now + 1 : 0;
    longest = std::max(longest, now);
  }
  return longest;
}

}  // namespace

Finding CheckImages(const CameraObservations& camera) {
  constexpr double kShortest_s = 1;  // a camera needs some time until its first image
  const std::string check = "images";
  if (!camera.open_error.empty()) {
    return Wrong(
        check, camera.open_error,
        "the source has to open first: its name, its cable, whether another program uses it");
  }
  if (camera.frames.empty()) {
    if (camera.error.empty() && camera.duration_s < kShortest_s) {
      return NotChecked(check, "not checked yet");
    }
    const std::string error = camera.error.empty() ? "" : ": " + camera.error;
    return Wrong(check, fmt::format("none in {:.0f} s{}", camera.duration_s, error),
                 "see whether the camera delivers at all: gst-launch-1.0 SOURCE ! autovideosink");
  }
  const std::string measured = fmt::format("{} of {}x{} px in {:.1f} s", camera.frames.size(),
                                           camera.width_px, camera.height_px, camera.duration_s);
  if (camera.counters.reopened > 0) {
    return Doubtful(
        check, fmt::format("{}; the source went away {} times", measured, camera.counters.reopened),
        "cable and power supply of the camera");
  }
  return Good(check, measured);
}

Finding CheckFrameRate(const CameraObservations& camera) {
  constexpr double kGood_hz = 12;
  constexpr double kLeast_hz = 8;
  const std::string check = "frame rate";
  if (HasTooFew(camera)) return NotChecked(check, kTooFewFrames);
  const double span_s = ToSeconds(camera.frames.back().arrival - camera.frames.front().arrival);
  const double rate_hz = static_cast<double>(camera.frames.size() - 1) / std::max(span_s, 1e-6);
  const std::string measured = fmt::format("{:.1f} images/s", rate_hz);
  const std::string advice =
      "20 or more: a smaller image, a shorter exposure, another format (fly.camera.device_caps), "
      "USB 3 instead of 2; a moving target is lost below 8";
  if (rate_hz < kLeast_hz) return Wrong(check, measured, advice);
  if (rate_hz < kGood_hz) return Doubtful(check, measured, advice);
  return Good(check, measured);
}

// Missing images are not jitter: an interval counts by its distance from the nearest multiple of
// the median interval.
Finding CheckSteadiness(const CameraObservations& camera) {
  constexpr double kMost = 0.3;
  constexpr double kMostOf = 0.9;
  const std::string check = "steadiness";
  if (HasTooFew(camera)) return NotChecked(check, kTooFewFrames);
  const double period_s = MedianOf(Intervals(camera));
  if (!(period_s > 0)) return NotChecked(check, "the times of the images do not rise");
  std::vector<double> deviations;
  for (const double interval_s : Intervals(camera)) {
    const double periods = std::max(std::round(interval_s / period_s), 1.0);
    deviations.push_back(std::abs(interval_s - periods * period_s));
  }
  const double jitter_s = QuantileOf(std::move(deviations), kMostOf);
  const std::string measured = fmt::format("{:.1f} ms of jitter in {:.1f} ms, 9 of 10 images",
                                           kMilliseconds * jitter_s, kMilliseconds * period_s);
  if (jitter_s <= kMost * period_s) return Good(check, measured);
  return Doubtful(check, measured,
                  "the times are perhaps those of arrival: a driver that stamps (V4L2, libcamera), "
                  "no network in between, a fixed exposure");
}

Finding CheckMissedFrames(const CameraObservations& camera) {
  constexpr double kMany = 0.3;
  constexpr double kMost = 0.7;
  const std::string check = "missed images";
  if (HasTooFew(camera)) return NotChecked(check, kTooFewFrames);
  const double all = static_cast<double>(camera.counters.captured + camera.counters.missed);
  const double share = static_cast<double>(camera.counters.missed) / std::max(all, 1.0);
  const std::string measured =
      fmt::format("{} of {:.0f}, {:.0f} %", camera.counters.missed, all, kPercent * share);
  const std::string advice = "the computer or the line does not keep up: ask for fewer images";
  if (share > kMost) return Wrong(check, measured, advice);
  if (share > kMany) return Doubtful(check, measured, advice);
  return Good(check, measured);
}

Finding CheckFrozenFrames(const CameraObservations& camera) {
  constexpr int kLongest = 3;
  constexpr double kMost = 0.5;
  const std::string check = "frozen images";
  if (camera.qualities.size() < kFewestFrames) return NotChecked(check, kTooFewFrames);
  const auto same = [&](std::size_t i) {
    return camera.qualities[i].hash == camera.qualities[i - 1].hash;
  };
  int repeated = 0;
  for (std::size_t i = 1; i < camera.qualities.size(); ++i) repeated += same(i) ? 1 : 0;
  const int longest = LongestFreeze(camera);
  const std::string measured = fmt::format("{} of {} are the one before again, {} in a row",
                                           repeated, camera.qualities.size(), longest);
  const std::string advice =
      "the camera or a converter repeats images with new times: no videorate, no still picture, "
      "no virtual camera";
  if (repeated > kMost * static_cast<double>(camera.qualities.size())) {
    return Wrong(check, measured, advice);
  }
  return longest >= kLongest ? Doubtful(check, measured, advice)
                             : Good(check, fmt::format("{} repeated", repeated));
}

Finding CheckCaptureClock(const CameraObservations& camera) {
  constexpr double kJump_s = 0.3;
  constexpr double kFuture_s = -0.02;
  constexpr double kOld_s = 0.25;
  constexpr double kTooOld_s = 0.6;
  const std::string check = "capture clock";
  if (HasTooFew(camera)) return NotChecked(check, kTooFewFrames);
  std::vector<double> ages;
  for (const FrameSample& frame : camera.frames) {
    ages.push_back(ToSeconds(frame.arrival - frame.stamp));
  }
  double largest_jump_s = 0;
  for (std::size_t i = 1; i < ages.size(); ++i) {
    largest_jump_s = std::max(largest_jump_s, std::abs(ages[i] - ages[i - 1]));
  }
  const std::vector<double> intervals = Intervals(camera);
  const auto back = std::ranges::count_if(intervals, [](double s) { return s <= 0; });
  const std::string clock_advice =
      "the images have to be timed by one steady clock (CLOCK_MONOTONIC): a driver's, not that of "
      "a network or of the time of day";
  if (back > 0) {
    return Wrong(check, fmt::format("the times went back or stood still {} times", back),
                 clock_advice);
  }
  const double age_s = MedianOf(ages);
  if (largest_jump_s > kJump_s) {
    return Wrong(check, fmt::format("the times jumped by {:.2f} s", largest_jump_s), clock_advice);
  }
  const std::string measured =
      fmt::format("images arrive {:.0f} ms after they were taken", kMilliseconds * age_s);
  if (age_s < kFuture_s) return Wrong(check, measured, clock_advice);
  const std::string age_advice =
      "less buffering: no queue, no compression in between, appsink with drop; and a recording of "
      "one flight for kestrel calibrate clock";
  if (age_s > kTooOld_s) return Wrong(check, measured, age_advice);
  if (age_s > kOld_s) return Doubtful(check, measured, age_advice);
  if (camera.counters.untimed > 0) {
    return Doubtful(check,
                    fmt::format("{} images without a time of their own", camera.counters.untimed),
                    "they get that of their arrival: measure the rest by kestrel calibrate clock");
  }
  return Good(check, measured);
}

Finding CheckVideoDelay(const CameraObservations& camera, const DoctorUse& use) {
  constexpr double kLateForMoving_s = 0.3;
  constexpr double kTooLate_s = 0.6;
  constexpr double kError_m = 0.05;
  const std::string check = "video delay";
  if (!camera.delay) {
    return NotChecked(check, "not known: the UAV has not turned enough",
                      "turn and tilt it for 10 s, faster than 10 deg/s, over ground with texture");
  }
  const double late_s = -camera.delay->offset_s;
  const std::string measured = fmt::format("{:.0f} ms late, +- {:.0f} ms", kMilliseconds * late_s,
                                           kMilliseconds * camera.delay->sigma_s);
  const std::string advice =
      "less latency: a lower resolution, no B-frames and a short interval of key frames in the "
      "camera, UDP, a wired link; docs/camera.md";
  if (late_s > kTooLate_s) return Wrong(check, measured, advice);
  if (use.guides && !HasTooFew(camera) && AgeOfSight(camera) > use.sight_s) {
    return Doubtful(
        check,
        fmt::format("{}: {:.1f} s from one image to the next beyond that, near the deck "
                    "guidance climbs after {:g} s",
                    measured, AgeOfSight(camera), use.sight_s),
        "fewer lost packets, key frames more often, fly.guidance.sight_s up to 1; " + advice);
  }
  if (!use.target_mps) return Good(check, measured);
  const double error_m = *use.target_mps * camera.delay->sigma_s;
  if (late_s > kLateForMoving_s || error_m > kError_m) {
    return Doubtful(
        check,
        fmt::format("{}: {:.2f} m for a target at {:.1f} m/s", measured, error_m, *use.target_mps),
        advice);
  }
  return Good(check, measured);
}

Finding CheckExposure(const CameraObservations& camera) {
  constexpr double kDark = 50;
  constexpr double kDim = 90;
  constexpr double kMuchSaturated = 0.15;
  constexpr double kSaturated = 0.03;
  const std::string check = "exposure";
  if (camera.qualities.empty()) return NotChecked(check, kTooFewFrames);
  const double bright = MedianOfQualities(camera, &ImageQuality::bright_gray);
  const double mean = MedianOfQualities(camera, &ImageQuality::mean_gray);
  const double saturated = MedianOfQualities(camera, &ImageQuality::saturated_share);
  const std::string measured = fmt::format("mean {:.0f}, brightest {:.0f} of 255, {:.1f} % white",
                                           mean, bright, kPercent * saturated);
  const std::string darker =
      "shorter exposure or less gain, so that white paper is at 200 to 240 "
      "(fly.control_exposure=true does it)";
  const std::string brighter =
      "longer exposure (up to 5 ms) or more gain: is the cap off, the iris "
      "open? (fly.control_exposure=true does it)";
  if (saturated > kMuchSaturated) return Wrong(check, measured + ": saturated", darker);
  if (bright < kDim && camera.is_on_ground) {
    return NotChecked(check, measured + ": dark, as it is below a UAV that stands",
                      "lift it above the pattern, 1 m or more");
  }
  if (bright < kDark) return Wrong(check, measured + ": dark", brighter);
  if (saturated > kSaturated) return Doubtful(check, measured + ": saturated", darker);
  if (bright < kDim) return Doubtful(check, measured + ": dim", brighter);
  return Good(check, measured);
}

Finding CheckFocus(const CameraObservations& camera) {
  constexpr double kSoft_px = 3.5;
  constexpr double kBlurred_px = 5;
  const std::string check = "focus";
  std::vector<double> edges;
  for (const ImageQuality& quality : camera.qualities) {
    if (quality.edge_px) edges.push_back(*quality.edge_px);
  }
  if (edges.size() < kFewestFrames || 2 * edges.size() < camera.qualities.size()) {
    return NotChecked(check, "no strong edges in view",
                      "lay the pattern, or a page of text, where the camera sees it");
  }
  const double edge_px = MedianOf(std::move(edges));
  const std::string measured = fmt::format("sharp edges are {:.1f} px wide", edge_px);
  const std::string advice =
      "turn the lens until edges at 5 m are less than 3 px wide, fix it, "
      "calibrate again; in flight: a shorter exposure, a softer mount";
  if (edge_px > kBlurred_px) return Wrong(check, measured + ": blurred", advice);
  if (edge_px > kSoft_px) return Doubtful(check, measured + ": soft", advice);
  return Good(check, measured);
}

std::vector<Finding> CheckCamera(const CameraObservations& camera, const DoctorUse& use) {
  if (!camera.open_error.empty()) return {CheckImages(camera)};
  std::vector<Finding> findings = {CheckImages(camera),       CheckFrameRate(camera),
                                   CheckSteadiness(camera),   CheckMissedFrames(camera),
                                   CheckFrozenFrames(camera), CheckCaptureClock(camera),
                                   CheckExposure(camera),     CheckFocus(camera)};
  if (camera.comes_late) findings.push_back(CheckVideoDelay(camera, use));
  return findings;
}

}  // namespace kestrel
