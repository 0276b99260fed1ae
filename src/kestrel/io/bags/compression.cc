// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/bags/compression.h"

#include <bzlib.h>
#include <cstddef>
#include <lz4frame.h>
#include <memory>
#include <zstd.h>

#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

std::string CompressBz2(std::string_view bytes) {
  constexpr int kBlocks_100kB = 9;
  auto size = static_cast<unsigned>(bytes.size() + bytes.size() / 100 + 600);  // as bzip2 requires
  std::string output(size, '\0');
  const int status = BZ2_bzBuffToBuffCompress(output.data(), &size, const_cast<char*>(bytes.data()),
                                              static_cast<unsigned>(bytes.size()), kBlocks_100kB,
                                              /*verbosity=*/0, /*workFactor=*/0);
  if (status != BZ_OK) throw InputError("bz2 has no memory to compress");
  output.resize(size);
  return output;
}

// ROS 1's own reader of LZ4 needs blocks that do not refer to each other.
std::string CompressLz4(std::string_view bytes) {
  LZ4F_preferences_t preferences{};
  preferences.frameInfo.blockMode = LZ4F_blockIndependent;
  preferences.frameInfo.blockSizeID = LZ4F_max4MB;
  preferences.frameInfo.contentChecksumFlag = LZ4F_contentChecksumEnabled;
  std::string output(LZ4F_compressFrameBound(bytes.size(), &preferences), '\0');
  const std::size_t size =
      LZ4F_compressFrame(output.data(), output.size(), bytes.data(), bytes.size(), &preferences);
  if (LZ4F_isError(size)) throw InputError("lz4 has no memory to compress");
  output.resize(size);
  return output;
}

std::string CompressZstd(std::string_view bytes) {
  std::string output(ZSTD_compressBound(bytes.size()), '\0');
  const std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> context(ZSTD_createCCtx(),
                                                                     ZSTD_freeCCtx);
  if (!context) throw InputError("zstd has no memory to compress");
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_checksumFlag, 1);
  const std::size_t size =
      ZSTD_compress2(context.get(), output.data(), output.size(), bytes.data(), bytes.size());
  if (ZSTD_isError(size)) throw InputError("zstd has no memory to compress");
  output.resize(size);
  return output;
}

}  // namespace

const char* ToString(Compression compression) {
  switch (compression) {
    case Compression::kBz2:
      return "bz2";
    case Compression::kLz4:
      return "lz4";
    case Compression::kZstd:
      return "zstd";
    default:
      return "none";
  }
}

std::string Compress(Compression compression, std::string_view bytes) {
  switch (compression) {
    case Compression::kBz2:
      return CompressBz2(bytes);
    case Compression::kLz4:
      return CompressLz4(bytes);
    case Compression::kZstd:
      return CompressZstd(bytes);
    default:
      return std::string(bytes);
  }
}

}  // namespace kestrel
