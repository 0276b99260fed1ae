// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/media/image_sequence.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/core/camera/calibration_reader.h"
#include "kestrel/core/codec/image_codec.h"
#include "kestrel/io/recording/media/file_kind.h"
#include "kestrel/io/recording/media/image_file.h"

namespace kestrel {
namespace {

bool IsDigit(char c) { return std::isdigit(static_cast<unsigned char>(c)); }

// Removes the digits at the front of the text. Returns them without leading zeros.
std::string_view TakeNumber(std::string_view* text) {
  const auto end = std::find_if_not(text->begin(), text->end(), IsDigit);
  std::string_view number = text->substr(0, end - text->begin());
  text->remove_prefix(number.size());
  number.remove_prefix(std::min(number.find_first_not_of('0'), number.size()));
  return number;
}

// Compares numbers within the texts by value and everything else by character.
bool NaturallyLess(const std::string& left, const std::string& right) {
  std::string_view a = left;
  std::string_view b = right;
  while (!a.empty() && !b.empty()) {
    if (IsDigit(a.front()) && IsDigit(b.front())) {
      const std::string_view m = TakeNumber(&a);
      const std::string_view n = TakeNumber(&b);
      if (m.size() != n.size()) return m.size() < n.size();
      if (m != n) return m < n;
    } else {
      if (a.front() != b.front()) return a.front() < b.front();
      a.remove_prefix(1);
      b.remove_prefix(1);
    }
  }
  if (a.empty() != b.empty()) return a.empty();
  return left < right;  // "1" and "01"
}

std::vector<std::string> ImagesBelow(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  try {
    std::filesystem::recursive_directory_iterator entry(folder);
    for (; entry != std::filesystem::recursive_directory_iterator(); ++entry) {
      if (IsHidden(entry->path())) {
        entry.disable_recursion_pending();
      } else if (entry->is_regular_file() && FileKindOf(entry->path()) == FileKind::kImage) {
        names.push_back(entry->path().lexically_relative(folder).string());
      }
    }
  } catch (const std::filesystem::filesystem_error& error) {
    throw InputError(folder.string() + ": cannot be read: " + error.code().message());
  }
  std::sort(names.begin(), names.end(), NaturallyLess);
  return names;
}

// Only a TIFF has pages. A file that cannot be read is one image, whose fault its reading gives.
std::size_t PagesOf(const std::filesystem::path& path) {
  if (!MayHavePages(path)) return 1;
  try {
    return CountPages(ReadFile(path.string()));
  } catch (const InputError&) {
    return 1;
  }
}

// Adds the image file at nominal times; each of several pages has a name of its own.
void AddFile(const std::string& name, const std::string& path,
             std::vector<ImageSequence::Item>* items) {
  const std::size_t pages = PagesOf(path);
  for (std::size_t page = 0; page < pages; ++page) {
    const std::string item = pages == 1 ? name : fmt::format("{}/{:06}", name, page);
    items->push_back({item, path, NominalTime(items->size()), page});
  }
}

}  // namespace

ImageSequence::ImageSequence(std::vector<Item> items, std::string calibration_file,
                             std::vector<PoseSample> poses, std::vector<GimbalSample> gimbal,
                             std::vector<ZoomSample> zoom)
    : items_(std::move(items)),
      calibration_file_(std::move(calibration_file)),
      poses_(std::move(poses)),
      gimbal_(std::move(gimbal)),
      zoom_(std::move(zoom)) {}

bool ImageSequence::ReadNext(Frame* frame) {
  if (next_ == items_.size()) return false;
  const Item& item = items_[next_];
  try {
    return Read(next_++, frame);
  } catch (const InputError& error) {
    throw BrokenImage(error.what(), item.name, item.time);
  }
}

bool ImageSequence::Read(std::size_t index, Frame* frame) const {
  if (index >= items_.size()) return false;
  const Item& item = items_[index];
  frame->name = item.name;
  frame->time = item.time;
  frame->image = ReadImage(item.path, format(), item.page);
  if (keeps_color()) frame->color = ReadImage(item.path, PixelFormat::kBgr, item.page);
  return true;
}

std::optional<CameraCalibration> ImageSequence::calibration() const {
  if (calibration_file_.empty()) return std::nullopt;
  return ReadCalibration(calibration_file_);
}

double ImageSequence::rate_hz() const {
  const Duration span = items_.back().time - items_.front().time;
  return span.count() > 0 ? (items_.size() - 1) / ToSeconds(span) : kNominalRateHz;
}

Time NominalTime(std::size_t index) { return Time(DurationFromSeconds(index / kNominalRateHz)); }

ImageSequence OpenImageFiles(const std::vector<std::string>& paths) {
  std::vector<ImageSequence::Item> items;
  for (const std::string& path : paths) AddFile(path, path, &items);
  return ImageSequence(std::move(items));
}

ImageSequence OpenImageFolder(const std::string& folder) {
  std::vector<ImageSequence::Item> items;
  for (const std::string& name : ImagesBelow(folder)) {
    AddFile(name, (std::filesystem::path(folder) / name).string(), &items);
  }
  if (items.empty()) throw InputError(folder + ": no image in this folder, nor below it");
  return ImageSequence(std::move(items));
}

}  // namespace kestrel
