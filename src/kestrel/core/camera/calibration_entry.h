// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <initializer_list>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <yaml-cpp/yaml.h>

namespace kestrel {

// Returns a key without what the tools write differently: "Camera_Matrix", "cameraMatrix" and
// "camera_matrix" are one key.
std::string PlainKey(const std::string& key);

// A value of a calibration file with the path of its key, so that every message can name both.
// Every error is an InputError.
class CalibrationEntry {
 public:
  using Names = std::initializer_list<const char*>;

  // The root of a file. 'file' is for messages.
  CalibrationEntry(const YAML::Node& root, const std::string& file);

  const YAML::Node& node() const { return node_; }
  const std::string& key() const { return key_; }
  const std::string& file() const { return file_->name; }

  // 'what' continues the sentence that begins with the key.
  [[noreturn]] void Fail(const std::string& what) const;

  // Returns the value of the key of this map that has one of 'names', in any spelling (PlainKey).
  // Fails when there are two and they contradict each other.
  std::optional<CalibrationEntry> Find(Names names) const;
  CalibrationEntry Get(Names names, const std::string& expected) const;

  std::string Text() const;
  double Number() const;
  int Integer() const;  // also from 320.0
  // Returns the numbers of a list, a list of rows, or a matrix with rows, cols and data: row by
  // row.
  std::vector<double> Numbers() const;
  std::vector<double> Numbers(std::size_t count, const std::string& expected) const;

  // Returns the keys of this map in the order of the file.
  std::vector<std::string> Keys() const;
  // Returns whether Find has ever returned the value of 'key' of this map.
  bool IsUsed(const std::string& key) const;

 private:
  struct File {
    std::string name;
    std::set<std::string> used;  // paths of the keys
  };

  CalibrationEntry(std::shared_ptr<File> file, const YAML::Node& node, std::string key);

  std::string PathOf(const std::string& name) const;
  void RequireAgreement(const CalibrationEntry& other) const;
  double NumberOf(const YAML::Node& node) const;
  std::vector<double> MatrixNumbers() const;
  std::vector<double> ListNumbers() const;

  std::shared_ptr<File> file_;
  YAML::Node node_;
  std::string key_;  // path of names to this value
};

}  // namespace kestrel
