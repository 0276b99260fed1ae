// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/bags/cut_sqlite.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <sqlite3.h>
#include <string_view>
#include <sys/mman.h>
#include <unistd.h>

#include "kestrel/core/base/error.h"
#include "kestrel/io/bags/sqlite_bag.h"

namespace kestrel {
namespace {

constexpr std::size_t kHeaderSize = 100;
using SqliteHeader = std::array<unsigned char, kHeaderSize>;

// Big-endian number of 'bytes' bytes at 'offset'.
std::uint32_t NumberAt(const SqliteHeader& header, std::size_t offset, std::size_t bytes) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < bytes; ++i) number = number << 8 | header[offset + i];
  return number;
}

}  // namespace

std::optional<SqliteCut> FindSqliteCut(const std::string& path) {
  std::error_code error;
  const std::uint64_t size = std::filesystem::file_size(path, error);
  std::ifstream file(path, std::ios::binary);
  SqliteHeader header{};
  if (error || !file.read(reinterpret_cast<char*>(header.data()), header.size())) return {};
  if (std::memcmp(header.data(), kSqliteMagic.data(), kSqliteMagic.size()) != 0) return {};
  constexpr std::size_t kPageSize = 16, kPages = 28;  // offsets, sqlite.org/fileformat2.html
  const std::uint32_t stored_size = NumberAt(header, kPageSize, 2);
  const std::uint64_t page_size = stored_size == 1 ? 65536 : stored_size;
  if (page_size < 512) return {};
  const std::uint64_t expected = page_size * NumberAt(header, kPages, 4);
  if (size >= expected || size < page_size) return {};
  return SqliteCut{size - size % page_size, expected};
}

CutSqlite::CutSqlite(const std::string& path, const SqliteCut& cut)
    : size_(static_cast<std::size_t>(cut.whole_pages)) {
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  void* pages = descriptor < 0
                    ? MAP_FAILED
                    : mmap(nullptr, size_, PROT_READ | PROT_WRITE, MAP_PRIVATE, descriptor, 0);
  if (descriptor >= 0) close(descriptor);
  if (pages == MAP_FAILED) throw InputError(path + ": cannot be read: " + std::strerror(errno));
  pages_ = static_cast<unsigned char*>(pages);
  // A database in memory has no write-ahead log: versions of the format for writing and reading.
  pages_[18] = pages_[19] = 1;
}

CutSqlite::~CutSqlite() { munmap(pages_, size_); }

int CutSqlite::OpenIn(sqlite3* database) const {
  // Only a database whose schema can be written may have fewer pages than its header says.
  const int status = sqlite3_exec(database, "PRAGMA writable_schema=ON", nullptr, nullptr, nullptr);
  if (status != SQLITE_OK) return status;
  const auto size = static_cast<sqlite3_int64>(size_);
  return sqlite3_deserialize(database, "main", pages_, size, size, SQLITE_DESERIALIZE_READONLY);
}

}  // namespace kestrel
