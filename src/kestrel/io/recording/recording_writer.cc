// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/recording_writer.h"

#include <fstream>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/core/codec/png_codec.h"

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

// Writes under another name first: a file with its final name is complete.
void WriteWhole(const fs::path& path, const std::string& bytes) {
  CreateFolders(path.parent_path());
  const fs::path unfinished = path.string() + ".unfinished";
  std::ofstream file(unfinished, std::ios::binary);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file) throw InputError(path.string() + ": cannot be written, is the disk full?");
  std::error_code error;
  fs::rename(unfinished, path, error);
  Require(error, path, "cannot be written");
}

constexpr char kImageFolder[] = "mav0/cam0/data";

}  // namespace

void RequireFreeForRecording(const fs::path& output, bool replace) {
  if (!fs::exists(output)) return;
  if (!fs::is_directory(output)) {
    throw InputError(output.string() + ": is a file, not a folder");
  }
  if (fs::is_empty(output)) return;
  if (!fs::exists(output / "mav0" / "cam0")) {
    throw InputError(output.string() + ": is no recording, and not empty");
  }
  if (!replace) throw InputError(output.string() + ": exists already; --force replaces it");
}

fs::path RecordedImagePath(Time time) {
  return fs::path(kImageFolder) / fmt::format("{}.png", ToNanoseconds(time));
}

RecordingWriter::RecordingWriter(const fs::path& output, bool replace, const std::string& scene) {
  const fs::path path = fs::absolute(output).lexically_normal();
  output_ = path.has_filename() ? path : path.parent_path();
  RequireFreeForRecording(output_, replace);
  part_ = output_.string() + ".part";
  CreateFolders(part_);
  lock_.emplace(part_.string());
  const fs::path scene_file = part_ / "mav0" / "scene.yaml";
  if (!fs::exists(scene_file) || ReadFile(scene_file.string()) != scene) {
    for (const fs::path& old : fs::directory_iterator(part_)) {
      std::error_code error;
      fs::remove_all(old, error);
      Require(error, old, "cannot be removed");
    }
    WriteWhole(scene_file, scene);
  }
  CreateFolders(part_ / kImageFolder);
}

bool RecordingWriter::HasImage(Time time) const {
  return fs::exists(part_ / RecordedImagePath(time));
}

void RecordingWriter::WriteImage(Time time, const cv::Mat& image) const {
  constexpr int kLevel = 1;
  WriteWhole(part_ / RecordedImagePath(time), EncodePng(image, kLevel));
}

void RecordingWriter::Publish(const std::vector<Time>& times,
                              const std::vector<RecordingFile>& files) const {
  for (const RecordingFile& file : files) WriteWhole(part_ / "mav0" / file.name, file.text);
  std::string rows = "#timestamp [ns],filename\n";
  for (const Time time : times) {
    rows +=
        fmt::format("{},{}\n", ToNanoseconds(time), RecordedImagePath(time).filename().string());
  }
  WriteWhole(part_ / "mav0" / "cam0" / "data.csv", rows);
  std::error_code error;
  fs::remove_all(output_, error);
  Require(error, output_, "cannot be replaced");
  fs::rename(part_, output_, error);
  Require(error, output_, "cannot be written");
}

}  // namespace kestrel
