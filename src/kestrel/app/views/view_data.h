// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/core/base/time.h"

namespace kestrel {

// The data that viewers show of an observation, the same for all tasks.

// Kinds of shapes over the image; a viewer switches each kind on and off. kTruth: the known truth.
// kSecond: all that a second run found.
enum class OverlayLayer { kDetection, kPrediction, kRejected, kTruth, kSecond };
// Returns "detection", "prediction", "rejected", "truth" or "second".
const char* ToString(OverlayLayer layer);

// A line over the image with a label: what was found and how, or why it was rejected.
struct OverlayShape {
  OverlayLayer layer = OverlayLayer::kDetection;
  std::vector<cv::Point2f> outline;  // pixels; a single point is drawn as a mark
  std::string label;
  bool is_closed = true;  // the last point is joined to the first
  int run = 1;            // run of the detector over a recording: first or second
};

// A picture that a viewer can show instead of the camera's image, under the same shapes.
struct ImageView {
  std::string name;  // for people, as "threshold 1/8"
  // Draws the view of a frame's image: same size, 8-bit gray or BGR; empty if there is none.
  // Called by one thread, and only while a viewer wants this view.
  std::function<cv::Mat(const cv::Mat& image)> draw;
};

// Sources of a flight's values. A value is worth no more than the sources that it comes from.
enum class ValueSource { kFrames, kAutopilot, kPose };
// Returns "frames", "autopilot" or "pose".
const char* ToString(ValueSource source);

// A quantity that is plotted over time.
struct SeriesDescription {
  std::string name;                    // as "height"
  std::string unit;                    // as "m"; empty for a pure number
  std::string label;                   // for people
  std::vector<ValueSource> sources{};  // that its values come from
  bool is_count = false;               // whole numbers
};

// One value per series; NaN where unknown.
struct ViewSample {
  Time time;
  std::vector<double> values;
};

// The state of the flight, in words that a pilot takes in at a glance.
struct ViewStatus {
  std::string state;   // as "searching", "tracking", "landing"
  std::string reason;  // why the state is no better; empty if there is no reason
  bool is_recording = false;
  bool is_over = false;     // the flight has ended, as 'reason' describes
  std::string replay = {};  // folder in which an ended flight is recorded; empty: none

  bool operator==(const ViewStatus&) const = default;
};

// A point on the map with its position and its covariance; world frame, m.
struct ViewMapObject {
  std::string label;
  std::string color;  // colour of its class, as "red"; empty: none
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
};
struct ViewMap {
  std::optional<Eigen::Vector2d> uav;
  double uav_heading = 0;  // rad, from x (east) towards y (north)
  std::optional<ViewMapObject> target;
  Eigen::Vector2d target_velocity = Eigen::Vector2d::Zero();  // m/s
  std::vector<ViewMapObject> prediction;  // predicted places of the target, in order of time
  std::vector<ViewMapObject> objects;     // objects in view
  std::vector<ViewMapObject> mapped;      // objects of a hunt's map so far
};

// Objects that the UAV's team knows of, in this UAV's world frame.
struct ViewedTeamObject {
  ViewMapObject object;
  std::vector<std::string> uavs;  // names of the UAVs that have it in their maps
  std::string holder;             // name of the UAV that has claimed it; empty: none
};
struct ViewedTeam {
  std::vector<ViewedTeamObject> objects;
};

// A fact about a frame in words, as "method": "whole pattern".
struct ViewFact {
  std::string name;
  std::string value;
};

}  // namespace kestrel
