// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/ros/node_session.h"

#include <filesystem>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/camera/calibration_reader.h"
#include "kestrel/flight/onboard/hunt_vision.h"
#include "kestrel/flight/onboard/live_session_options.h"
#include "kestrel/flight/ros/ros_sink.h"
#include "kestrel/io/recording/output_folder.h"

namespace kestrel {
namespace {

constexpr double kForever_s = 1e9;  // a node waits for images

// Passes the session's events on to ROS.
class WarningSink : public ObservationSink {
 public:
  explicit WarningSink(NodeConnection* connection) : connection_(connection) {}
  bool IsWanted() const override { return false; }
  void Take(const Observation&) override {}
  void Take(const SessionEvent& event) override { connection_->Warn(event.text); }

 private:
  NodeConnection* connection_;
};

RosFrames FramesOf(const NodeOptions& options, const TopicSource& source) {
  RosFrames frames;
  frames.camera = source.camera_frame();
  if (options.has_poses()) frames.world = source.world_frame();
  frames.to_now = source.from_stamps();
  return frames;
}

LiveSessionOptions SessionOptionsOf(const NodeOptions& options) {
  LiveSessionOptions session;
  session.landing = options.landing;
  session.hunt = options.hunt;
  session.flight = options.fly;
  session.flight.source_timeout_s = kForever_s;
  session.altitude_m = options.altitude();
  return session;
}

}  // namespace

NodeFiles ReadNodeFiles(const NodeOptions& options,
                        const std::function<void(const std::string&)>& warn) {
  NodeFiles files;
  if (!options.camera.empty()) files.calibration = ReadCalibration(options.camera, "", warn);
  if (!options.is_hunt()) return files;
  files.model = options.model.empty() ? DefaultObjectModel() : ReadObjectModel(options.model);
  if (!options.grid.empty()) {
    files.grid = ColorGrid::Load(options.grid, files.model->colors.colors.size());
  }
  return files;
}

NodeSession::NodeSession(const NodeOptions& options, const NodeFiles& files,
                         const CameraCalibration& calibration, TopicSource* source,
                         NodeConnection* connection)
    : results_(std::make_shared<RosResults>(
          std::shared_ptr<ResultConnection>(std::shared_ptr<void>(), connection), WireFormat::kRos1,
          options.ros, FramesOf(options, *source), calibration, options.landing,
          files.model.value_or(ObjectModel()))) {
  sinks_.Add(MakeRosSink(
      results_, [connection](const std::string& text) { connection->Warn(text); },
      /*reports=*/false));
  sinks_.Add(std::make_unique<WarningSink>(connection));
  LiveSessionParts parts;
  parts.source = source;
  parts.calibration = calibration;
  parts.has_poses = options.has_poses();
  parts.sees_repeated = true;
  parts.objects = files.model;
  parts.grid = files.grid;
  parts.sink = &sinks_;
  session_.emplace(std::move(parts), SessionOptionsOf(options));
  source->Begin(calibration.intrinsics);
  thread_ = std::thread([this] { session_->Run([this] { return is_over_.load(); }); });
}

NodeSession::~NodeSession() {
  is_over_ = true;
  thread_.join();
  sinks_.Finish();
}

void NodeSession::Change(const NodeOptions& options) {
  session_->Change(SessionOptionsOf(options));
  results_->Change(options.ros, options.landing);
}

void NodeSession::PublishMap() {
  const HuntVision* const hunt = session_->hunt();
  if (hunt == nullptr) return;
  std::optional<Time> newest;
  std::vector<MappedObject> objects;
  session_->BetweenFrames([&] {
    newest = hunt->newest();
    if (newest != published_) objects = hunt->Objects();
  });
  if (newest == published_) return;
  published_ = newest;
  results_->Publish(std::move(objects), *newest);
}

std::string NodeSession::SaveMap(const NodeOptions& options) {
  const HuntVision* const hunt = session_->hunt();
  if (hunt == nullptr) {
    throw InputError("the landing pattern has no map, coloured objects do: _task:=hunt");
  }
  if (!options.has_poses()) {
    throw InputError("there is no map without poses: _poses:=topic or _poses:=tf");
  }
  if (options.hunt.still) throw InputError("there is no map with hunt/still");
  if (options.output.empty()) {
    throw InputError("no folder to save the map in: set the parameter output, then call update");
  }
  const std::string folder = std::filesystem::absolute(options.output).string();
  std::size_t objects = 0;
  session_->BetweenFrames([&] {
    hunt->WriteMap(OutputFolder(folder, options.force, "the parameter force (and update)"),
                   options.origin_degrees());
    objects = hunt->Objects().size();
  });
  return fmt::format("{} objects in {}/object_map.csv{}", objects, folder,
                     options.origin.empty() ? "" : " and object_map.geojson");
}

}  // namespace kestrel
