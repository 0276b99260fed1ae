// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/bags/decompression.h"

#include <algorithm>
#include <bzlib.h>
#include <cstddef>
#include <limits>
#include <lz4frame.h>
#include <memory>
#include <zstd.h>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

constexpr std::uint64_t kMaxDecompressed = 1 << 30;

// The result of one step of a decompressor.
struct Progress {
  std::size_t read = 0;
  std::size_t written = 0;
  bool is_done = false;
  bool is_broken = false;
};

class Bz2Stream {
 public:
  Bz2Stream() { is_ready_ = BZ2_bzDecompressInit(&stream_, 0, 0) == BZ_OK; }
  ~Bz2Stream() { BZ2_bzDecompressEnd(&stream_); }
  Bz2Stream(const Bz2Stream&) = delete;
  Bz2Stream& operator=(const Bz2Stream&) = delete;

  Progress Step(std::string_view input, char* output, std::size_t room) {
    constexpr std::size_t kMaxStep = std::numeric_limits<unsigned>::max();
    stream_.next_in = const_cast<char*>(input.data());
    stream_.avail_in = static_cast<unsigned>(std::min(input.size(), kMaxStep));
    stream_.next_out = output;
    stream_.avail_out = static_cast<unsigned>(std::min(room, kMaxStep));
    const unsigned in = stream_.avail_in;
    const unsigned out = stream_.avail_out;
    const int status = is_ready_ ? BZ2_bzDecompress(&stream_) : BZ_MEM_ERROR;
    return {in - stream_.avail_in, out - stream_.avail_out, status == BZ_STREAM_END,
            status != BZ_OK && status != BZ_STREAM_END};
  }

 private:
  bz_stream stream_{};
  bool is_ready_;
};

class Lz4Stream {
 public:
  Lz4Stream() : context_(Context()) { LZ4F_resetDecompressionContext(context_); }

  Progress Step(std::string_view input, char* output, std::size_t room) {
    std::size_t read = input.size();
    std::size_t written = room;
    const std::size_t status =
        LZ4F_decompress(context_, output, &written, input.data(), &read, nullptr);
    return {read, written, status == 0, LZ4F_isError(status) != 0};
  }

 private:
  // One per thread: it has megabytes, which would be new pages for each chunk.
  static LZ4F_dctx* Context() {
    struct Owner {
      Owner() { LZ4F_createDecompressionContext(&context, LZ4F_VERSION); }
      ~Owner() { LZ4F_freeDecompressionContext(context); }
      LZ4F_dctx* context = nullptr;
    };
    thread_local const Owner owner;
    return owner.context;
  }

  LZ4F_dctx* context_;
};

class ZstdStream {
 public:
  Progress Step(std::string_view input, char* output, std::size_t room) {
    ZSTD_inBuffer in{input.data(), input.size(), 0};
    ZSTD_outBuffer out{output, room, 0};
    const std::size_t status = ZSTD_decompressStream(context_.get(), &out, &in);
    return {in.pos, out.pos, status == 0, ZSTD_isError(status) != 0};
  }

 private:
  std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> context_{ZSTD_createDCtx(), ZSTD_freeDCtx};
};

// Steps until the end of the input or of the stream. The output starts with room for a usual
// compression and grows with the data that exist, whatever size is claimed.
template <class Stream>
void RunStream(std::string_view input, std::optional<std::uint64_t> expected,
               const std::string& name, std::string* output) {
  const std::uint64_t size = expected.value_or(kMaxDecompressed);
  constexpr std::size_t kUsualRatio = 32;
  const std::size_t first_room = kUsualRatio * input.size();
  Stream stream;
  std::size_t written = 0;
  bool is_done = false;
  while (!is_done) {
    if (output->size() == written) {
      if (written > size) break;
      // One byte more than expected reveals a stream that is too long.
      output->resize(std::min<std::size_t>(size + 1, std::max(first_room, 2 * written)));
    }
    const Progress step = stream.Step(input, output->data() + written, output->size() - written);
    if (step.is_broken) throw InputError(name + ": its compressed bytes are broken");
    written += step.written;
    input.remove_prefix(step.read);
    is_done = step.is_done;
    if (step.read == 0 && step.written == 0) break;  // cut off
  }
  output->resize(written);
  if (written > size || (expected && is_done && written < size)) {
    throw InputError(
        fmt::format("{}: has not the {} bytes that it should when decompressed", name, size));
  }
}

}  // namespace

Compression CompressionOf(std::string_view word, const std::string& name) {
  if (word.empty() || word == "none") return Compression::kNone;
  if (word == "bz2") return Compression::kBz2;
  if (word == "lz4") return Compression::kLz4;
  if (word == "zstd") return Compression::kZstd;
  throw InputError(name + ": has an unknown compression, expected none, bz2, lz4 or zstd");
}

void Decompress(Compression compression, std::string_view bytes, std::optional<std::uint64_t> size,
                const std::string& name, std::string* output) {
  if (size && *size > kMaxDecompressed) {
    throw InputError(fmt::format("{}: claims to have {} bytes, expected at most {}", name, *size,
                                 kMaxDecompressed));
  }
  switch (compression) {
    case Compression::kNone:
      output->assign(bytes);
      return;
    case Compression::kBz2:
      return RunStream<Bz2Stream>(bytes, size, name, output);
    case Compression::kLz4:
      return RunStream<Lz4Stream>(bytes, size, name, output);
    case Compression::kZstd:
      return RunStream<ZstdStream>(bytes, size, name, output);
  }
}

}  // namespace kestrel
