// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kestrel/app/cli/kestrel_options.h"

namespace kestrel {

// The parameters of the node. They include the options of `kestrel config`, with the same names.
struct NodeOptions {
  std::string task = "landing";         // or "hunt": coloured objects
  std::string camera;                   // calibration file; empty: camera_info
  std::string config;                   // file of options, as for --config
  std::string image_transport = "raw";  // of the subscribed images; or "compressed"
  // Source of the UAV's poses: "topic" (`poses`, of any of the types in bags), "tf", or "none";
  // without poses there are detections but no track.
  std::string poses = "none";
  std::string world_frame;               // for tf; empty: the root of the body's frames
  std::string body_frame = "base_link";  // the UAV's frame in tf; the camera is fixed to it
  std::string pattern_frame = "landing_pattern";  // tf frame of the detected pattern
  std::string target_frame = "landing_target";    // frame of the track's velocity
  bool publish_tf = true;
  double altitude_m = 0;  // height of the camera above the pattern without poses; 0: unknown
  double prediction_s = 2;
  double prediction_step_s = 0.1;
  // For the hunt, as the options of `kestrel hunt`: model of the objects, colour grid, folder for
  // the map, whether it may replace an older one, and origin of the world.
  std::string model;
  std::string grid;
  std::string output;
  bool force = false;
  std::string origin;  // "50.1,14.4": latitude and longitude, degrees; empty: no GeoJSON
  KestrelOptions kestrel;

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("task", self.task, "", "what is looked for: landing or hunt");
    visitor("camera", self.camera, "", "calibration file; empty: camera_info");
    visitor("config", self.config, "", "file of options, as kestrel config prints it");
    visitor("image_transport", self.image_transport, "", "raw or compressed");
    visitor("poses", self.poses, "", "where the UAV's poses come from: topic, tf or none");
    visitor("world_frame", self.world_frame, "", "for tf; empty: the root of the body's frames");
    visitor("body_frame", self.body_frame, "", "of the UAV, which the camera is fixed to");
    visitor("pattern_frame", self.pattern_frame, "", "name of the detected pattern in tf");
    visitor("target_frame", self.target_frame, "", "name of the frame that moves with the target");
    visitor("publish_tf", self.publish_tf, "", "whether tf is told of the pattern");
    visitor("altitude_m", self.altitude_m, "m",
            "of the camera above the pattern where there are no poses; 0: not known");
    visitor("prediction_s", self.prediction_s, "s", "how far ahead the prediction goes");
    visitor("prediction_step_s", self.prediction_step_s, "s", "between its poses");
    visitor("model", self.model, "", "hunt: file of objects and their colours");
    visitor("grid", self.grid, "", "hunt: file of the color grid");
    visitor("output", self.output, "", "hunt: folder that the map is saved in");
    visitor("force", self.force, "", "hunt: replace a map that is there");
    visitor("origin", self.origin, "", "hunt: latitude and longitude of the world's origin");
    KestrelOptions::Visit(self.kestrel, visitor);
  }
  std::vector<std::string> Validate() const;

  bool is_hunt() const { return task == "hunt"; }
  std::optional<double> altitude() const;      // m
  std::vector<double> origin_degrees() const;  // latitude and longitude, or empty
};

// Returns the defaults, changed by the file that `config` names and then by the parameters, pairs
// of key ("landing.detector.min_quality") and value. Throws InputError when one of them is not
// valid.
NodeOptions ReadNodeOptions(const std::vector<std::pair<std::string, std::string>>& parameters);

// The changed options, by name: those that were taken over and those that were not.
struct OptionUpdate {
  std::vector<std::string> taken;
  std::vector<std::string> left;  // these need a reset
};

// Takes over the changes in 'told' that a running node can make without losing track or map:
// thresholds of the detectors, noise, names of frames, and what is published and saved.
OptionUpdate UpdateOptions(NodeOptions told, NodeOptions* options);

}  // namespace kestrel
