// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/cli/result_argument.h"

#include <filesystem>
#include <system_error>

#include "kestrel/core/base/error.h"
#include "kestrel/io/recording/euroc/euroc_recording.h"

namespace kestrel {
namespace {

namespace fs = std::filesystem;

std::optional<std::string> ResultTable(const std::string& source, const std::string& table_name) {
  if (fs::path(source).extension() == ".csv") return source;
  if (FindEurocRoot(source)) return std::nullopt;  // a recording that also has results
  const fs::path table = fs::path(source) / table_name;
  std::error_code ignored;
  return fs::exists(table, ignored) ? std::optional(table.string()) : std::nullopt;
}

}  // namespace

std::optional<std::string> TakeResult(const std::string& table_name,
                                      std::vector<std::string>* sources) {
  std::optional<std::string> result;
  std::vector<std::string> others;
  for (const std::string& source : *sources) {
    const auto table = ResultTable(source, table_name);
    if (!table) {
      others.push_back(source);
    } else if (result) {
      throw InputError(source + ": is a second result, expected one result and its recording");
    } else {
      result = table;
    }
  }
  if (result && others.empty()) {
    throw InputError(*result + ": is a result: name its recording, too, before it");
  }
  *sources = others;
  return result;
}

}  // namespace kestrel
