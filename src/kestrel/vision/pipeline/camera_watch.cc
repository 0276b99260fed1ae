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

void CameraWatch::AddSighting(std::size_t camera, Time time, SightingPlace place, double offset_m,
                              const std::function<bool(std::size_t)>& has_wrong_tilt) {
  Watched& own = cameras_[camera];
  if (own.state.health == CameraHealth::kContradicts) return Reconsider(&own, time, place);
  own.seen = time;
  if (place == SightingPlace::kStart) {
    moved_by_ = own.outside > 0 ? std::optional(camera) : std::nullopt;
    own.outside = 0;
    confirmed_ = camera;
  }
  if (place == SightingPlace::kInside) Confirm(camera);
  if (place != SightingPlace::kOutside) return;
  if (own.outside == 0) own.confirmed_by_others = 0;
  own.offsets_m[static_cast<std::size_t>(own.outside++ % kSightings)] = offset_m;
  if (own.outside < kSightings || own.confirmed_by_others < kConfirmations) return;
  auto offsets_m = own.offsets_m;
  LeaveOut(Contradicting(camera, has_wrong_tilt), MedianInPlace(offsets_m), time);
}

// A camera that comes and goes must agree for longer each time.
void CameraWatch::Reconsider(Watched* camera, Time time, SightingPlace place) {
  if (place != SightingPlace::kInside) {
    camera->agreements = 0;
    return;
  }
  if (camera->agreements++ == 0) {
    camera->agrees_since = time;
    camera->confirmed_by_others = 0;
  }
  if (camera->agreements < kSightings || camera->confirmed_by_others < kConfirmations ||
      time - camera->agrees_since < camera->probation) {
    return;
  }
  camera->state = {CameraHealth::kGood, time};
  camera->probation *= 2;
}

void CameraWatch::Confirm(std::size_t camera) {
  for (Watched& each : cameras_) ++each.confirmed_by_others;
  cameras_[camera].outside = 0;
  if (moved_by_ && *moved_by_ != camera) moved_by_.reset();
  confirmed_ = camera;
}

std::size_t CameraWatch::Contradicting(
    std::size_t camera, const std::function<bool(std::size_t)>& has_wrong_tilt) const {
  const bool is_other =
      moved_by_ == confirmed_ || (has_wrong_tilt(confirmed_) && !has_wrong_tilt(camera));
  return is_other ? confirmed_ : camera;
}

void CameraWatch::LeaveOut(std::size_t camera, double offset_m, Time time) {
  cameras_[camera].state = {CameraHealth::kContradicts, time, offset_m};
  cameras_[camera].agreements = 0;
  for (Watched& each : cameras_) each.outside = 0;
  moved_by_.reset();
}

}  // namespace kestrel
