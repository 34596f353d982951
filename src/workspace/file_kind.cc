#include "workspace/file_kind.h"

#include <algorithm>
#include <array>

namespace rondo::workspace {
namespace {

struct Magic {
  std::string_view bytes;
  std::string_view is;
  std::string_view help = {};
};

constexpr std::string_view kTraces = "`rondo replay` and `rondo plot` take it";
constexpr std::array<Magic, 14> kMagic = {
    {{"\x89MCAP0\r\n", "an MCAP trace", kTraces},
     {"\x89PNG", "a PNG picture"},
     {"\xFF\xD8\xFF", "a JPEG picture"},
     {"GIF8", "a GIF picture"},
     {"%PDF", "a PDF document"},
     {"\x7F"
      "ELF",
      "a program or library of this machine"},
     {"PK\x03\x04", "a ZIP archive"},
     {"\x1F\x8B", "a file packed by gzip"},
     {"SQLite format 3", "a database of SQLite: a bag of ROS 2, perhaps"},
     {"#ROSBAG", "a bag of ROS 1"},
     {"P5", "a picture (PGM)", "maps are named in a fleet file: `[world] map`"},
     {"P6", "a picture (PPM)"},
     {"\xFF\xFE", "text in UTF-16", "save it as UTF-8"},
     {"\xFE\xFF", "text in UTF-16", "save it as UTF-8"}}};

bool Binary(std::string_view text) {
  const auto strange = static_cast<size_t>(std::ranges::count_if(text, [](char c) {
    const auto u = static_cast<unsigned char>(c);
    return u < 0x20 && c != '\n' && c != '\r' && c != '\t' && c != '\f' && c != 0x1b;
  }));
  return text.find('\0') != std::string_view::npos || 20 * strange > text.size();
}

// The first line that says something in any of the languages.
std::string_view FirstLine(std::string_view text) {
  while (!text.empty()) {
    const size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    line.remove_prefix(std::min(line.find_first_not_of(" \t\r"), line.size()));
    if (!line.empty() && !line.starts_with('#') && !line.starts_with("//") && !line.starts_with(';'))
      return line;
  }
  return {};
}

bool BeginsWithWord(std::string_view line, std::initializer_list<std::string_view> words) {
  return std::ranges::any_of(words, [&](std::string_view word) {
    return line.starts_with(word) && (line.size() == word.size() || line[word.size()] == ' ');
  });
}

}  // namespace

OtherKind WhatElse(std::string_view path, std::string_view text, Wanted wanted) {
  for (const Magic& magic : kMagic) {
    // Letters that a text may begin with need what makes no text behind them.
    const bool letters = magic.bytes.starts_with('P') || magic.bytes.starts_with('G');
    if (text.starts_with(magic.bytes) && (!letters || Binary(text)))
      return {std::string(magic.is), std::string(magic.help)};
  }
  if (Binary(text)) return {"no text", ""};
  if (wanted == Wanted::kText) return {};
  const std::string_view line = FirstLine(text);
  if (line.starts_with("<?xml") || line.starts_with("<robot") || line.starts_with("<sdf"))
    return {line.find("<sdf") != std::string_view::npos || text.find("<sdf") != std::string_view::npos
                ? "a world in SDF"
                : "XML, such as a robot in URDF",
            "robots are described in `.rondo` files (docs/motion.md)"};
  if (line.starts_with('{'))
    return {"JSON", text.find("\"rondo-") != std::string_view::npos
                        ? "`rondo replay` takes runs that were saved"
                        : ""};
  const bool motion = BeginsWithWord(line, {"robot", "world", "choreography", "process", "obstacle"}) &&
                      line.find('{') != std::string_view::npos;
  const bool toml = line.starts_with('[') && path.ends_with(".toml");
  if (wanted == Wanted::kKoord && (motion || path.ends_with(".rondo")))
    return {"a file of robots and choreographies", "a Koord program is needed: a `.koord` file"};
  if (wanted == Wanted::kKoord && toml)
    return {"a fleet, or a file of a network or of scenarios", "a Koord program is needed: a `.koord` file"};
  if (wanted == Wanted::kMotion && path.ends_with(".koord"))
    return {"a Koord program", "a file of robots and choreographies is needed: a `.rondo` file"};
  if (wanted == Wanted::kToml && (motion || path.ends_with(".rondo") || path.ends_with(".koord")))
    return {motion || path.ends_with(".rondo") ? "a file of robots and choreographies" : "a Koord program",
            "a TOML file is needed, such as a fleet"};
  return {};
}

}  // namespace rondo::workspace
