// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace YAML {
class Node;
}

namespace kestrel {

// A value of a YAML (or JSON) text, for files that are not options. Every error is an InputError
// that names file, line and key.
class YamlReader {
 public:
  // Reads a whole text as LoadYaml does. 'file' is for messages.
  YamlReader(const std::string& text, const std::string& file);

  [[noreturn]] void Fail(const std::string& message) const;

  // Returns the value of 'name' in a map; required.
  YamlReader operator[](const std::string& name) const;
  bool Has(const std::string& name) const;
  // Throws InputError for a value that is not a map, for keys not in 'names', and for duplicate
  // keys.
  void RequireKeys(const std::set<std::string>& names) const;

  std::vector<YamlReader> Items() const;  // items of a list
  std::string Text() const;               // not empty
  double Number() const;                  // finite
  std::int64_t Integer() const;           // also from 3.0
  bool Bool() const;
  // Returns a list of 'count' numbers.
  std::vector<double> Numbers(std::size_t count) const;

 private:
  YamlReader(const YAML::Node& node, std::string file, std::string key);

  std::shared_ptr<YAML::Node> node_;
  std::string file_;
  std::string key_;  // path of names to this value
};

}  // namespace kestrel
