// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/pipeline/camera_watch.h"

#include <algorithm>
#include <chrono>

#include "kestrel/core/base/robust_statistics.h"

namespace kestrel {
namespace {

constexpr Duration kSilence = std::chrono::seconds(1);
constexpr int kFrozenImages = 5;
constexpr int kConfirmations = 5;

}  // namespace

void CameraWatch::Set(Watched* camera, CameraHealth health, Time time) {
  if (camera->state.health == health || camera->state.health == CameraHealth::kContradicts) return;
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
}

bool CameraWatch::IsUsed(std::size_t camera) const {
  const Watched& own = cameras_[camera];
  return own.state.health == CameraHealth::kGood && own.repeated.in_a_row() == 0;
}

void CameraWatch::AddSighting(std::size_t camera, Time time, SightingPlace place, double offset_m,
                              const std::function<bool(std::size_t)>& has_wrong_tilt) {
  Watched& own = cameras_[camera];
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
  for (Watched& each : cameras_) each.outside = 0;
  moved_by_.reset();
}

}  // namespace kestrel
