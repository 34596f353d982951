#include "security/authority.h"

#include <fmt/format.h>
#include <openssl/bio.h>
#include <openssl/ec.h>
#include <openssl/err.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/pkcs7.h>
#include <openssl/rand.h>
#include <openssl/sha.h>
#include <openssl/x509v3.h>

#include "base/hex.h"

namespace rondo::security {
namespace {

constexpr long kValid = 3650L * 24 * 3600;  // seconds
constexpr long kBefore = -24L * 3600;       // clocks of robots may be behind

template <class T, void (*Free)(T*)>
struct Deleter {
  void operator()(T* t) const { Free(t); }
};
template <class T, void (*Free)(T*)>
using Owned = std::unique_ptr<T, Deleter<T, Free>>;
void FreeList(STACK_OF(X509) * list) { sk_X509_free(list); }
using Bio = Owned<BIO, BIO_free_all>;
using Pkcs7 = Owned<PKCS7, PKCS7_free>;
using Store = Owned<X509_STORE, X509_STORE_free>;
using Extension = Owned<X509_EXTENSION, X509_EXTENSION_free>;

base::Error Failed(const std::string& what) {
  const unsigned long code = ERR_get_error();
  const char* why = code == 0 ? nullptr : ERR_reason_error_string(code);
  ERR_clear_error();
  return {why == nullptr ? what : fmt::format("{}: {}", what, why)};
}

Bio Reading(std::string_view text) {
  return Bio(BIO_new_mem_buf(text.data(), static_cast<int>(text.size())));
}

std::string Written(BIO* bio) {
  char* data = nullptr;
  const long size = BIO_get_mem_data(bio, &data);
  return {data, static_cast<size_t>(size)};
}

std::string PemOf(X509* certificate) {
  const Bio bio(BIO_new(BIO_s_mem()));
  PEM_write_bio_X509(bio.get(), certificate);
  return Written(bio.get());
}

std::string PemOf(EVP_PKEY* key) {
  const Bio bio(BIO_new(BIO_s_mem()));
  PEM_write_bio_PKCS8PrivateKey(bio.get(), key, nullptr, nullptr, 0, nullptr, nullptr);
  return Written(bio.get());
}

std::shared_ptr<EVP_PKEY> NewKey() { return {EVP_EC_gen("P-256"), EVP_PKEY_free}; }

bool Extend(X509* certificate, X509* issuer, int what, const char* value) {
  X509V3_CTX context;
  X509V3_set_ctx(&context, issuer, certificate, nullptr, nullptr, 0);
  const Extension extension(X509V3_EXT_conf_nid(nullptr, &context, what, value));
  return extension != nullptr && X509_add_ext(certificate, extension.get(), -1) == 1;
}

// @param issuer  nullptr: it signs itself, and may sign others.
std::shared_ptr<X509> Certificate(const std::string& name, EVP_PKEY* key, X509* issuer, EVP_PKEY* signer) {
  std::shared_ptr<X509> certificate(X509_new(), X509_free);
  X509* c = certificate.get();
  unsigned char serial[16];
  if (c == nullptr || RAND_bytes(serial, sizeof serial) != 1) return nullptr;
  serial[0] &= 0x7f;
  const Owned<BIGNUM, BN_free> number(BN_bin2bn(serial, sizeof serial, nullptr));
  const auto* text = reinterpret_cast<const unsigned char*>(name.c_str());
  X509_NAME* subject = X509_get_subject_name(c);
  const bool good =
      X509_set_version(c, 2) == 1 && BN_to_ASN1_INTEGER(number.get(), X509_get_serialNumber(c)) != nullptr &&
      X509_gmtime_adj(X509_getm_notBefore(c), kBefore) != nullptr &&
      X509_gmtime_adj(X509_getm_notAfter(c), kValid) != nullptr &&
      X509_NAME_add_entry_by_txt(subject, "CN", MBSTRING_UTF8, text, -1, -1, 0) == 1 &&
      X509_set_issuer_name(c, issuer == nullptr ? subject : X509_get_subject_name(issuer)) == 1 &&
      X509_set_pubkey(c, key) == 1 &&
      Extend(c, issuer == nullptr ? c : issuer, NID_basic_constraints,
             issuer == nullptr ? "critical,CA:TRUE" : "critical,CA:FALSE") &&
      X509_sign(c, signer, EVP_sha256()) > 0;
  return good ? certificate : nullptr;
}

}  // namespace

base::Result<Authority> Authority::Make(const std::string& name) {
  Authority authority;
  authority.key_ = NewKey();
  if (authority.key_ == nullptr) return Failed("cannot make a key");
  authority.certificate_ = Certificate(name, authority.key_.get(), nullptr, authority.key_.get());
  if (authority.certificate_ == nullptr) return Failed("cannot make a certificate");
  authority.identity_ = {PemOf(authority.certificate_.get()), PemOf(authority.key_.get())};
  return authority;
}

base::Result<Authority> Authority::Load(const Identity& identity) {
  Authority authority;
  authority.identity_ = identity;
  authority.certificate_ = {PEM_read_bio_X509(Reading(identity.certificate).get(), nullptr, nullptr, nullptr),
                            X509_free};
  if (authority.certificate_ == nullptr) return Failed("the certificate cannot be read");
  // No question for a password: there is nobody to answer it.
  const auto none = [](char*, int, int, void*) { return -1; };
  authority.key_ = {PEM_read_bio_PrivateKey(Reading(identity.key).get(), nullptr, none, nullptr),
                    EVP_PKEY_free};
  if (authority.key_ == nullptr) return Failed("the key cannot be read");
  if (X509_check_private_key(authority.certificate_.get(), authority.key_.get()) != 1)
    return Failed("the key is not that of the certificate");
  return authority;
}

base::Result<Identity> Authority::Issue(const std::string& name) const {
  const auto key = NewKey();
  if (key == nullptr) return Failed("cannot make a key");
  const auto certificate = Certificate(name, key.get(), certificate_.get(), key_.get());
  if (certificate == nullptr) return Failed("cannot make a certificate");
  return Identity{PemOf(certificate.get()), PemOf(key.get())};
}

bool Authority::Issued(const Identity& identity, const std::string& name) const {
  const auto loaded = Load(identity);
  if (!loaded.ok()) return false;
  X509* certificate = loaded.value().certificate_.get();
  char subject[256];
  const int length =
      X509_NAME_get_text_by_NID(X509_get_subject_name(certificate), NID_commonName, subject, sizeof subject);
  const bool good = length > 0 && name == subject && X509_verify(certificate, key_.get()) == 1;
  ERR_clear_error();
  return good;
}

base::Result<std::string> Authority::Sign(std::string_view text) const {
  constexpr int kFlags = PKCS7_DETACHED | PKCS7_STREAM | PKCS7_TEXT;
  const Bio in = Reading(text), out(BIO_new(BIO_s_mem()));
  const Pkcs7 signature(PKCS7_sign(certificate_.get(), key_.get(), nullptr, in.get(), kFlags));
  if (signature == nullptr || SMIME_write_PKCS7(out.get(), signature.get(), in.get(), kFlags) != 1)
    return Failed("cannot sign");
  return Written(out.get());
}

base::Result<std::string> Verified(std::string_view text, std::string_view certificate) {
  const std::shared_ptr<X509> authority(
      PEM_read_bio_X509(Reading(certificate).get(), nullptr, nullptr, nullptr), X509_free);
  if (authority == nullptr) return Failed("the certificate cannot be read");
  BIO* content = nullptr;
  const Pkcs7 signature(SMIME_read_PKCS7(Reading(text).get(), &content));
  const Bio in(content), out(BIO_new(BIO_s_mem()));
  if (signature == nullptr || in == nullptr) return Failed("it is not signed");
  const Store store(X509_STORE_new());
  X509_STORE_add_cert(store.get(), authority.get());
  // Only who issues may sign: a robot's certificate is good for the robot alone.
  const Owned<STACK_OF(X509), FreeList> signers(PKCS7_get0_signers(signature.get(), nullptr, 0));
  if (signers == nullptr || sk_X509_num(signers.get()) != 1 ||
      X509_cmp(sk_X509_value(signers.get(), 0), authority.get()) != 0)
    return Failed("somebody else signed it");
  if (PKCS7_verify(signature.get(), nullptr, store.get(), in.get(), out.get(), PKCS7_TEXT) != 1)
    return Failed("it is not what was signed");
  return Written(out.get());
}

std::string Sha256(std::string_view bytes) {
  unsigned char sum[SHA256_DIGEST_LENGTH];
  SHA256(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(), sum);
  return base::Hex(std::span<const uint8_t>(sum, sizeof sum));
}

}  // namespace rondo::security
