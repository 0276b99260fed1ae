// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/core/camera/calibration.h"
#include "kestrel/flight/session/result_connection.h"
#include "kestrel/flight/session/vision.h"
#include "kestrel/io/recording/frame_source.h"
#include "kestrel/vision/objects/color/color_grid.h"
#include "kestrel/vision/objects/object_model.h"
#include "kestrel/vision/pipeline/follow_pipeline.h"
#include "kestrel/vision/pipeline/hunt_pipeline.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"

namespace kestrel {

// The camera of a session, or several.
struct SessionCamera {
  CameraCalibration calibration;
  // The further cameras, by the index of their frames less one. All have their names then.
  std::vector<CameraCalibration> further = {};
  // Height of the camera above what is looked for, where there are no poses.
  std::optional<double> altitude_m = {};
  bool has_world = false;        // frames can be placed in the world: poses, and the camera's mount
  bool is_lens_unknown = false;  // as OpenedSource's
  bool is_live = false;          // frames come in real time, and a pose may come late
};

// Options of a pipeline where the frames come in real time: the pose after a frame may not be there
// yet, as it is in a recording.
template <class Options>
Options InFlight(Options options, bool is_live) {
  constexpr double kLongestPrediction_s = 0.2;
  double& ahead_s = options.pose_extrapolation_s;
  if (is_live && ahead_s == 0) ahead_s = kLongestPrediction_s;
  return options;
}

// The task of a session: to land on a pad, to hunt for coloured objects, or to follow what a person
// has marked. A new kind is a class, and a line in task.cc.
class Task {
 public:
  virtual ~Task() = default;

  // The image format that the vision takes.
  virtual PixelFormat format() const = 0;
  // File name of the table with a row for each frame.
  virtual std::string_view table() const = 0;
  // True when it takes several cameras; else a recording's first one is used.
  virtual bool takes_several_cameras() const { return false; }
  // Topics of ROS that are advertised at once.
  virtual ResultTopics topics() const = 0;
  // Throws InputError when camera or options are not valid.
  virtual std::unique_ptr<Vision> MakeVision(const SessionCamera& camera) const = 0;
};

// The options of all tasks, as `kestrel config` prints them.
struct TaskOptions {
  LandingPipelineOptions landing;
  HuntPipelineOptions hunt;
  FollowPipelineOptions follow;

  static void Visit(auto& self, auto&& visit) {
    visit.Group("landing", self.landing);
    visit.Group("hunt", self.hunt);
    visit.Group("follow", self.follow);
  }
};

// What a person has marked in a recording.
struct FollowMark {
  cv::Rect2d box_px;        // as RegionTracker::Mark
  std::string frame = "0";  // number of the frame, from 0, or its name
};

// The choices of a session, beside the options.
struct TaskChoice {
  std::vector<double> predict_s = {};  // horizons of predictions, which a recording's tables have
  ObjectModel model = DefaultObjectModel();
  std::optional<ColorGrid> grid = {};   // nothing: the model's own
  std::vector<double> origin = {};      // as HuntTask's
  std::optional<FollowMark> mark = {};  // what to follow
  // Class of the objects to one of which the UAV goes; empty: it goes to none.
  std::string go = {};
};

// A kind of task. The first one is what a flight does without a flag.
struct TaskKind {
  std::string_view name;  // names its subcommand, and a flag of others, as --hunt
  const char* meaning;    // printed by the subcommand's --help
  const char* instead;    // meaning of the flag
  std::unique_ptr<Task> (*make)(const TaskOptions& options, const TaskChoice& choice);
};
std::span<const TaskKind> TaskKinds();

// 'name': of one of the kinds. Throws InputError when there is no such task.
std::unique_ptr<Task> MakeTask(std::string_view name, const TaskOptions& options,
                               const TaskChoice& choice = {});

}  // namespace kestrel
