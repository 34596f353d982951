#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "diag/diagnostic.h"
#include "driver/koord_load.h"
#include "driver/motion.h"
#include "reach/certify/checker.h"
#include "reach/validated/prover.h"
#include "robot/reach/motion_problem.h"

namespace rondo::driver {

/// One contract, and what became of it.
struct ContractResult {
  robot::MotionProblem made;
  diag::Span span;                        ///< of the motion
  std::string impossible;                 ///< why there is no problem to decide, if there is none
  std::optional<reach::Outcome> outcome;  ///< nothing: not begun
  double seconds = 0;
  std::optional<reach::certify::Verdict> certified;  ///< of a proof, by the checker; nothing: not asked
  double certify_seconds = 0;

  bool IsCertified() const { return certified && certified->accepted; }
  std::vector<std::string> domain;        ///< what else a proof is limited to
  const choreo::Graph* graph = nullptr;   ///< of a choreography's motion
  std::string motion;                     ///< `Type.Motion`
  std::string model;                      ///< of a port: by which robot type
  std::string same_as;                    ///< the contract whose tube shows this one, too
  std::vector<std::string> anywhere;      ///< parameters that may have any value: it is the same contract
  std::optional<reach::Problem> at_zero;  ///< with zero for each of them: kept if and only if this one is
};

/// The contracts of the motions that choreographies use; without any, of all robot types, as far as they have
/// controllers or dynamics and their parameters have values or ranges.
/// `reduce`: use that places do not matter, where they do not, but keep the parameter `keep`. `left_out`:
/// motions of robot types that cannot be looked at alone, and why.
std::vector<ContractResult> ContractsOf(Motion& motion, bool reduce = true, std::string_view keep = "",
                                        std::vector<std::string>* left_out = nullptr);

/// The models that the platforms of a Koord program name, read from their files.
struct Platforms {
  std::vector<std::unique_ptr<Motion>> files;
  std::vector<std::unique_ptr<robot::World>> worlds;
};

/// The controller assumptions of the program whose modules have a platform.
/// `loose`: a parameter of the program or of the models that may have any value between two bounds.
std::vector<ContractResult> PortContractsOf(const LoadedKoord& koord, Platforms& platforms, Session& session,
                                            const robot::Loose* loose = nullptr);

/// Files with contracts, and what they are about.
struct LoadedContracts {
  std::unique_ptr<LoadedKoord> koord;
  std::unique_ptr<Motion> motion;
  Platforms platforms;
  std::vector<ContractResult> results;
  std::vector<std::string> left_out;  ///< motions that cannot be looked at alone, and why
};

/// The contracts of robots and choreographies (`.rondo`), or of one Koord program. False after an error.
/// `reduce`: as for ContractsOf; `loose` is kept.
bool LoadContracts(const std::vector<std::string>& files, const std::string& spec, const robot::Loose* loose,
                   bool reduce, Session& session, LoadedContracts& loaded);

/// Decides one contract, within so many seconds.
struct DecideOptions {
  double timeout = 60;
  unsigned jobs = 0;
  uint64_t seed = 1;
  bool certify = true;  ///< of sweeps: have what is proved checked
  std::function<void(size_t, size_t)> progress;
};
void DecideContract(ContractResult& result, const DecideOptions& options, const base::StopToken& stop);

int StatusOf(const ContractResult& result);
std::string_view VerdictOf(const ContractResult& result);
/// Reports what is refuted or open.
void ReportContract(const ContractResult& result, diag::Diagnostics& diagnostics);
std::string ContractTable(const std::vector<ContractResult>& results);
nlohmann::json ToJson(const ContractResult& result);

}  // namespace rondo::driver
