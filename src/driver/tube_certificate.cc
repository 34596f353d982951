#include "driver/tube_certificate.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/file.h"
#include "driver/contract_file.h"

namespace rondo::driver {

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
                                            : To::kOther;
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
    {"other", PartRecord::Step::Kind::kOther}};

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

PartRecord::Step StepFrom(const nlohmann::json& json) {
  PartRecord::Step step;
  if (json.is_array()) {
    step.length = json.at(0).get<double>();
    step.degree = json.at(1).get<size_t>();
    return step;
  }
  step.kind = PartRecord::Step::Kind::kOther;
  for (const auto& [name, kind] : kKinds) {
    if (json.at("kind") == name) step.kind = kind;
  }
  step.length = json.at("length").get<double>();
  step.degree = json.at("degree").get<size_t>();
  if (step.kind == PartRecord::Step::Kind::kSplit) step.symbol = json.at("symbol").get<size_t>();
  if (step.kind == PartRecord::Step::Kind::kCross) {
    step.event = json.at("event").get<size_t>();
    step.together = json.at("together").get<double>();
    json.at("time").get_to(step.time);
  }
  return step;
}

// Throws nlohmann's exceptions.
PartRecord PartFrom(const nlohmann::json& json) {
  PartRecord part;
  for (const auto& cut : json.at("path"))
    part.path.push_back({cut.at(0).get<size_t>(), cut.at(1).get<bool>()});
  for (const auto& step : json.at("steps")) part.steps.push_back(StepFrom(step));
  return part;
}

}  // namespace

Certificate CertificateOf(const reach::Proved& proved) {
  Certificate certificate;
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
  return base::WriteFileAtomically(
      path, json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

bool IsTube(std::string_view text) {
  const size_t first = text.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && text[first] == '{';
}

base::Result<TubeFile> ReadTube(std::string_view text) {
  if (!HasFormat(text, kFormat)) return base::Error{fmt::format("this is no JSON of the format {}", kFormat)};
  const auto json = nlohmann::json::parse(text, nullptr, false);
  TubeFile file;
  const auto name = ContractFromJson(json);
  if (!name) return base::Error{"it does not say of which contract it is"};
  try {
    for (const auto& part : json.at("parts")) file.certificate.parts.push_back(PartFrom(part));
  } catch (const nlohmann::json::exception&) {
    return base::Error{"its parts are not what they should be"};
  }
  file.files = name->files;
  file.spec = name->spec;
  file.contract = name->contract;
  return file;
}

base::Result<reach::certify::Verdict> CheckTube(const TubeFile& file, Session& session,
                                                const base::StopToken& stop) {
  LoadedContracts loaded;
  const auto found = FindContract({file.files, file.spec, file.contract}, session, loaded);
  if (!found.ok()) return found.error();
  return reach::certify::Check(found.value()->made.problem, file.certificate, 0, stop);
}

}  // namespace rondo::driver
