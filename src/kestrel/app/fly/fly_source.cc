// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/fly/fly_source.h"

#include <cstdint>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/io/recording/media/video_address.h"
#include "kestrel/io/recording/open_source.h"

namespace kestrel {
namespace {

// Throws InputError for a camera without a calibration.
void RequireCalibration(const RecordingChoice& camera) {
  const std::string& source = camera.sources.front();
  if (!IsCamera(source) || !camera.camera.empty() || camera.may_assume_lens) return;
  throw InputError(fmt::format(
      "{}: no calibration: nothing can be measured, and nothing sent to an autopilot, without "
      "one: --camera FILE (kestrel calibrate lens makes one)",
      WithoutPassword(source)));
}

void PrintLine(const std::string& text) { fmt::print(stderr, "kestrel: {}\n", text); }

}  // namespace

FlySource::FlySource(const KestrelOptions& options, DdsSource::OpenNode open_node)
    : simulated(options.fly.sim_camera, options.landing.target,
                static_cast<std::uint64_t>(options.fly.sim_seed)),
      dds(options.dds, std::move(open_node), PrintLine),
      camera_(options.fly.camera) {}

void FlySource::Open(const RecordingChoice& recording, bool is_looped) {
  RequireCalibration(recording);
  live = OpenLiveSource({recording, is_looped}, camera_, {dds.Scheme(), simulated.Scheme()});
}

void FlySource::Open(const std::vector<RecordingChoice>& cameras,
                     const std::function<void(const std::string&)>& notify) {
  for (const RecordingChoice& camera : cameras) RequireCalibration(camera);
  live = OpenLiveCameras(cameras, camera_, notify, {dds.Scheme()});
}

}  // namespace kestrel
