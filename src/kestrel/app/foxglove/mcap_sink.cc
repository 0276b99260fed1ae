// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/foxglove/mcap_sink.h"

#include <atomic>
#include <chrono>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "kestrel/app/console/hunt_view.h"
#include "kestrel/app/console/landing_view.h"
#include "kestrel/app/foxglove/observation_file.h"
#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

constexpr std::size_t kFrames = 32;  // queue of frames for the disk
constexpr Duration kFlushPeriod = std::chrono::seconds(1);

class McapWriter : public SinkWriter {
 public:
  McapWriter(const std::string& path, bool replace, const CameraIntrinsics& camera,
             const std::variant<LandingView, HuntView>& view,
             std::function<void(const std::string&)> tell)
      : file_(path, replace, camera, view), tell_(std::move(tell)) {}

  bool IsWanted() const override { return !has_failed_; }
  void Write(const Observation& observation, std::size_t /*waiting*/) override {
    Try([&] { file_.writer().Write(observation); });
  }
  void Write(const SessionEvent& event) override {
    Try([&] { file_.writer().Write(event); });
  }
  void Rest(bool had_frame) override {
    if (!had_frame) Try([this] { file_.Flush(); });
  }
  void Finish(std::size_t dropped) override {
    Try([this] { file_.Close(); });
    if (dropped == 0 || has_failed_) return;
    tell_(fmt::format("--mcap: {} frames are left out: the disk is too slow", dropped));
  }

 private:
  template <class Work>
  void Try(const Work& work) {
    if (has_failed_) return;
    try {
      work();
    } catch (const InputError& error) {
      has_failed_ = true;
      tell_(fmt::format("{}: the flight goes on without it", error.what()));
    }
  }

  ObservationFile file_;
  std::function<void(const std::string&)> tell_;
  std::atomic<bool> has_failed_{false};
};

}  // namespace

std::unique_ptr<AsynchronousSink> OpenMcapSink(const std::string& path, bool replace,
                                               const CameraIntrinsics& camera,
                                               const std::variant<LandingView, HuntView>& view,
                                               std::function<void(const std::string&)> tell) {
  return std::make_unique<AsynchronousSink>(
      AsynchronousSinkOptions{.thread_name = "mcap", .frames = kFrames, .patience = kFlushPeriod},
      std::make_unique<McapWriter>(path, replace, camera, view, std::move(tell)));
}

std::unique_ptr<AsynchronousSink> OpenMcapSink(const std::string& path, bool replace,
                                               const CameraCalibration& calibration,
                                               const LandingPipelineOptions& options,
                                               std::function<void(const std::string&)> tell) {
  const std::variant<LandingView, HuntView> view = ViewOf(calibration, options);
  return OpenMcapSink(path, replace, calibration.intrinsics, view, std::move(tell));
}

std::unique_ptr<AsynchronousSink> OpenMcapSink(const std::string& path, bool replace,
                                               const CameraCalibration& calibration,
                                               const ObjectModel& objects,
                                               std::function<void(const std::string&)> tell) {
  const std::variant<LandingView, HuntView> view = HuntView{.model = objects};
  return OpenMcapSink(path, replace, calibration.intrinsics, view, std::move(tell));
}

}  // namespace kestrel
