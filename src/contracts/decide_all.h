#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "contracts/decide.h"
#include "contracts/load.h"
#include "contracts/ranges.h"
#include "contracts/tube_reuse.h"
#include "solve/cache/proof_cache.h"

/// Decides all contracts of some files.
namespace rondo::contracts {

/// Says how contracts are decided, and what else is wanted of them.
struct DecideAllOptions {
  DecideOptions each;              ///< of every contract; its progress is not used
  std::vector<std::string> files;  ///< that the contracts were loaded from, for certificates
  std::string spec;
  std::filesystem::path certificates;  ///< a folder for them; empty: they are checked and forgotten
  std::vector<std::string> ranges;     ///< quantities whose ranges are asked for, in the language of models
  std::optional<std::pair<expr::Rational, expr::Rational>> between;  ///< seconds; of the ranges
  std::function<void(const std::string&)> progress;                  ///< what is being done
  /// Is called with the number of each contract as soon as it is done with, so that what was found is kept even if a
  /// later one is interrupted.
  std::function<void(size_t)> decided;
};

/// Decides contracts one after the other, has each proof certified, and keeps it for other proofs. A contract
/// that is the same as one before, but for a place, is proved by its tube.
class DecideAll {
 public:
  DecideAll(LoadedContracts& loaded, const DecideAllOptions& options, const solve::cache::ProofCache& cache)
      : loaded_(loaded), options_(options), cache_(cache) {}

  /// Decides all contracts; the results are in `loaded`. Ends early when stopped; what was not begun says so.
  void Run(const base::StopToken& stop);

  const std::vector<Ranges>& ranges() const { return ranges_; }  ///< by contract, if any were asked for
  /// Reports whether there is a proof whose ranges could not be given.
  bool wrong_range() const { return wrong_range_; }
  const std::vector<std::string>& certificates() const { return certificates_; }  ///< paths, written
  const std::vector<std::string>& failures() const { return failures_; }  ///< to write one, for people

 private:
  void One(size_t index, const base::StopToken& stop);
  void Save(size_t index, const reach::certify::Certificate& certificate);
  void Say(size_t index, const std::string& what) const;

  LoadedContracts& loaded_;
  const DecideAllOptions& options_;
  const solve::cache::ProofCache& cache_;
  TubeReuse reuse_;
  std::vector<Ranges> ranges_;
  std::vector<std::string> certificates_, failures_;
  bool wrong_range_ = false;
};

}  // namespace rondo::contracts
