#pragma once

#include <filesystem>
#include <optional>
#include <utility>

#include "runtime/rounds/core.h"

/// Keeps what must survive a crash in a file.
namespace rondo::runtime::durable {

/// Keeps the record of one robot. A record replaces the one before as a whole, and is on the disk when `Keep`
/// returns true: written beside it, synchronised, renamed, and the folder synchronised. What a crash or a full
/// disk leaves behind is the record before; a record that is torn nevertheless is seen by its sum
/// (`rounds::Core`).
class FileDisk : public rounds::Disk {
 public:
  /// @param path  of the record; its folder has to exist.
  explicit FileDisk(std::filesystem::path path) : path_(std::move(path)) {}

  bool Keep(codec::View record) override;
  /// Returns what was kept last; nothing if there is no file, or none that can be read.
  std::optional<codec::Bytes> Read() const;

 private:
  std::filesystem::path path_;
};

}  // namespace rondo::runtime::durable
