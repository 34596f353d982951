#include "contracts/ranges.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "reach/problem/program.h"

namespace rondo::contracts {

using expr::Rational;

std::optional<std::pair<Rational, Rational>> ReadRange(const std::string& text) {
  const size_t dots = text.find("..");
  if (dots == std::string::npos) return std::nullopt;
  const auto from = Rational::Parse(text.substr(0, dots));
  const auto to = Rational::Parse(text.substr(dots + 2));
  if (!from || !to || *to < *from) return std::nullopt;
  return std::pair(*from, *to);
}

Ranges RangesOf(const ContractResult& contract, const std::vector<std::string>& quantities,
                const std::optional<std::pair<Rational, Rational>>& between, unsigned jobs,
                const base::StopToken& stop) {
  Ranges result;
  const auto* proved = contract.outcome ? std::get_if<reach::Proved>(&*contract.outcome) : nullptr;
  if (proved == nullptr) {
    result.trouble = "only what is proved has a tube";
    return result;
  }
  const reach::Problem& problem = contract.made.problem;
  Rational from(0);
  Rational to = problem.horizon;
  if (between) {
    if (problem.horizon < between->first || between->first < Rational(0)) {
      result.trouble = fmt::format("it lasts from 0 to {} s", problem.horizon.ToString());
      return result;
    }
    from = between->first;
    if (between->second < to) to = between->second;
  }
  std::vector<reach::Query> queries;
  for (const std::string& text : quantities) {
    diag::SourceSet sources;
    diag::Diagnostics diagnostics;
    const auto value = robot::QuantityOf(text, contract.made, *problem.arena, sources, diagnostics);
    if (!value) {
      result.all.clear();
      result.trouble = fmt::format("`{}`: {}", text,
                                   diagnostics.all().empty() ? "no quantity" : diagnostics.all()[0].message);
      return result;
    }
    // Outwards: what is asked for is among what is enclosed.
    queries.push_back({value->terms[0], reach::Enclose(from).lo, reach::Enclose(to).hi});
    result.all.push_back({text,
                          value->any_dimension ? "" : robot::UnitText(value->dimension),
                          reach::NearestConstant(from).factor,
                          reach::NearestConstant(to).factor,
                          {}});
  }
  reach::ProverOptions options;
  options.jobs = jobs;
  const auto ranges = reach::RangesOn(problem, *proved, queries, options, stop);
  if (!ranges.ok()) {
    result.trouble = ranges.error().message;
    result.all.clear();
    return result;
  }
  for (size_t i = 0; i < result.all.size(); ++i) result.all[i].values = ranges.value()[i];
  return result;
}

std::string ToText(const Ranges& ranges) {
  if (!ranges.trouble.empty()) return fmt::format("  no ranges: {}\n", ranges.trouble);
  std::string text;
  for (const AskedRange& r : ranges.all) {
    const std::string unit = r.unit.empty() || r.unit == "a number" ? "" : " " + r.unit;
    text += fmt::format("  {} in {}{} from {:.6g} to {:.6g} s\n", r.text, interval::ToString(r.values), unit,
                        r.from, r.to);
  }
  return text;
}

nlohmann::json ToJson(const Ranges& ranges) {
  if (!ranges.trouble.empty()) return {{"trouble", ranges.trouble}};
  nlohmann::json list = nlohmann::json::array();
  for (const AskedRange& r : ranges.all) {
    list.push_back({{"quantity", r.text},
                    {"unit", r.unit},
                    {"from", r.from},
                    {"to", r.to},
                    {"least", r.values.lo},
                    {"most", r.values.hi}});
  }
  return list;
}

}  // namespace rondo::contracts
