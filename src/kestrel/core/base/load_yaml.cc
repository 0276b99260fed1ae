// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/base/load_yaml.h"

#include <algorithm>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/shown.h"

namespace kestrel {
namespace {

std::string_view WithoutDirective(std::string_view text) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  if (text.starts_with("%YAML")) text.remove_prefix(std::min(text.find('\n'), text.size()));
  return text;
}

// UTF-16, whose byte order mark YAML knows, has zero bytes, too.
bool IsBinary(std::string_view text) {
  return !text.starts_with("\xFF\xFE") && !text.starts_with("\xFE\xFF") &&
         text.find('\0') != std::string_view::npos;
}

// Returns the number of the first of 'lines' lines that is indented by a tab; 0: none is.
int LineWithTab(std::string_view text, int lines) {
  for (int line = 1; line <= lines; ++line) {
    const std::size_t first = text.find_first_not_of(' ');
    if (first != std::string_view::npos && text[first] == '\t') return line;
    text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
    if (text.empty()) break;
  }
  return 0;
}

}  // namespace

YAML::Node LoadYaml(std::string_view text, const std::string& file) {
  text = WithoutDirective(text);
  if (IsBinary(text)) throw InputError(file + ": the file is binary, expected text (YAML)");
  try {
    return YAML::Load(std::string(text));
  } catch (const YAML::Exception& error) {
    const int line = error.mark.line + 1;
    if (const int with_tab = LineWithTab(text, line); with_tab != 0) {
      throw InputError(fmt::format("{}:{}: a tab; YAML indents by spaces", file, with_tab));
    }
    throw InputError(fmt::format("{}:{}: the file is not YAML or is truncated: {}", file, line,
                                 Shown(error.msg)));
  }
}

}  // namespace kestrel
