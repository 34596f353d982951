#include "choreo/prove/prove.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <mutex>
#include <set>

#include "base/file.h"
#include "base/parallel.h"
#include "solve/certify/checker.h"
#include "verdict/verdict.h"

namespace rondo::choreo {
namespace {

using Clock = std::chrono::steady_clock;

// Part of every question in the cache: a new way of deciding asks again.
constexpr std::string_view kEngine = "choreo 2";

class Proving {
 public:
  Proving(const Obligations& obligations, const Graph& graph, const expr::Arena& arena,
          const ProveOptions& options)
      : obligations_(obligations), graph_(graph), arena_(arena), options_(options) {}

  Proofs Run() {
    const size_t total = obligations_.all.size();
    proofs_.all.resize(total);
    // What bridges do matters only where a motion needs one.
    std::vector<size_t> plain, bridges;
    for (size_t i = 0; i < total; ++i) (obligations_.all[i].bridge ? bridges : plain).push_back(i);
    Decide(plain);
    FindStarts();
    Decide(bridges);
    SkipWhatNeverHappens();
    return std::move(proofs_);
  }

 private:
  void Decide(const std::vector<size_t>& which) {
    base::ParallelFor(which.size(), options_.jobs, [&](size_t k) {
      const size_t i = which[k];
      const Obligation& obligation = obligations_.all[i];
      Proof proof;
      const auto start = Clock::now();
      if (!options_.stop.StopRequested()) proof = One(obligation, i);
      proof.seconds = std::chrono::duration<double>(Clock::now() - start).count();
      proof.interrupted = proof.decision.verdict == verdict::Verdict::kUnknown && options_.stop.cancelled();
      if (proof.interrupted) proof.decision.reason = "interrupted";
      const std::scoped_lock lock(mutex_);
      proofs_.all[i] = std::move(proof);
      if (options_.progress) options_.progress(++done_, obligations_.all.size(), obligation.title);
    });
  }

  // Where all motions of a step begin exactly as their `during` does, and whether that is certified.
  void FindStarts() {
    std::set<NodeId> open;
    for (size_t i = 0; i < proofs_.all.size(); ++i) {
      const Obligation& o = obligations_.all[i];
      if (o.kind != ObligationKind::kStart) continue;
      for (const NodeId n : o.nodes) {
        const bool certified = proofs_.all[i].certified;
        const auto [it, fresh] = exact_.try_emplace(n, certified);
        if (!fresh) it->second = it->second && certified;
        if (proofs_.all[i].decision.verdict != verdict::Verdict::kProved) open.insert(n);
      }
    }
    for (const NodeId n : open) exact_.erase(n);
  }

  // A step that never begins refutes nothing; that it never begins is said anyway.
  void SkipWhatNeverHappens() {
    std::map<NodeId, bool> never;  // whether that is certified
    for (size_t i = 0; i < proofs_.all.size(); ++i) {
      const Obligation& o = obligations_.all[i];
      if (o.kind != ObligationKind::kReached || proofs_.all[i].decision.verdict != verdict::Verdict::kRefuted)
        continue;
      for (const NodeId n : o.nodes) never.emplace(n, proofs_.all[i].certified);
    }
    for (size_t i = 0; i < proofs_.all.size(); ++i) {
      const Obligation& o = obligations_.all[i];
      Decision& d = proofs_.all[i].decision;
      const bool there =
          !o.nodes.empty() && std::ranges::all_of(o.nodes, [&](NodeId n) { return never.contains(n); });
      if (o.kind == ObligationKind::kReached || !there || d.verdict != verdict::Verdict::kRefuted) continue;
      d.verdict = verdict::Verdict::kProved;
      d.reason.clear();
      proofs_.all[i].certified = std::ranges::all_of(o.nodes, [&](NodeId n) { return never.at(n); });
    }
  }

  std::string QuestionOf(const Obligation& obligation) const {
    solve::Query query;
    query.arena = &arena_;
    query.assertions = {{obligation.formula, ""}};
    if (obligation.rest != arena_.True()) query.assertions.push_back({obligation.rest, ""});
    return solve::ToSmtLib(query, expr::SmtFunctions::kNamed);
  }

  Proof One(const Obligation& obligation, size_t number) {
    Proof proof;
    const auto exact = [&](NodeId n) { return exact_.contains(n); };
    if (obligation.bridge && std::ranges::all_of(obligation.nodes, exact)) {
      proof.decision.verdict = verdict::Verdict::kProved;
      proof.certified = std::ranges::all_of(obligation.nodes, [&](NodeId n) { return exact_.at(n); });
      return proof;
    }
    const bool asks = options_.cache != nullptr || !options_.smt_out.empty();
    const std::string question = asks ? QuestionOf(obligation) : std::string();
    if (!options_.smt_out.empty() && !obligation.keeping) {
      Write(options_.smt_out / fmt::format("{:04}-{}.smt2", number + 1, KindName(obligation.kind)),
            fmt::format("; {}\n(set-info :status {})\n{}", obligation.title,
                        obligation.satisfiable ? "sat" : "unsat", question));
    }
    const bool certify = options_.limits.certificates;
    const std::string key = fmt::format("; {}{}{}\n{}", kEngine,
                                        obligation.satisfiable ? ", sat"
                                        : obligation.keeping   ? ", kept"
                                                               : "",
                                        certify ? "" : ", not certified", question);
    if (options_.cache != nullptr && options_.certificates.empty() && options_.cache->Find(key)) {
      proof.decision.verdict = verdict::Verdict::kProved;
      proof.cached = true;
      proof.certified = certify;
      return proof;
    }
    // What cannot be certified is tried again without rewriting over rotated frames: a plainer proof.
    std::string rejected;
    for (const bool lemmas : {true, false}) {
      solve::icp::Options engine;
      engine.lemmas = lemmas;
      proof.decision =
          choreo::Decide(obligation, *graph_.world, arena_, engine, options_.limits, options_.stop);
      if (proof.decision.verdict != verdict::Verdict::kProved || !certify) break;
      rejected = Certify(proof, obligation, number);
      if (rejected.empty()) break;
    }
    if (!rejected.empty()) {
      proof.decision.verdict = verdict::Verdict::kUnknown;
      proof.decision.reason = "its certificate was rejected";
      const std::scoped_lock lock(mutex_);
      proofs_.bug = true;
      proofs_.problems.push_back(
          fmt::format("the certificate of \"{}\" was rejected: {}", obligation.title, rejected));
    }
    // That a step never begins proves what would fail in it.
    if (proof.decision.verdict == verdict::Verdict::kRefuted && obligation.kind == ObligationKind::kReached &&
        certify)
      Certify(proof, obligation, number);
    if (proof.decision.verdict != verdict::Verdict::kProved) return proof;
    if (options_.cache != nullptr && proof.certified == certify)
      options_.cache->Store(key, {std::string(kEngine), {}});
    return proof;
  }

  // A proof that the checker does not accept is none. Why it does not; empty if it does, or had no time.
  std::string Certify(Proof& proof, const Obligation& obligation, size_t number) {
    const base::StopToken stop = options_.stop.WithDeadline(Clock::now() + options_.limits.time);
    auto& certificates = proof.decision.certificates;
    for (size_t i = 0; i < certificates.size(); ++i) {
      if (!options_.certificates.empty()) {
        Write(options_.certificates /
                  fmt::format("{:04}-{}-{}.cert", number + 1, KindName(obligation.kind), i + 1),
              fmt::format("; {}\n{}", obligation.title, certificates[i]));
      }
      diag::SourceSet sources;
      diag::Diagnostics diagnostics;
      solve::certify::Certificate certificate;
      solve::certify::ReadCertificate(sources, sources.Add("certificate", certificates[i]), certificate,
                                      diagnostics);
      solve::certify::Tally tally;
      if (!diagnostics.has_errors()) tally = solve::certify::Check(certificate, diagnostics, stop);
      if (tally.stopped) return "";  // proved, and not certified
      if (diagnostics.has_errors()) return diagnostics.all()[0].message;
    }
    proof.certified = true;
    certificates.clear();  // they are large
    certificates.shrink_to_fit();
    return "";
  }

  void Write(const std::filesystem::path& path, const std::string& text) {
    const auto written = base::WriteFileAtomically(path, text);
    if (written.ok()) return;
    const std::scoped_lock lock(mutex_);
    proofs_.problems.push_back(fmt::format("{}: {}", path.string(), written.error().message));
  }

  const Obligations& obligations_;
  const Graph& graph_;
  const expr::Arena& arena_;
  const ProveOptions& options_;
  std::mutex mutex_;
  Proofs proofs_;
  size_t done_ = 0;
  std::map<NodeId, bool> exact_;  // steps without bridges; whether that is certified
};

}  // namespace

Proofs Prove(const Obligations& obligations, const Graph& graph, const expr::Arena& arena,
             const ProveOptions& options) {
  return Proving(obligations, graph, arena, options).Run();
}

}  // namespace rondo::choreo
