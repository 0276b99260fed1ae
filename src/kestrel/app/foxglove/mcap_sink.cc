// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/foxglove/mcap_sink.h"

#include <chrono>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "kestrel/app/foxglove/observation_file.h"
#include "kestrel/app/views/hunt_view.h"
#include "kestrel/app/views/landing_view.h"
#include "kestrel/app/views/task_view.h"

namespace kestrel {
namespace {

constexpr std::size_t kFrames = 32;  // queue of frames for the disk
constexpr Duration kFlushPeriod = std::chrono::seconds(1);

class McapWriter : public SinkWriter {
 public:
  McapWriter(const std::string& path, bool replace, const CameraIntrinsics& camera,
             const TaskView& view, std::function<void(const std::string&)> notify)
      : file_(path, replace, camera, view), notify_(std::move(notify)) {}

  ObservationWriter& writer() { return file_.writer(); }

  void Write(const Observation& observation, std::size_t /*waiting*/) override {
    file_.writer().Write(observation);
  }
  void Write(const SessionEvent& event) override { file_.writer().Write(event); }
  void Rest(bool had_frame) override {
    if (!had_frame) file_.Flush();
  }
  void Finish(std::size_t dropped) override {
    file_.Close();
    if (dropped == 0) return;
    notify_(fmt::format("--mcap: {} frames are left out: the disk is too slow", dropped));
  }

 private:
  ObservationFile file_;
  std::function<void(const std::string&)> notify_;
};

class McapFileSink : public ObservationSink {
 public:
  McapFileSink(const std::string& path, bool replace, const CameraIntrinsics& camera,
               const TaskView& view)
      : file_(path, replace, camera, view) {}

  ObservationWriter& writer() { return file_.writer(); }

  void Take(const Observation& observation) override { file_.writer().Write(observation); }
  void Finish() override { file_.Close(); }

 private:
  ObservationFile file_;
};

void AddCameras(const std::vector<CameraCalibration>& further, const Task& task,
                ObservationWriter* writer) {
  for (const CameraCalibration& camera : further) {
    writer->AddCamera(camera.name, camera.intrinsics, ViewOf(task, camera));
  }
}

}  // namespace

std::unique_ptr<AsynchronousSink> OpenMcapSink(const std::string& path, bool replace,
                                               const Task& task,
                                               const CameraCalibration& calibration,
                                               const std::vector<CameraCalibration>& further,
                                               std::function<void(const std::string&)> notify) {
  AsynchronousSinkOptions options{
      .thread_name = "mcap", .frames = kFrames, .patience = kFlushPeriod, .notify = {}};
  options.notify = [notify](const std::string& error) {
    notify(fmt::format("{}: the flight goes on without it", error));
  };
  auto writer = std::make_unique<McapWriter>(path, replace, calibration.intrinsics,
                                             ViewOf(task, calibration), std::move(notify));
  AddCameras(further, task, &writer->writer());
  return std::make_unique<AsynchronousSink>(std::move(options), std::move(writer));
}

std::unique_ptr<ObservationSink> OpenMcapFile(const std::string& path, bool replace,
                                              const Task& task,
                                              const CameraCalibration& calibration,
                                              const std::vector<CameraCalibration>& further) {
  auto sink = std::make_unique<McapFileSink>(path, replace, calibration.intrinsics,
                                             ViewOf(task, calibration));
  AddCameras(further, task, &sink->writer());
  return sink;
}

}  // namespace kestrel
