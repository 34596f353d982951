#include "contracts/decide_all.h"

#include <fmt/format.h>

#include <algorithm>

#include "contracts/discharge.h"
#include "contracts/tube_certificate.h"
#include "workspace/places.h"

namespace rondo::contracts {

void DecideAll::Run(const base::StopToken& stop) {
  if (!options_.ranges.empty()) ranges_.resize(loaded_.results.size());
  for (size_t i = 0; i < loaded_.results.size(); ++i) One(i, stop);
}

void DecideAll::Say(size_t index, const std::string& what) const {
  if (!options_.progress) return;
  options_.progress(fmt::format("[{}/{}] {}{}", index + 1, loaded_.results.size(),
                                loaded_.results[index].made.problem.name, what));
}

void DecideAll::One(size_t index, const base::StopToken& stop) {
  ContractResult& r = loaded_.results[index];
  DecideOptions options = options_.each;
  options.progress = [&](size_t done, size_t open) {
    Say(index, fmt::format(": {} parts proved, {} open", done, open));
  };
  Say(index, "");
  // The same motion elsewhere, or of another robot of the same type, is proved already.
  TubeReuse::Cover cover;
  if (options_.ranges.empty()) cover = reuse_.Covers(r);
  r.same_as = cover.contract;
  r.certified = cover.certified;
  if (r.same_as.empty()) DecideContract(r, options, stop);
  if (r.outcome && std::holds_alternative<reach::Proved>(*r.outcome))
    cover.certificate = CertificateOf(std::get<reach::Proved>(*r.outcome));
  if (cover.certificate && options.certify && !stop.cancelled()) {
    Say(index, ": certifying");
    CertifyContract(r, *cover.certificate, options.jobs, stop);
    if (r.IsCertified() && !options_.certificates.empty()) Save(index, *cover.certificate);
  }
  if (!options_.ranges.empty()) {
    Say(index, ": ranges");
    ranges_[index] = RangesOf(r, options_.ranges, options_.between, options.jobs, stop);
    wrong_range_ =
        wrong_range_ || (VerdictOf(r) == verdict::Verdict::kProved && !ranges_[index].trouble.empty());
  }
  StoreProved(r, cache_);
  if (index + 1 < loaded_.results.size() && cover.certificate)
    reuse_.Remember(r, std::move(*cover.certificate));
  if (options_.decided) options_.decided(index);
}

void DecideAll::Save(size_t index, const reach::certify::Certificate& certificate) {
  const std::string& name = loaded_.results[index].made.problem.name;
  std::filesystem::path path = options_.certificates / (workspace::FileName(name) + ".tube.json");
  if (std::ranges::find(certificates_, path.string()) != certificates_.end())
    path.replace_filename(fmt::format("{}-{}.tube.json", workspace::FileName(name), index + 1));
  std::error_code ignored;
  std::filesystem::create_directories(path.parent_path(), ignored);
  const auto written = SaveTube(path.string(), {options_.files, options_.spec, name, certificate});
  if (written.ok()) {
    certificates_.push_back(path.string());
  } else {
    failures_.push_back(fmt::format("cannot write `{}`: {}", path.string(), written.error().message));
  }
}

}  // namespace rondo::contracts
