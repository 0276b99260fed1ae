// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/cli/console_camera.h"

#include "kestrel/app/cli/camera_run.h"
#include "kestrel/app/cli/interrupt.h"
#include "kestrel/io/recording/open_source.h"

namespace kestrel {

bool IsLiveSource(const std::string& source) {
  return IsCamera(source) || SimulatedSource::IsNamed(source) || source.starts_with("dds:");
}

void RunCameraConsole(const ConsoleArguments& arguments) {
  CatchInterrupts();
  const KestrelOptions options = arguments.source.options.Read();
  FlySource source(options, arguments.source.dds.NodeOpener(options.dds));
  CameraRunChoice choice{.camera = arguments.source.Recording(PixelFormat::kBgr),
                         .is_looped = true,
                         .page = arguments.PageOptions(options)};
  choice.camera.may_assume_lens = true;
  if (!arguments.output.empty()) choice.folder = choice.keep_folder = arguments.output;
  CameraRun(options, choice, &source).Play(WasInterrupted);
}

}  // namespace kestrel
