#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/parallel.h"
#include "contracts/tube_certificate.h"
#include "driver/command.h"
#include "driver/terminal.h"
#include "driver/verbs.h"
#include "solve/certify/checker.h"
#include "solve/script/script_run.h"
#include "workspace/session.h"

namespace rondo::driver {

using verdict::ExitStatus;

namespace {

struct Options {
  std::vector<std::string> files;
  std::string script;
  unsigned jobs = 0;
  bool json = false;
};

// A certificate of `rondo reach`. What is wrong with it is reported.
reach::certify::Acceptance Tube(const std::string& path, diag::FileId file, workspace::Session& session,
                                const base::StopToken& stop) {
  // No place: such a file is one long line.
  const auto reject = [&](const std::string& message) -> diag::Diagnostic& {
    return session.diagnostics.Report(diag::Kind::kCertificateRejected, {},
                                      fmt::format("`{}`: {}", path, message));
  };
  const auto tube = contracts::ReadTube(session.sources.text(file));
  if (!tube.ok()) {
    reject(tube.error().message);
    return {};
  }
  auto verdict = contracts::CheckTube(tube.value(), session, stop);
  if (!verdict.ok()) {
    reject(verdict.error().message);
    return {};
  }
  if (!verdict.value().accepted && !stop.cancelled())
    reject(fmt::format("it does not show `{}`", tube.value().contract)).Note(verdict.value().reason);
  return verdict.value();
}

// A certificate, and what its check says.
struct Checked {
  std::string path;
  diag::FileId file;
  bool tube = false;
  diag::Diagnostics diagnostics;
  solve::certify::Tally tally;
};

// Of `rondo solve`: may be checked beside others.
void Refutation(Checked& one, const diag::SourceSet& sources, const std::vector<std::string>& questions,
                const std::string& script, const base::StopToken& stop) {
  solve::certify::Certificate certificate;
  solve::certify::ReadCertificate(sources, one.file, certificate, one.diagnostics);
  if (!one.diagnostics.has_errors()) one.tally = solve::certify::Check(certificate, one.diagnostics, stop);
  const std::string_view whole = sources.text(one.file);
  // The text of the question, and no command behind it.
  const bool other = !script.empty() && std::ranges::none_of(questions, [&](const std::string& q) {
    return whole.starts_with(q) && std::ranges::all_of(certificate.script.commands, [&](const auto& command) {
             return command.span.begin < q.size();
           });
  });
  if (other) {
    one.diagnostics.Report(diag::Kind::kCertificateRejected, {one.file, 0, 1},
                           fmt::format("`{}` asks something else", script));
  }
}

ExitStatus Run(const Options& options) {
  workspace::Session session;
  std::vector<std::string> questions;
  if (!options.script.empty()) {
    const auto file = workspace::ReadSource(options.script, workspace::Wanted::kText, session);
    lang::smtlib::Script script;
    if (file) lang::smtlib::ReadScript(session.sources, *file, script, session.diagnostics);
    if (!session.diagnostics.has_errors()) questions = solve::script::Questions(script);
  }
  base::StopToken stop;
  const InterruptScope interrupt(stop);
  std::vector<Checked> all;
  for (const std::string& path : options.files) {
    const auto file = workspace::ReadSource(path, workspace::Wanted::kText, session);
    if (file) all.push_back({path, *file, contracts::IsTube(session.sources.text(*file)), {}, {}});
  }
  base::ParallelFor(all.size(), options.jobs, [&](size_t i) {
    if (!all[i].tube) Refutation(all[i], session.sources, questions, options.script, stop);
  });
  nlohmann::json list = nlohmann::json::array();
  std::string text;
  bool stopped = false;
  for (const Checked& one : all) {
    if (one.tube) {
      if (!options.script.empty()) {
        session.diagnostics.Report(diag::Kind::kCertificateRejected, {one.file, 0, 1},
                                   "a certificate of a contract is about no script");
        continue;
      }
      const auto verdict = Tube(one.path, one.file, session, stop);
      stopped = stopped || stop.cancelled();
      list.push_back({{"file", one.path},
                      {"accepted", verdict.accepted},
                      {"steps", verdict.steps},
                      {"boxes", verdict.boxes}});
      if (!verdict.accepted) continue;
      text += fmt::format("{}: accepted: the contract holds ({} {})\n", one.path,
                          verdict.steps > 0 ? verdict.steps : verdict.boxes,
                          verdict.steps > 0 ? "steps" : "boxes");
      continue;
    }
    stopped = stopped || one.tally.stopped;
    const bool accepted = !one.diagnostics.has_errors() && !one.tally.stopped;
    for (const diag::Diagnostic& d : one.diagnostics.all())
      session.diagnostics.Report(d.kind, d.span, d.message) = d;
    list.push_back({{"file", one.path},
                    {"accepted", accepted},
                    {"assertions", one.tally.assertions},
                    {"cases", one.tally.cases},
                    {"boxes", one.tally.boxes}});
    if (!accepted) continue;
    text += fmt::format("{}: accepted: the {} assertions have no common solution ({} cases, {} boxes)\n",
                        one.path, one.tally.assertions, one.tally.cases, one.tally.boxes);
  }
  const bool good = !session.diagnostics.has_errors() && !stopped;
  if (options.json) {
    const nlohmann::json diagnostics = diag::RenderJson(session.sources, session.diagnostics);
    PrintJson({{"command", "certify"},
               {"status", good ? ExitStatus::kEstablished : ExitStatus::kRejected},
               {"files", list},
               {"diagnostics", diagnostics}});
  } else {
    Print(text);
    PrintDiagnostics(session.sources, session.diagnostics);
  }
  if (stopped && !session.diagnostics.has_errors()) return ExitStatus::kUndecided;
  return good ? ExitStatus::kEstablished : ExitStatus::kRejected;
}

}  // namespace

void AddCertifyVerb(CLI::App& app, ExitStatus& status) {
  auto options = std::make_shared<Options>();
  Command verb(app, "certify",
               "check certificates: of `rondo solve --cert`, `rondo prove` and `rondo reach`");
  verb.Option("FILE", options->files,
              "certificates: a script and its refutation, or a contract and how it was proved")
      .Required();
  verb.Option("--of", options->script, "the script that the certificate should be about");
  verb.Option("--jobs", options->jobs, "how many are checked at the same time; default: one for each core");
  verb.Flag("--json", options->json, "the result as JSON on standard output");
  verb.Footer(
      "example: rondo solve --cert it.cert examples/smt/rectangles.smt2\n"
      "         rondo certify --of examples/smt/rectangles.smt2 it.cert\n"
      "         rondo reach examples/reach/van_der_pol.rondo --certificates proofs\n"
      "         rondo certify proofs/*.tube.json\n"
      "\n"
      "The checkers share no code with the searches. That of refutations has normal forms and interval arithmetic (MPFR)\n"
      "of its own; that of contracts reads them from their files again, and integrates in another way.\n"
      "exit status: 0 every certificate is accepted, 1 one is not, 3 interrupted");
  verb.Run([options, &status] { status = Run(*options); });
}

}  // namespace rondo::driver
