// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/replay/clip_maker.h"

#include <cstdint>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/io/recording/media/video_file.h"

namespace kestrel {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxClipBytes = std::uintmax_t{1} << 30;
constexpr std::uintmax_t kMinFreeBytes = std::uintmax_t{128} << 20;
constexpr std::size_t kFramesPerLook = 32;
constexpr std::size_t kFramesPerReport = 10;

// Limits the size of a clip, so that it does not fill a disk that others need.
void RequireRoom(const VideoFile& video) {
  std::error_code error;
  if (const auto size = fs::file_size(video.path(), error); !error && size > kMaxClipBytes) {
    throw InputError("the clip is larger than 1 GB, expected fewer frames");
  }
  const auto space = fs::space(fs::path(video.path()).parent_path(), error);
  if (!error && space.available < kMinFreeBytes) {
    throw InputError(
        fmt::format("{}: less than {} MB are free", video.path(), kMinFreeBytes >> 20));
  }
}

std::optional<std::shared_ptr<const ExportFile>> MakeFile(
    const Clip& clip, const std::function<bool(std::size_t)>& go_on) {
  auto file = std::make_shared<ExportFile>();
  VideoFile video(file->folder.path() + "/clip", clip.rate_hz);
  const Clip::Picture picture = clip.open();
  for (std::size_t i = 0; i < clip.frames; ++i) {
    if (!go_on(i)) return std::nullopt;
    video.Write(picture(i));
    if (i % kFramesPerLook == 0) RequireRoom(video);
  }
  video.Close();
  file->path = video.path();
  return file;
}

}  // namespace

void ClipMaker::Make(PendingExport pending, Clip clip) {
  if (run_.is_running()) {
    return pending.answer({.refusal = "another clip is being made, try again when it is done"});
  }
  pending_ = std::move(pending);
  name_ = clip.name;
  frames_ = clip.frames;
  run_.Start("clip", [clip = std::move(clip)](const auto& go_on) { return MakeFile(clip, go_on); });
  Notify(0, frames_);
}

void ClipMaker::Follow() {
  if (!run_.is_running()) return;
  if (!pending_.is_wanted()) run_.RequestEnd();
  auto outcome = run_.TakeOutcome();
  if (!outcome) {
    if (run_.done() >= reported_ + kFramesPerReport) Notify(run_.done(), frames_);
    return;
  }
  Notify(0, 0);
  if (outcome->result) {
    const File& file = *outcome->result;
    const std::string extension = fs::path(file->path).extension().string();
    const std::string type = extension == ".mp4" ? "video/mp4" : "video/x-msvideo";
    pending_.answer({.type = type, .name = name_ + extension, .file = file});
  } else if (!outcome->error.empty()) {
    pending_.answer({.refusal = outcome->error});
  }
  pending_ = {};
}

void ClipMaker::Notify(std::size_t done, std::size_t frames) {
  reported_ = done;
  feed_->Add(ConsoleClip{done, frames});
}

}  // namespace kestrel
