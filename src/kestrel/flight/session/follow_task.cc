// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/session/follow_task.h"

#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/parse_number.h"
#include "kestrel/flight/session/result_files.h"
#include "kestrel/io/recording/overlays/follow_overlay.h"

namespace kestrel {
namespace {

// Writes the table and the annotated frames. Waits for the disk. Throws InputError when it cannot
// write.
class FollowFiles : public ObservationSink {
 public:
  explicit FollowFiles(const OutputOptions& output)
      : results_(output, kFollowTable, FollowCsvHeader()), only_in_image_(output.only_in_image) {}

  void Take(const Observation& observation) override {
    const auto& seen = std::get<FollowObservation>(observation.seen);
    has_begun_ = has_begun_ || seen.region;
    if (seen.region) results_.WriteRows(FollowCsvRow(observation.frame.name, seen, only_in_image_));
    if (!results_.wants_pictures()) return;
    results_.WritePicture(observation.frame.name, DrawFollowOverlay(observation.frame.image, seen));
  }
  void Take(const BrokenFrame& frame) override {
    if (has_begun_) results_.WriteRows(UnreadableFollowCsvRow(frame.name, frame.time));
  }

 private:
  ResultFiles results_;
  bool only_in_image_;
  bool has_begun_ = false;  // rows begin with the marked frame
};

// Copies of the newest images, for a mark on a picture that a person saw some time ago.
class KeptImages {
 public:
  static constexpr std::size_t kMost = 64;  // two seconds at 30 images/s

  struct Image {
    Time time;
    cv::Mat pixels;
  };

  // Does not allocate once it is full.
  void Add(const cv::Mat& image, Time time) {
    if (images_.size() < kMost) images_.emplace_back();
    Image& oldest = images_[next_];
    image.copyTo(oldest.pixels);
    oldest.time = time;
    next_ = (next_ + 1) % kMost;
  }

  // From the newest one at this time on, oldest first; none when it is not kept any more.
  std::vector<const Image*> From(Time time) const {
    std::vector<const Image*> from;
    for (std::size_t i = 0; i < images_.size(); ++i) {
      const Image& image = images_[(next_ + i) % images_.size()];
      if (image.time <= time) from.clear();
      if (!from.empty() || image.time <= time) from.push_back(&image);
    }
    return from;
  }

 private:
  std::vector<Image> images_;
  std::size_t next_ = 0;
};

// The pipeline of a marked thing in a session. It has no pad: what a person marks is nothing to
// land on.
class FollowVision : public Vision {
 public:
  FollowVision(const SessionCamera& camera, const FollowPipelineOptions& options,
               const std::optional<FollowMark>& mark)
      : pipeline_(camera.calibration, InFlight(options, camera.is_live)),
        clock_offset_(camera.calibration.clock_offset.value_or(Duration::zero())),
        has_world_(camera.has_world),
        is_live_(camera.is_live),
        mark_(mark) {}

  void AddPose(const PoseSample& pose) override { pipeline_.AddPose(pose); }
  void AddGimbal(const GimbalSample& sample) override { pipeline_.AddGimbal(sample); }
  Duration pose_lead() const override { return clock_offset_; }
  Observation Process(const Frame& frame) override;
  TrackSnapshot snapshot() const override { return snapshot_; }
  std::optional<TargetTrackerOptions> marked() const override {
    return pipeline_.options().Tracker();
  }
  bool has_world() const override { return has_world_; }
  void SetGroundZero(double height_m) override { pipeline_.SetGroundZero(height_m); }
  void Change(const TaskOptions& options, std::optional<double> /*altitude_m*/) override {
    pipeline_.ChangeOptions(InFlight(options.follow, is_live_));
  }
  bool takes_marks() const override { return true; }
  void Mark(Time frame, const cv::Rect2d& box_px) override;
  void Unmark() override;
  std::unique_ptr<ObservationSink> MakeTables(const OutputOptions& output) const override {
    return std::make_unique<FollowFiles>(output);
  }
  ObservationPainter MakePainter() const override {
    return [](const Observation& observation) {
      return DrawFollowOverlay(observation.frame.image,
                               std::get<FollowObservation>(observation.seen));
    };
  }
  // Throws InputError where the recording ends before the marked frame.
  void Finish() override;
  std::string Found() const override;

 private:
  FollowObservation Follow(const Frame& frame);
  bool IsMarked(const Frame& frame) const;
  void ForgetTarget();

  FollowPipeline pipeline_;
  Duration clock_offset_;
  bool has_world_, is_live_;
  std::optional<FollowMark> mark_;
  bool is_marked_ = false;  // that mark has been passed
  KeptImages kept_;         // in flight
  TrackSnapshot snapshot_;
  std::array<int, 3> frames_{};  // by RegionState
};

Observation FollowVision::Process(const Frame& frame) {
  FollowObservation seen = Follow(frame);
  if (is_live_) kept_.Add(frame.image, frame.time);
  ++snapshot_.frames;
  snapshot_.captured = frame.time + clock_offset_;
  snapshot_.detect_time = seen.detect_time;
  snapshot_.followed = seen;
  if (seen.region) {
    ++frames_[static_cast<std::size_t>(seen.region->state)];
    snapshot_.detections += seen.region->state == RegionState::kFollowing;
  }
  snapshot_.state = seen.track_state;
  snapshot_.target = seen.target;
  const bool is_placed =
      seen.fate == MeasurementFate::kStarted || seen.fate == MeasurementFate::kAccepted;
  if (is_placed) snapshot_.seen = snapshot_.captured;
  return {frame, std::move(seen)};
}

FollowObservation FollowVision::Follow(const Frame& frame) {
  if (is_marked_ || !mark_ || !IsMarked(frame)) return pipeline_.Process(frame.image, frame.time);
  is_marked_ = true;
  try {
    return pipeline_.Mark(frame.image, frame.time, mark_->box_px);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", frame.name, error.what()));
  }
}

// By its number, or by its name or the end of it.
bool FollowVision::IsMarked(const Frame& frame) const {
  const std::string& wanted = mark_->frame;
  if (const auto number = ParseNumber<int>(wanted)) return *number == snapshot_.frames;
  return frame.name == wanted || frame.name.ends_with("/" + wanted);
}

// The images since then are followed at once, so that the next one finds the region where it is.
void FollowVision::Mark(Time frame, const cv::Rect2d& box_px) {
  const std::vector<const KeptImages::Image*> since = kept_.From(frame);
  if (since.empty()) {
    throw InputError(fmt::format("the marked picture is older than {} images: mark a newer one",
                                 KeptImages::kMost));
  }
  pipeline_.Mark(since.front()->pixels, since.front()->time, box_px);
  ForgetTarget();
  for (std::size_t i = 1; i < since.size(); ++i) {
    pipeline_.Process(since[i]->pixels, since[i]->time);
  }
}

void FollowVision::Unmark() {
  pipeline_.Unmark();
  ForgetTarget();
}

// A confirmation was for the mark before.
void FollowVision::ForgetTarget() {
  ++snapshot_.mark;
  snapshot_.target.reset();
  snapshot_.seen.reset();
}

void FollowVision::Finish() {
  if (is_marked_ || !mark_) return;
  throw InputError(fmt::format(
      "--at {}: the source has {} frames and none of that name, expected a name or a number",
      mark_->frame, snapshot_.frames));
}

std::string FollowVision::Found() const {
  return fmt::format("followed in {}, coasted in {}, lost in {}", frames_[0], frames_[1],
                     frames_[2]);
}

}  // namespace

FollowTask::FollowTask(const FollowPipelineOptions& options, const std::optional<FollowMark>& mark)
    : options_(options), mark_(mark) {}

std::unique_ptr<Vision> FollowTask::MakeVision(const SessionCamera& camera) const {
  if (!mark_ && !camera.is_live) throw InputError("expected a box around what is to be followed");
  return std::make_unique<FollowVision>(camera, options_, mark_);
}

}  // namespace kestrel
