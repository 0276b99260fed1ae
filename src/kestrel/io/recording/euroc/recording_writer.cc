// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/euroc/recording_writer.h"

#include <array>
#include <cstdint>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/core/base/write_file.h"
#include "kestrel/core/codec/png_codec.h"
#include "kestrel/io/recording/euroc/euroc_layout.h"
#include "kestrel/io/recording/euroc/recording_place.h"

namespace kestrel {
namespace {

namespace fs = std::filesystem;

// Throws InputError with the system's message.
void Require(const std::error_code& error, const fs::path& path, const char* what) {
  if (error) throw InputError(fmt::format("{}: {}: {}", path.string(), what, error.message()));
}

void CreateFolders(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  Require(error, folder, "cannot be made");
}

void WriteText(const fs::path& path, const std::string& text) {
  CreateFolders(path.parent_path());
  ReplaceFile(path, text);
}

}  // namespace

RecordingWriter::RecordingWriter(const fs::path& output, bool replace, const std::string& scene)
    : output_(PlaceOfRecording(output)), part_(PartOfRecording(output)) {
  RequireFreeForRecording(output_, replace);
  CreateFolders(part_);
  lock_.emplace(part_.string());
  const fs::path scene_file = part_ / "mav0" / euroc::kScene;
  if (!fs::exists(scene_file) || ReadFile(scene_file.string()) != scene) {
    for (const fs::path& old : fs::directory_iterator(part_)) {
      std::error_code error;
      fs::remove_all(old, error);
      Require(error, old, "cannot be removed");
    }
    WriteText(scene_file, scene);
  }
  writer_ = std::make_unique<EurocWriter>(part_, std::array{EurocTable::kImages});
}

// A power loss may have left an empty file.
bool RecordingWriter::HasImage(Time time, std::size_t camera) const {
  std::error_code error;
  const std::uintmax_t size = fs::file_size(part_ / RecordedImagePath(time, "png", camera), error);
  return !error && size > 0;
}

void RecordingWriter::WriteImage(Time time, const cv::Mat& image, std::size_t camera) const {
  constexpr int kLevel = 1;
  const fs::path path = part_ / RecordedImagePath(time, "png", camera);
  if (camera > 0) CreateFolders(path.parent_path());
  ReplaceFile(path, EncodePng(image, kLevel));
}

void RecordingWriter::Publish(const std::vector<Time>& times,
                              const std::vector<RecordingFile>& files) const {
  for (const RecordingFile& file : files) WriteText(part_ / "mav0" / file.name, file.text);
  for (const Time time : times) {
    writer_->ListImage(time, "png");
    writer_->CommitMany();
  }
  writer_->CommitOrThrow();
  PublishRecording(part_, output_);
}

}  // namespace kestrel
