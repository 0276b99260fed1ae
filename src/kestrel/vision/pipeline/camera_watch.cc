// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/pipeline/camera_watch.h"

#include <algorithm>
#include <chrono>

#include "kestrel/core/base/robust_statistics.h"

namespace kestrel {
namespace {

constexpr Duration kSilence = std::chrono::seconds(1);
constexpr Duration kBlindness = std::chrono::seconds(3);  // after which the track is lost, too
constexpr int kFrozenImages = 5;
constexpr int kConfirmations = 5;

}  // namespace

void CameraWatch::Set(Watched* camera, CameraHealth health, Time time) {
  const CameraHealth old = camera->state.health;
  const bool contradicts = old == CameraHealth::kContradicts || old == CameraHealth::kAlone;
  if (old == health || contradicts) return;
  camera->state = {health, time};
}

void CameraWatch::AddFrame(std::size_t camera, const cv::Mat& image, Time time) {
  if (!begin_) begin_ = time;
  Watched& own = cameras_[camera];
  own.newest = time;
  own.repeated.IsRepeated(image);
  if (own.repeated.in_a_row() >= kFrozenImages) {
    Set(&own, CameraHealth::kFrozen, time);
  } else if (own.repeated.in_a_row() == 0) {
    Set(&own, CameraHealth::kGood, time);
  }
  for (Watched& other : cameras_) {
    if (time - other.newest.value_or(*begin_) > kSilence) Set(&other, CameraHealth::kSilent, time);
  }
  UseThoseThatAreAlone(time);
}

void CameraWatch::UseThoseThatAreAlone(Time time) {
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    CameraState& state = cameras_[i].state;
    const bool is_alone = !IsSeenByOthers(i, time, kBlindness);
    if (state.health == CameraHealth::kContradicts && is_alone) {
      state = {CameraHealth::kAlone, time, state.offset_m};
    } else if (state.health == CameraHealth::kAlone && !is_alone) {
      state = {CameraHealth::kContradicts, time, state.offset_m};
    }
  }
}

bool CameraWatch::IsUsed(std::size_t camera) const {
  const Watched& own = cameras_[camera];
  return own.state.is_used() && own.repeated.in_a_row() == 0;
}

bool CameraWatch::IsJudged(std::size_t camera) const {
  const Watched& own = cameras_[camera];
  return own.repeated.in_a_row() == 0 &&
         (own.state.is_used() || own.state.health == CameraHealth::kContradicts);
}

bool CameraWatch::IsSeenByOthers(std::size_t camera, Time time, Duration age) const {
  return std::any_of(cameras_.begin(), cameras_.end(), [&](const Watched& other) {
    return &other != &cameras_[camera] && other.state.is_used() && other.seen &&
           time - *other.seen <= age;
  });
}

bool CameraWatch::AddSighting(std::size_t camera, Time time, SightingPlace place, double offset_m,
                              const Refutes& refutes) {
  Watched& own = cameras_[camera];
  if (own.state.health == CameraHealth::kContradicts) {
    return Reconsider(camera, time, place, offset_m, refutes);
  }
  own.seen = time;
  if (place == SightingPlace::kStart) {
    const bool are_all_used = std::none_of(
        cameras_.begin(), cameras_.end(),
        [](const Watched& each) { return each.state.health == CameraHealth::kContradicts; });
    moved_by_ = own.outside > 0 && are_all_used ? std::optional(camera) : std::nullopt;
    own.outside = 0;
    confirmed_ = camera;
  }
  if (place == SightingPlace::kInside) Confirm(camera);
  if (place != SightingPlace::kOutside || !CountOutside(&own, offset_m)) return false;
  LeaveOut(Contradicting(camera, refutes), MedianInPlace(own.offsets_m), time);
  return true;
}

// True when the camera has contradicted the others for long enough.
bool CameraWatch::CountOutside(Watched* camera, double offset_m) {
  if (camera->outside == 0) camera->confirmed_by_others = 0;
  camera->offsets_m[static_cast<std::size_t>(camera->outside++ % kSightings)] = offset_m;
  return camera->outside >= kSightings && camera->confirmed_by_others >= kConfirmations;
}

// A camera that comes and goes must agree for longer each time.
bool CameraWatch::Reconsider(std::size_t camera, Time time, SightingPlace place, double offset_m,
                             const Refutes& refutes) {
  Watched& own = cameras_[camera];
  if (place != SightingPlace::kInside) {
    own.agreements = 0;
    if (!CountOutside(&own, offset_m)) return false;
    own.outside = 0;
    if (!refutes(confirmed_, camera)) return false;
    LeaveOut(confirmed_, MedianInPlace(own.offsets_m), time);
    own.state = {CameraHealth::kGood, time};
    return true;
  }
  if (own.agreements++ == 0) {
    own.agrees_since = time;
    own.confirmed_by_others = 0;
  }
  if (own.agreements < kSightings || own.confirmed_by_others < kConfirmations ||
      time - own.agrees_since < own.probation) {
    return false;
  }
  own.state = {CameraHealth::kGood, time};
  own.probation *= 2;
  return false;
}

void CameraWatch::Confirm(std::size_t camera) {
  for (Watched& each : cameras_) ++each.confirmed_by_others;
  cameras_[camera].outside = 0;
  if (moved_by_ && *moved_by_ != camera) moved_by_.reset();
  confirmed_ = camera;
}

std::size_t CameraWatch::Contradicting(std::size_t camera, const Refutes& refutes) const {
  if (refutes(confirmed_, camera)) return confirmed_;
  if (refutes(camera, confirmed_)) return camera;
  return moved_by_ == confirmed_ ? confirmed_ : camera;
}

void CameraWatch::LeaveOut(std::size_t camera, double offset_m, Time time) {
  cameras_[camera].state = {CameraHealth::kContradicts, time, offset_m};
  cameras_[camera].agreements = 0;
  for (Watched& each : cameras_) each.outside = 0;
  moved_by_.reset();
}

}  // namespace kestrel
