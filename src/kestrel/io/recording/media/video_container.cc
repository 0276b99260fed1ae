// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/media/video_container.h"

#include <algorithm>
#include <bit>
#include <fstream>
#include <string_view>

namespace kestrel {
namespace {

constexpr std::size_t kHeadBytes = 16;  // head of a box: its size and its type

class BoxedFile {
 public:
  explicit BoxedFile(const std::string& path) : file_(path, std::ios::binary | std::ios::ate) {
    if (file_) size_ = static_cast<std::uint64_t>(file_.tellg());
  }

  std::uint64_t size() const { return size_; }
  // Returns up to kHeadBytes from 'offset' on.
  std::string HeadAt(std::uint64_t offset) {
    std::string head(kHeadBytes, '\0');
    file_.clear();
    file_.seekg(static_cast<std::streamoff>(offset));
    file_.read(head.data(), static_cast<std::streamsize>(head.size()));
    head.resize(static_cast<std::size_t>(std::max<std::streamsize>(file_.gcount(), 0)));
    return head;
  }

 private:
  std::ifstream file_;
  std::uint64_t size_ = 0;
};

std::uint64_t BigEndian(std::string_view bytes) {
  std::uint64_t number = 0;
  for (const char c : bytes) number = number << 8 | static_cast<unsigned char>(c);
  return number;
}

std::uint64_t LittleEndian(std::string_view bytes) {
  return BigEndian(std::string(bytes.rbegin(), bytes.rend()));
}

// Returns the end of the box at 'offset' by its own size; 'offset' when it has none that is known.
using EndOfBox = std::uint64_t (*)(std::string_view head, std::uint64_t offset);

// ISO/IEC 14496-12, 4.2: size and type; size 1: the size follows the type; 0: up to the end.
std::uint64_t EndOfMp4Box(std::string_view head, std::uint64_t offset) {
  constexpr std::size_t kHead = 8;
  if (head.size() < kHead) return offset;
  std::uint64_t size = BigEndian(head.substr(0, 4));
  if (size == 1 && head.size() >= 2 * kHead) size = BigEndian(head.substr(kHead, kHead));
  return size < kHead ? offset : offset + size;
}

// A RIFF chunk: its type and its size, padded to an even number. OpenDML files have several.
std::uint64_t EndOfRiffChunk(std::string_view head, std::uint64_t offset) {
  constexpr std::size_t kHead = 8;
  if (head.size() < kHead || !head.starts_with("RIFF")) return offset;
  const std::uint64_t size = LittleEndian(head.substr(4, 4));
  return size == 0 || size == 0xffffffff ? offset : offset + kHead + size + size % 2;
}

// An element of EBML (RFC 8794): its id and its size, both of 1 to 8 bytes, whose leading zero bits
// encode their length. A size of only ones is not known.
std::uint64_t EndOfEbmlElement(std::string_view head, std::uint64_t offset) {
  if (head.size() < 2) return offset;
  const std::size_t id_bytes = std::countl_zero(static_cast<unsigned char>(head[0])) + 1;
  if (id_bytes >= head.size()) return offset;
  const std::size_t size_bytes = std::countl_zero(static_cast<unsigned char>(head[id_bytes])) + 1;
  if (size_bytes > 8 || id_bytes + size_bytes > head.size()) return offset;
  const std::uint64_t unknown = (std::uint64_t{1} << (7 * size_bytes)) - 1;
  const std::uint64_t size = BigEndian(head.substr(id_bytes, size_bytes)) & unknown;
  return size == unknown ? offset : offset + id_bytes + size_bytes + size;
}

// Returns the end of the last box that begins in the file; 0 when its end is not known.
std::uint64_t EndOfBoxes(BoxedFile* file, EndOfBox end_of) {
  std::uint64_t offset = 0;
  while (offset < file->size()) {
    const std::uint64_t end = end_of(file->HeadAt(offset), offset);
    if (end <= offset) return 0;
    offset = end;
  }
  return offset;
}

}  // namespace

VideoContainer ReadVideoContainer(const std::string& path) {
  BoxedFile file(path);
  const std::string head = file.HeadAt(0);
  const auto has_at = [&](std::size_t place, std::string_view text) {
    return head.size() >= place && std::string_view(head).substr(place).starts_with(text);
  };
  if (has_at(0, "RIFF") && has_at(8, "AVI ")) {
    return {"avidemux", file.size(), EndOfBoxes(&file, EndOfRiffChunk)};
  }
  if (has_at(4, "ftyp")) return {"qtdemux", file.size(), EndOfBoxes(&file, EndOfMp4Box)};
  if (has_at(0, "\x1a\x45\xdf\xa3")) {
    return {"matroskademux", file.size(), EndOfBoxes(&file, EndOfEbmlElement)};
  }
  return {"", file.size(), 0};
}

}  // namespace kestrel
