#pragma once

#include <string>

#include "base/result.h"
#include "contracts/load.h"

/// Writes, reads and checks certificates of tubes (docs/theory.md, "Certificates of tubes").
namespace rondo::contracts {

/// Returns what a proof leaves to be checked.
reach::certify::Certificate CertificateOf(const reach::Proved& proved);

/// Has the certificate checked, as one of this contract; the verdict of the checker goes into the result.
void CertifyContract(ContractResult& result, const reach::certify::Certificate& certificate, unsigned jobs,
                     const base::StopToken& stop);

/// Holds a certificate as `rondo reach --certificates` writes it and `rondo certify` reads it: which contract
/// of which files, and how it was proved. The contract is read from its files again when it is checked.
struct TubeFile {
  std::vector<std::string> files;
  std::string spec;
  std::string contract;
  reach::certify::Certificate certificate;
};

/// Writes the file as a whole or not at all.
/// @error if it cannot be written.
base::Result<bool> SaveTube(const std::string& path, const TubeFile& file);
/// Reports whether this should be the text of such a file. (Scripts begin with a parenthesis or a comment.)
bool IsTube(std::string_view text);
/// Reads the text of such a file.
/// @error says what is wrong with the text.
base::Result<TubeFile> ReadTube(std::string_view text);

/// Reads the contract and checks the certificate. Errors of its files are reported in the session.
///
/// @error if there is no such contract (any more).
base::Result<reach::certify::Acceptance> CheckTube(const TubeFile& file, workspace::Session& session,
                                                   const base::StopToken& stop);

}  // namespace rondo::contracts
