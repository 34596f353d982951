#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "base/result.h"

struct evp_pkey_st;
struct x509_st;

/// Keys of robots, and what their owner signs (OpenSSL; the forms that DDS Security 1.1 asks for).
namespace rondo::security {

/// Holds what somebody is known by: a certificate (X.509) and the private key of it, both as PEM.
struct Identity {
  std::string certificate, key;
};

/// Issues identities, and signs texts: whoever has its key decides who belongs to a fleet. Keys are of the curve P-256.
class Authority {
 public:
  /// Makes one with a key that nobody had before; its certificates are good for ten years.
  static base::Result<Authority> Make(const std::string& name);
  /// Takes one from its PEM. @error if the key is not that of the certificate, or they cannot be read.
  static base::Result<Authority> Load(const Identity& identity);

  /// Returns a certificate for that name (`CN=NAME`, a serial number that no other has), and a fresh key.
  base::Result<Identity> Issue(const std::string& name) const;
  /// Reports whether this is a certificate that it issued for that name, and its key.
  bool Issued(const Identity& identity, const std::string& name) const;
  /// Returns a text with its signature: S/MIME, `multipart/signed`.
  base::Result<std::string> Sign(std::string_view text) const;

  const Identity& identity() const { return identity_; }

 private:
  Authority() = default;
  Identity identity_;
  std::shared_ptr<evp_pkey_st> key_;
  std::shared_ptr<x509_st> certificate_;
};

/// Returns the text in what was signed, if it is the authority with that certificate who did. @error otherwise.
base::Result<std::string> Verified(std::string_view text, std::string_view certificate);

/// Returns the SHA-256 of some bytes, as hexadecimal digits.
std::string Sha256(std::string_view bytes);

}  // namespace rondo::security
