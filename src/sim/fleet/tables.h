#pragma once

#include <toml++/toml.h>

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "diag/diagnostic.h"
#include "sim/bodies/body.h"

/// Reads TOML files in which every mistake gets a place.
namespace rondo::sim {

/// Reads one file. Whatever is wrong is reported, and the usual value taken.
class Tables {
 public:
  Tables(const diag::SourceSet& sources, diag::FileId file, diag::Diagnostics& diagnostics)
      : sources_(sources), file_(file), diagnostics_(diagnostics) {}

  /// Returns the whole file; an empty table, after a report, if it is no TOML.
  toml::table Root();
  diag::Span At(const toml::source_region& region) const;
  diag::Span At(const toml::node& node) const { return At(node.source()); }
  void Wrong(diag::Span span, std::string message);

  /// Reports every key of a table that is none of these; `what` names the table.
  void Known(const toml::table& table, const std::vector<std::string>& keys, std::string_view what);
  /// Returns the table of this name; nullptr if there is none.
  const toml::table* Table(const toml::table& parent, const char* name);
  /// Calls `visit` for each table of `[[name]]`.
  void ForEach(const toml::table& table, const char* name,
               const std::function<void(const toml::table&)>& visit);
  /// Returns a number of [low, high]; `Whole`: a whole one; `Word`: one of these words; `Flag`: a truth value.
  double Number(const toml::table& table, const char* name, double usual, double low, double high);
  size_t Whole(const toml::table& table, const char* name, size_t usual, double low = 1,
               double high = 100'000);
  std::string Word(const toml::table& table, const char* name, const std::string& usual,
                   const std::vector<std::string>& choices);
  bool Flag(const toml::table& table, const char* name, bool usual);
  /// Returns three numbers; `needed`: reports at `where` if there are none.
  Point ReadPoint(const toml::table& table, const char* name, const Point& usual, bool needed,
                  diag::Span where);
  nlohmann::json ToJson(const toml::node& node);

 private:
  bool Lost(const toml::node& node);

  const diag::SourceSet& sources_;
  diag::FileId file_;
  diag::Diagnostics& diagnostics_;
};

}  // namespace rondo::sim
