// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/open_source.h"

#include <filesystem>

#include "kestrel/core/base/error.h"
#include "kestrel/io/recording/euroc/euroc_recording.h"
#include "kestrel/io/recording/media/file_kind.h"
#include "kestrel/io/recording/media/image_sequence.h"
#include "kestrel/io/recording/media/video_address.h"
#include "kestrel/io/recording/media/video_source.h"

namespace kestrel {
namespace {

namespace fs = std::filesystem;

bool Exists(const std::string& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

std::unique_ptr<FrameSource> OpenFolder(const std::string& folder) {
  if (FindEurocRoot(folder)) return std::make_unique<ImageSequence>(OpenEurocRecording(folder));
  return std::make_unique<ImageSequence>(OpenImageFolder(folder));
}

std::unique_ptr<FrameSource> OpenFile(const std::string& path) {
  switch (FileKindOf(path)) {
    case FileKind::kImage:
      return std::make_unique<ImageSequence>(OpenImageFiles({path}));
    case FileKind::kVideo:
      return OpenVideoFile(path);
    case FileKind::kOther:
      break;
  }
  throw InputError(path + ": by its name neither an image nor a video, expected one or a folder");
}

std::unique_ptr<FrameSource> OpenOne(const std::string& source) {
  if (IsCamera(source)) return OpenCamera(source);
  if (!Exists(source)) throw InputError(source + ": no such file or folder");
  return fs::is_directory(source) ? OpenFolder(source) : OpenFile(source);
}

std::unique_ptr<FrameSource> Open(const std::vector<std::string>& arguments) {
  if (arguments.empty()) throw InputError("no source given");
  if (arguments.size() == 1) return OpenOne(arguments.front());
  for (const std::string& argument : arguments) {
    if (!Exists(argument)) throw InputError(argument + ": no such file");
    if (fs::is_directory(argument) || FileKindOf(argument) != FileKind::kImage) {
      throw InputError(argument +
                       ": is no image; of several sources every one must be an image file");
    }
  }
  return std::make_unique<ImageSequence>(OpenImageFiles(arguments));
}

}  // namespace

bool IsCamera(const std::string& source) {
  if (source.starts_with(kVideoDevice) || IsVideoAddress(source)) return true;
  return source.find('!') != std::string::npos && !Exists(source);
}

std::unique_ptr<FrameSource> OpenSource(const std::vector<std::string>& arguments,
                                        PixelFormat format) {
  std::unique_ptr<FrameSource> source = Open(arguments);
  source->set_format(format);
  return source;
}

}  // namespace kestrel
