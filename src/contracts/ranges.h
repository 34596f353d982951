#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/stop.h"
#include "contracts/contract.h"
#include "expr/rational.h"

/// Encloses what people ask about motions, such as how fast a robot gets.
namespace rondo::contracts {

/// Reads a range such as `0.5..4`; returns nullopt if it is no such range.
std::optional<std::pair<expr::Rational, expr::Rational>> ReadRange(const std::string& text);

/// Holds what a quantity can be while a contract is carried out.
struct AskedRange {
  std::string text;           ///< the quantity, as it was asked for
  std::string unit;           ///< its SI unit: `m`, `m/s`
  double from = 0, to = 0;    ///< seconds
  interval::Interval values;  ///< encloses all its values in that time
};

/// Holds the ranges that were asked for, or why there are none.
struct Ranges {
  std::vector<AskedRange> all;
  std::string trouble;  ///< why there are none; for people, with where in a quantity it is wrong
};

/// Encloses quantities on the tube of a contract that is proved.
///
/// @param between  seconds; nothing: for as long as the contract says.
Ranges RangesOf(const ContractResult& contract, const std::vector<std::string>& quantities,
                const std::optional<std::pair<expr::Rational, expr::Rational>>& between, unsigned jobs,
                const base::StopToken& stop);

/// Returns the ranges as text for people, and as JSON.
std::string ToText(const Ranges& ranges);
nlohmann::json ToJson(const Ranges& ranges);

}  // namespace rondo::contracts
