// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/pipeline/camera_watch.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <span>

#include "kestrel/core/base/robust_statistics.h"

namespace kestrel {
namespace {

constexpr Duration kSilence = std::chrono::seconds(1);
constexpr Duration kBlindness = std::chrono::seconds(3);  // after which the track is lost, too
constexpr int kFrozenImages = 5;
constexpr int kConfirmations = 5;
// Tolerated turn and displacement of the mounts of two cameras against each other.
constexpr double kTurned_rad = 0.028, kDisplaced_m = 0.03;

// Returns what any error of the lag, the largest of which turns the view by 'by_lag', leaves of a
// turn.
Eigen::Vector3d WithoutLag(const Eigen::Vector3d& turn, const Eigen::Vector3d& by_lag) {
  const double square = by_lag.squaredNorm();
  if (!(square > 0)) return turn;
  return turn - std::clamp(turn.dot(by_lag) / square, -1.0, 1.0) * by_lag;
}

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

bool CameraWatch::AddSighting(std::size_t camera, const CameraSighting& sighting,
                              const Refutes& refutes) {
  Watched& own = cameras_[camera];
  const Time time = sighting.time;
  if (sighting.place == SightingPlace::kStart) {
    for (Watched& each : cameras_) each.sightings = 0;
  } else {
    own.latest[own.sightings++ % own.latest.size()] = sighting;
  }
  if (own.state.health == CameraHealth::kContradicts) return Reconsider(camera, sighting, refutes);
  own.seen = time;
  if (sighting.place == SightingPlace::kStart) {
    const bool are_all_used = std::none_of(
        cameras_.begin(), cameras_.end(),
        [](const Watched& each) { return each.state.health == CameraHealth::kContradicts; });
    moved_by_ = own.outside > 0 && are_all_used ? std::optional(camera) : std::nullopt;
    own.outside = 0;
    confirmed_ = camera;
    return false;
  }
  if (const auto turn = TurnAgainstOthers(camera, time)) {
    LeaveOut(Contradicting(turn->farther, turn->nearer, refutes), turn->offset_m, time);
    return true;
  }
  if (sighting.place == SightingPlace::kInside) Confirm(camera);
  if (sighting.place != SightingPlace::kOutside || !CountOutside(&own)) return false;
  LeaveOut(Contradicting(camera, confirmed_, refutes), MedianOffset(own), time);
  return true;
}

double CameraWatch::MedianOffset(const Watched& camera) {
  std::array<double, kSightings> offsets_m;
  const std::size_t count = std::min(camera.sightings, offsets_m.size());
  for (std::size_t i = 0; i < count; ++i) {
    offsets_m[i] = camera.latest[(camera.sightings - 1 - i) % camera.latest.size()].offset_m;
  }
  return MedianInPlace(std::span(offsets_m).first(count));
}

// True when the camera has contradicted the others for long enough.
bool CameraWatch::CountOutside(Watched* camera) {
  if (camera->outside++ == 0) camera->confirmed_by_others = 0;
  return camera->outside >= kSightings && camera->confirmed_by_others >= kConfirmations;
}

// A camera that comes and goes must agree for longer each time.
bool CameraWatch::Reconsider(std::size_t camera, const CameraSighting& sighting,
                             const Refutes& refutes) {
  Watched& own = cameras_[camera];
  const Time time = sighting.time;
  if (sighting.place != SightingPlace::kInside || TurnAgainstOthers(camera, time)) {
    own.agreements = 0;
    if (!CountOutside(&own)) return false;
    own.outside = 0;
    if (!refutes(confirmed_, camera)) return false;
    LeaveOut(confirmed_, MedianOffset(own), time);
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

// Returns the mean of the latest sightings; nothing where there are too few.
std::optional<CameraSighting> CameraWatch::LatestMean(const Watched& camera, Time time) {
  constexpr Duration kRecent = std::chrono::milliseconds(1600);
  constexpr int kLeast = 8;
  CameraSighting mean;
  int count = 0;
  for (std::size_t i = 0; i < std::min(camera.sightings, camera.latest.size()); ++i) {
    const CameraSighting& each = camera.latest[i];
    if (time - each.time > kRecent) continue;
    ++count;
    mean.distance_m += each.distance_m;
    mean.turn += each.turn;
    mean.turn_variance += each.turn_variance;
    mean.turn_by_lag += each.turn_by_lag;
  }
  if (count < kLeast) return std::nullopt;
  mean.distance_m /= count;
  mean.turn /= count;
  mean.turn_variance /= count * count;
  mean.turn_by_lag /= count;
  return mean;
}

// A track that is shifted shifts the means of both cameras, and not their difference.
std::optional<CameraWatch::Turn> CameraWatch::TurnAgainstOthers(std::size_t camera,
                                                                Time time) const {
  const auto own = LatestMean(cameras_[camera], time);
  if (!own) return std::nullopt;
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    if (i == camera || !cameras_[i].state.is_used()) continue;
    const auto other = LatestMean(cameras_[i], time);
    if (!other) continue;
    const double sigma = std::sqrt(own->turn_variance + other->turn_variance);
    const double most =
        kTurned_rad + kDisplaced_m / own->distance_m + CameraSighting::kSigmas * sigma;
    const double turn = WithoutLag(own->turn - other->turn, own->turn_by_lag).norm();
    if (turn <= most) continue;
    const double offset_m = turn * own->distance_m;
    const bool is_farther = own->turn.norm() > other->turn.norm();
    return is_farther ? Turn{camera, i, offset_m} : Turn{i, camera, offset_m};
  }
  return std::nullopt;
}

void CameraWatch::Confirm(std::size_t camera) {
  for (Watched& each : cameras_) ++each.confirmed_by_others;
  cameras_[camera].outside = 0;
  if (moved_by_ && *moved_by_ != camera) moved_by_.reset();
  confirmed_ = camera;
}

// Returns the one of two cameras to leave out; 'camera' where nothing else decides.
std::size_t CameraWatch::Contradicting(std::size_t camera, std::size_t other,
                                       const Refutes& refutes) const {
  if (refutes(other, camera)) return other;
  if (refutes(camera, other)) return camera;
  return moved_by_ == other ? other : camera;
}

void CameraWatch::LeaveOut(std::size_t camera, double offset_m, Time time) {
  cameras_[camera].state = {CameraHealth::kContradicts, time, offset_m};
  cameras_[camera].agreements = 0;
  for (Watched& each : cameras_) {
    each.outside = 0;
    each.sightings = 0;
  }
  moved_by_.reset();
}

}  // namespace kestrel
