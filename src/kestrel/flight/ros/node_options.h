// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kestrel/flight/onboard/flight_options.h"
#include "kestrel/flight/ros/dds_options.h"
#include "kestrel/vision/pipeline/hunt_pipeline.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"

namespace kestrel {

// The parameters of the node of ROS 1. They include the options of `kestrel config` that a node has
// a use for, with the same names.
struct NodeOptions {
  std::string task = "landing";         // or "hunt": coloured objects
  std::string camera;                   // calibration file; empty: camera_info
  std::string config;                   // file of options, as for --config
  std::string image_transport = "raw";  // of the subscribed images; or "compressed"
  // Source of the UAV's poses: "topic" (`poses`, of any of the types in bags), "tf", or "none";
  // without poses there are detections but no track.
  std::string poses = "none";
  std::string world_frame;  // for tf; empty: the root of the body's frames
  DdsOptions ros;           // names of the other frames, and how far the prediction goes
  double altitude_m = 0;    // height of the camera above the pattern without poses; 0: unknown
  // For the hunt, as the options of `kestrel hunt`: model of the objects, colour grid, folder for
  // the map, whether it may replace an older one, and origin of the world.
  std::string model;
  std::string grid;
  std::string output;
  bool force = false;
  std::string origin;  // "50.1,14.4": latitude and longitude, degrees; empty: no GeoJSON
  LandingPipelineOptions landing;
  HuntPipelineOptions hunt;
  FlightOptions fly;  // of these the node uses events and vision_thread

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("task", self.task, "", "target of the search: landing or hunt");
    visitor("camera", self.camera, "", "calibration file; empty: camera_info");
    visitor("config", self.config, "", "file of options, as kestrel config prints it");
    visitor("image_transport", self.image_transport, "", "raw or compressed");
    visitor("poses", self.poses, "", "source of the UAV's poses: topic, tf or none");
    visitor("world_frame", self.world_frame, "",
            "world frame of tf; empty: the root of the body's frames");
    RosResultOptions::Visit(self.ros, visitor);
    visitor("altitude_m", self.altitude_m, "m",
            "height of the camera above the pattern where there are no poses; 0: not known");
    visitor("model", self.model, "", "hunt: file of objects and their colours");
    visitor("grid", self.grid, "", "hunt: file of the color grid");
    visitor("output", self.output, "", "hunt: folder for the map");
    visitor("force", self.force, "", "hunt: an existing map is replaced");
    visitor("origin", self.origin, "", "hunt: latitude and longitude of the world's origin");
    visitor.Group("landing", self.landing);
    visitor.Group("hunt", self.hunt);
    visitor.Group("fly", self.fly);
  }
  std::vector<std::string> Validate() const;

  bool is_hunt() const { return task == "hunt"; }
  bool has_poses() const { return poses != "none"; }
  std::optional<double> altitude() const;      // m
  std::vector<double> origin_degrees() const;  // latitude and longitude, or empty
};

// The changed options, by name: those that were taken over and those that were not.
struct OptionUpdate {
  std::vector<std::string> taken;
  std::vector<std::string> left;  // these need a reset
};

// Takes over the changes in 'told' that a running node can make without losing track or map:
// thresholds of the detectors, noise, names of frames, and what is published and saved.
OptionUpdate UpdateOptions(NodeOptions told, NodeOptions* options);

}  // namespace kestrel
