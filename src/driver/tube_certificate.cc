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

bool ReadPart(const nlohmann::json& json, PartRecord& part) {
  if (!json.is_object() || !json.contains("path") || !json.contains("steps") || !json["path"].is_array() ||
      !json["steps"].is_array())
    return false;
  for (const auto& cut : json["path"]) {
    const bool good = cut.is_array() && cut.size() == 2 && cut[0].is_number_unsigned() && cut[1].is_boolean();
    if (!good) return false;
    part.path.push_back({cut[0].get<size_t>(), cut[1].get<bool>()});
  }
  for (const auto& step : json["steps"]) {
    const bool good =
        step.is_array() && step.size() == 2 && step[0].is_number() && step[1].is_number_unsigned();
    if (!good) return false;
    part.steps.push_back({step[0].get<double>(), step[1].get<size_t>()});
    if (!std::isfinite(part.steps.back().length)) return false;
  }
  return true;
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
    for (const PartRecord::Step& step : part.steps) steps.push_back({step.length, step.degree});
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
  bool good = name && json.contains("parts") && json["parts"].is_array();
  for (const auto& part : good ? json["parts"] : nlohmann::json::array())
    good = good && ReadPart(part, file.certificate.parts.emplace_back());
  if (!good) return base::Error{"the certificate is not complete"};
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
