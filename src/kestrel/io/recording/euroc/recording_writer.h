// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/core/base/folder_lock.h"
#include "kestrel/core/base/time.h"
#include "kestrel/io/recording/euroc/euroc_writer.h"
#include "kestrel/io/recording/euroc/recording_file.h"

namespace kestrel {

// Writes a recording. Until it is complete it is in a folder beside its place, "<output>.part",
// where no other writer may write. WriteImage and HasImage may be called from several threads at a
// time, for different images.
class RecordingWriter {
 public:
  // 'scene', the text of scene.yaml, contains all that the images depend on: images that an
  // interrupted writer of the same scene has left are kept, everything of another scene is removed.
  // Throws InputError when 'output' exists (unless it is empty, or 'replace' and a recording),
  // another writer works on it, or it cannot be written. The functions below throw too when they
  // cannot write.
  RecordingWriter(const std::filesystem::path& output, bool replace, const std::string& scene);

  // Folder of the files until they are published.
  const std::filesystem::path& part() const { return part_; }

  // 'camera': its number.
  bool HasImage(Time time, std::size_t camera = 0) const;
  void WriteImage(Time time, const cv::Mat& image, std::size_t camera = 0) const;

  // Writes cam0/data.csv and 'files'; then gives the recording its final name.
  void Publish(const std::vector<Time>& times, const std::vector<RecordingFile>& files) const;

 private:
  std::filesystem::path output_;
  std::filesystem::path part_;
  std::optional<FolderLock> lock_;       // lock of part_
  std::unique_ptr<EurocWriter> writer_;  // into part_
};

}  // namespace kestrel
