#include "contracts/tube_certificate.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/file.h"
#include "contracts/contract_file.h"

namespace rondo::contracts {

namespace {

constexpr const char* kFormat = "rondo-tube/1";

using reach::certify::Certificate;
using reach::certify::PartRecord;

PartRecord::Step StepOf(const reach::StepRecord& record) {
  using From = reach::StepRecord::Kind;
  using To = PartRecord::Step::Kind;
  PartRecord::Step step;
  step.kind = record.kind == From::kStep    ? To::kStep
              : record.kind == From::kCross ? To::kCross
              : record.kind == From::kSplit ? To::kSplit
                                            : To::kSeveral;
  step.length = record.length;
  step.degree = record.degree;
  step.event = record.event;
  step.together = record.together;
  step.symbol = record.symbol;
  for (const auto& [exponents, factor] : record.time)
    step.time.emplace_back(std::vector<uint32_t>(exponents.begin(), exponents.end()), factor);
  return step;
}

constexpr std::pair<const char*, PartRecord::Step::Kind> kKinds[] = {
    {"cross", PartRecord::Step::Kind::kCross},
    {"split", PartRecord::Step::Kind::kSplit},
    {"several", PartRecord::Step::Kind::kSeveral}};

// A step is [length, degree]; anything else is an object.
nlohmann::json ToJson(const PartRecord::Step& step) {
  if (step.kind == PartRecord::Step::Kind::kStep) return {step.length, step.degree};
  nlohmann::json json{{"length", step.length}, {"degree", step.degree}};
  for (const auto& [name, kind] : kKinds) {
    if (kind == step.kind) json["kind"] = name;
  }
  if (step.kind == PartRecord::Step::Kind::kSplit) json["symbol"] = step.symbol;
  if (step.kind == PartRecord::Step::Kind::kCross) {
    json["event"] = step.event;
    json["together"] = step.together;
    json["time"] = step.time;
  }
  return json;
}

constexpr std::pair<const char*, reach::Conjunct::Source> kSources[] = {
    {"state", reach::Conjunct::Source::kState},
    {"claim", reach::Conjunct::Source::kClaim},
    {"event", reach::Conjunct::Source::kEvent}};

nlohmann::json ToJson(const reach::Invariant& invariant) {
  nlohmann::json modes = nlohmann::json::array();
  for (const reach::ModeInvariant& one : invariant) {
    nlohmann::json values = nlohmann::json::array();
    for (const auto& value : one.mode) values.push_back(value.ToString());
    nlohmann::json conjuncts = nlohmann::json::array();
    for (const reach::Conjunct& c : one.conjuncts) {
      nlohmann::json json{
          {"index", c.index}, {"comparison", c.comparison}, {"negated", c.negated}, {"bound", c.bound}};
      for (const auto& [name, source] : kSources) {
        if (source == c.source) json["of"] = name;
      }
      conjuncts.push_back(std::move(json));
    }
    modes.push_back({{"mode", values}, {"at_most_zero", conjuncts}});
  }
  return modes;
}

// Reads what SaveTube writes. Throws nlohmann's exceptions, or clears `good`.
struct Reader {
  bool good = true;

  size_t Whole(const nlohmann::json& json) {
    good = good && json.is_number_unsigned();
    return good ? json.get<size_t>() : 0;
  }

  PartRecord::Step Step(const nlohmann::json& json) {
    PartRecord::Step step;
    if (json.is_array()) {
      step.length = json.at(0).get<double>();
      step.degree = Whole(json.at(1));
      return step;
    }
    step.kind = PartRecord::Step::Kind::kSeveral;
    for (const auto& [name, kind] : kKinds) {
      if (json.at("kind") == name) step.kind = kind;
    }
    step.length = json.at("length").get<double>();
    step.degree = Whole(json.at("degree"));
    if (step.kind == PartRecord::Step::Kind::kSplit) step.symbol = Whole(json.at("symbol"));
    if (step.kind != PartRecord::Step::Kind::kCross) return step;
    step.event = Whole(json.at("event"));
    step.together = json.at("together").get<double>();
    for (const auto& term : json.at("time")) {
      auto& [exponents, factor] = step.time.emplace_back();
      for (const auto& e : term.at(0))
        exponents.push_back(static_cast<uint32_t>(std::min<size_t>(Whole(e), 255)));
      factor = term.at(1).get<double>();
    }
    return step;
  }

  reach::Paving Paving(const nlohmann::json& json) {
    reach::Paving paving;
    for (const auto& state : json.at("states")) paving.states.push_back(Whole(state));
    paving.edges = json.at("edges").get<std::vector<std::vector<double>>>();
    for (const auto& cell : json.at("cells")) {
      auto& one = paving.cells.emplace_back();
      for (const auto& edge : cell) {
        const size_t number = Whole(edge);
        good = good && number < UINT32_MAX;
        one.push_back(static_cast<uint32_t>(number));
      }
    }
    return paving;
  }

  reach::ModeInvariant Mode(const nlohmann::json& json) {
    reach::ModeInvariant one;
    for (const auto& text : json.at("mode")) {
      const auto value = expr::Rational::Parse(text.get<std::string>());
      good = good && value.has_value();
      one.mode.push_back(value.value_or(expr::Rational(0)));
    }
    for (const auto& c : json.at("at_most_zero")) {
      reach::Conjunct& conjunct = one.conjuncts.emplace_back();
      const auto* const source = std::ranges::find(kSources, c.at("of").get<std::string>(),
                                                   &std::pair<const char*, reach::Conjunct::Source>::first);
      good = good && source != std::end(kSources);
      if (good) conjunct.source = source->second;
      conjunct.index = Whole(c.at("index"));
      conjunct.comparison = Whole(c.at("comparison"));
      conjunct.negated = c.at("negated").get<bool>();
      conjunct.bound = c.at("bound").get<double>();
    }
    return one;
  }

  PartRecord Part(const nlohmann::json& json) {
    PartRecord part;
    for (const auto& cut : json.at("path")) part.path.push_back({Whole(cut.at(0)), cut.at(1).get<bool>()});
    for (const auto& step : json.at("steps")) part.steps.push_back(Step(step));
    return part;
  }
};

}  // namespace

Certificate CertificateOf(const reach::Proved& proved) {
  Certificate certificate;
  certificate.invariant = proved.invariant;
  certificate.paving = proved.paving;
  if (proved.IsWithoutTube()) return certificate;
  const auto add = [&](const std::vector<reach::Cut>& path) -> PartRecord& {
    PartRecord& part = certificate.parts.emplace_back();
    for (const reach::Cut& cut : path) part.path.push_back({cut.side, cut.upper});
    return part;
  };
  for (const reach::Leaf& leaf : proved.leaves) {
    PartRecord& part = add(leaf.path);
    for (const reach::StepRecord& step : leaf.steps) part.steps.push_back(StepOf(step));
  }
  for (const auto& path : proved.empty) add(path);
  return certificate;
}

void CertifyContract(ContractResult& r, const Certificate& certificate, unsigned jobs,
                     const base::StopToken& stop) {
  const auto begin = std::chrono::steady_clock::now();
  r.certified = reach::certify::Check(r.made.problem, certificate, jobs, stop);
  r.certify_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

base::Result<bool> SaveTube(const std::string& path, const TubeFile& file) {
  nlohmann::json parts = nlohmann::json::array();
  for (const PartRecord& part : file.certificate.parts) {
    nlohmann::json cuts = nlohmann::json::array();
    for (const PartRecord::Cut& cut : part.path) cuts.push_back({cut.side, cut.upper});
    nlohmann::json steps = nlohmann::json::array();
    for (const PartRecord::Step& step : part.steps) steps.push_back(ToJson(step));
    parts.push_back({{"path", cuts}, {"steps", steps}});
  }
  nlohmann::json json = ContractToJson(kFormat, {file.files, file.spec, file.contract});
  json["parts"] = parts;
  if (const auto& paving = file.certificate.paving)
    json["paving"] = {{"states", paving->states}, {"edges", paving->edges}, {"cells", paving->cells}};
  if (file.certificate.invariant) json["invariant"] = ToJson(*file.certificate.invariant);
  return base::WriteFileAtomically(
      path, json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

bool IsTube(std::string_view text) {
  const size_t first = text.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && text[first] == '{';
}

base::Result<TubeFile> ReadTube(std::string_view text) {
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (!HasFormat(json, kFormat)) return base::Error{fmt::format("this is no JSON of the format {}", kFormat)};
  TubeFile file;
  const auto name = ContractFromJson(json);
  if (!name) return base::Error{"it does not say of which contract it is"};
  Reader reader;
  try {
    for (const auto& part : json.at("parts")) file.certificate.parts.push_back(reader.Part(part));
    if (json.contains("paving")) file.certificate.paving = reader.Paving(json.at("paving"));
    if (json.contains("invariant")) {
      auto& invariant = file.certificate.invariant.emplace();
      for (const auto& mode : json.at("invariant")) invariant.push_back(reader.Mode(mode));
    }
  } catch (const nlohmann::json::exception&) {
    reader.good = false;
  }
  if (!reader.good) return base::Error{"its parts are not what they should be"};
  file.files = name->files;
  file.spec = name->spec;
  file.contract = name->contract;
  return file;
}

base::Result<reach::certify::Acceptance> CheckTube(const TubeFile& file, workspace::Session& session,
                                                   const base::StopToken& stop) {
  LoadedContracts loaded;
  const auto found = FindContract({file.files, file.spec, file.contract}, session, loaded);
  if (!found.ok()) return found.error();
  return reach::certify::Check(found.value()->made.problem, file.certificate, 0, stop);
}

}  // namespace rondo::contracts
