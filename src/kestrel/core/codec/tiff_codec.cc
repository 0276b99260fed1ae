// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/codec/tiff_codec.h"

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <tiffio.h>
#include <vector>

#include <fmt/format.h>

namespace kestrel {
namespace {

// The file that libtiff reads, and the first fault.
struct TiffFile {
  std::string_view bytes;
  toff_t position = 0;
  std::array<char, 256> fault{};
};

tmsize_t Read(thandle_t handle, void* output, tmsize_t size) {
  auto* file = static_cast<TiffFile*>(handle);
  if (file->position >= file->bytes.size() || size < 0) return 0;
  const std::string_view part = file->bytes.substr(file->position, size);
  std::memcpy(output, part.data(), part.size());
  file->position += part.size();
  return static_cast<tmsize_t>(part.size());
}

tmsize_t RefuseToWrite(thandle_t /*handle*/, void* /*bytes*/, tmsize_t /*size*/) { return 0; }

toff_t Seek(thandle_t handle, toff_t offset, int whence) {
  auto* file = static_cast<TiffFile*>(handle);
  if (whence == SEEK_CUR) offset += file->position;
  if (whence == SEEK_END) offset += file->bytes.size();
  return file->position = offset;
}

int Close(thandle_t /*handle*/) { return 0; }

toff_t Size(thandle_t handle) { return static_cast<TiffFile*>(handle)->bytes.size(); }

void KeepFault(thandle_t handle, const char* format, va_list arguments) {
  auto& fault = static_cast<TiffFile*>(handle)->fault;
  if (fault[0] == '\0') std::vsnprintf(fault.data(), fault.size(), format, arguments);
}

struct TiffCloser {
  void operator()(TIFF* tiff) const { TIFFClose(tiff); }
};
using TiffPointer = std::unique_ptr<TIFF, TiffCloser>;

#if TIFFLIB_VERSION >= 20221213  // 4.5
// Returns 1: the fault is handled and not printed.
int TakeFault(TIFF* /*tiff*/, void* file, const char* /*module*/, const char* format,
              va_list arguments) {
  KeepFault(file, format, arguments);
  return 1;
}

int IgnoreWarning(TIFF* /*tiff*/, void* /*file*/, const char* /*module*/, const char* /*format*/,
                  va_list /*arguments*/) {
  return 1;
}

struct OptionsFree {
  void operator()(TIFFOpenOptions* options) const { TIFFOpenOptionsFree(options); }
};

TiffPointer Open(TiffFile* file, std::size_t max_bytes) {
  const std::unique_ptr<TIFFOpenOptions, OptionsFree> options(TIFFOpenOptionsAlloc());
  TIFFOpenOptionsSetMaxSingleMemAlloc(options.get(), static_cast<tmsize_t>(max_bytes));
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), TakeFault, file);
  TIFFOpenOptionsSetWarningHandlerExtR(options.get(), IgnoreWarning, file);
  return TiffPointer(TIFFClientOpenExt("image", "rm", file, Read, RefuseToWrite, Seek, Close, Size,
                                       nullptr, nullptr, options.get()));
}
#else
void TakeFault(thandle_t file, const char* /*module*/, const char* format, va_list arguments) {
  KeepFault(file, format, arguments);
}

// These handlers are the process's, and what libtiff allocates has only its own limits.
TiffPointer Open(TiffFile* file, std::size_t /*max_bytes*/) {
  TIFFSetErrorHandler(nullptr);
  TIFFSetErrorHandlerExt(TakeFault);
  TIFFSetWarningHandler(nullptr);
  return TiffPointer(TIFFClientOpen("image", "rm", file, Read, RefuseToWrite, Seek, Close, Size,
                                    nullptr, nullptr));
}
#endif

std::uint16_t NumberOf(TIFF* tiff, std::uint32_t tag) {
  std::uint16_t number = 0;
  TIFFGetFieldDefaulted(tiff, tag, &number);
  return number;
}

bool IsGray(TIFF* tiff) {
  const std::uint16_t kind = NumberOf(tiff, TIFFTAG_PHOTOMETRIC);
  return kind == PHOTOMETRIC_MINISBLACK || kind == PHOTOMETRIC_MINISWHITE;
}

// Returns the directories of the pages; the first one where all are thumbnails. Hostile files have
// directories without end.
std::vector<tdir_t> PagesOf(TIFF* tiff) {
  constexpr tdir_t kMost = 10000;
  std::vector<tdir_t> pages;
  for (tdir_t i = 0; i < kMost; ++i) {
    std::uint32_t kind = 0;
    TIFFGetFieldDefaulted(tiff, TIFFTAG_SUBFILETYPE, &kind);
    if ((kind & FILETYPE_REDUCEDIMAGE) == 0) pages.push_back(i);
    if (TIFFReadDirectory(tiff) == 0) break;
  }
  return pages.empty() ? std::vector<tdir_t>{0} : pages;
}

[[noreturn]] void Fail(const EncodedImage& image, const TiffFile& file) {
  std::string fault = file.fault.data();
  std::replace(fault.begin(), fault.end(), '\n', ' ');
  FailToDecode(image, fmt::format("cannot be decoded as an image: TIFF: {}", fault));
}

}  // namespace

bool IsTiff(std::string_view bytes) {
  using std::string_view_literals::operator""sv;
  return bytes.starts_with("II*\0"sv) || bytes.starts_with("MM\0*"sv);
}

std::size_t CountTiffPages(std::string_view bytes) {
  TiffFile file{bytes};
  constexpr std::size_t kMaxDirectoryBytes = 1 << 20;
  const TiffPointer tiff = Open(&file, kMaxDirectoryBytes);
  return tiff ? PagesOf(tiff.get()).size() : 1;
}

cv::Mat DecodeTiff(const EncodedImage& image) {
  TiffFile file{image.bytes};
  const TiffPointer tiff = Open(&file, image.max_pixels * sizeof(std::uint32_t));
  if (!tiff) Fail(image, file);
  if (image.page > 0) {
    const std::vector<tdir_t> pages = PagesOf(tiff.get());
    if (image.page >= pages.size() || TIFFSetDirectory(tiff.get(), pages[image.page]) == 0) {
      FailToDecode(image, fmt::format("has no page {}", image.page + 1));
    }
  }
  const std::uint16_t bits = NumberOf(tiff.get(), TIFFTAG_BITSPERSAMPLE);
  if (bits > 8) {
    FailToDecode(image, fmt::format("is a {}-bit image, expected 8 bits a channel", bits));
  }
  std::uint32_t width = 0, height = 0;
  TIFFGetField(tiff.get(), TIFFTAG_IMAGEWIDTH, &width);
  TIFFGetField(tiff.get(), TIFFTAG_IMAGELENGTH, &height);
  cv::Mat rgba = NewPixels(image, width, height, CV_8UC4);
  // Uses the file's own orientation, so that nothing is rotated.
  if (TIFFReadRGBAImageOriented(tiff.get(), width, height, rgba.ptr<std::uint32_t>(),
                                NumberOf(tiff.get(), TIFFTAG_ORIENTATION),
                                /*stopOnError=*/1) == 0) {
    Fail(image, file);
  }
  const bool is_gray = IsGray(tiff.get());
  cv::Mat pixels = NewPixels(image, width, height, is_gray ? CV_8UC1 : CV_8UC3);
  constexpr std::array kBgrOfRgba{2, 0, 1, 1, 0, 2};
  cv::mixChannels(&rgba, 1, &pixels, 1, kBgrOfRgba.data(), is_gray ? 1 : 3);
  return pixels;
}

}  // namespace kestrel
