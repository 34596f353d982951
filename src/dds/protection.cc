#include "dds/protection.h"

#include <dds/dds.h>
#include <dlfcn.h>
#include <fmt/format.h>

#include <filesystem>

#include "dds/network.h"

namespace rondo::dds {
namespace {

namespace fs = std::filesystem;

// Where a plugin is: beside the library, or in a folder of its own, as in Debian. Elsewhere the loader looks for it.
std::string Plugin(const std::string& name) {
  Dl_info found;
  if (dladdr(reinterpret_cast<void*>(&dds_create_participant), &found) != 0 && found.dli_fname != nullptr) {
    const fs::path folder = fs::path(found.dli_fname).parent_path();
    for (const fs::path& path :
         {folder / "libddsc0debian" / ("lib" + name + ".so"), folder / ("lib" + name + ".so")}) {
      std::error_code ignored;
      if (fs::exists(path, ignored)) return path.string();
    }
  }
  return name;
}

}  // namespace

void Protect(dds_qos* qos, const Keys& keys) {
  if (keys.folder.empty()) return;
  const auto set = [&](const std::string& name, const std::string& value) {
    dds_qset_prop(qos, ("dds.sec." + name).c_str(), value.c_str());
  };
  const auto plugin = [&](const char* kind, const char* file, const char* what) {
    set(fmt::format("{}.library.path", kind), Plugin(file));
    set(fmt::format("{}.library.init", kind), fmt::format("init_{}", what));
    set(fmt::format("{}.library.finalize", kind), fmt::format("finalize_{}", what));
  };
  plugin("auth", "dds_security_auth", "authentication");
  plugin("crypto", "dds_security_crypto", "crypto");
  plugin("access", "dds_security_ac", "access_control");
  const auto file = [&](const char* name) { return "file:" + (fs::absolute(keys.folder) / name).string(); };
  set("auth.identity_ca", file("identity_ca.cert.pem"));
  set("auth.identity_certificate", file("cert.pem"));
  set("auth.private_key", file("key.pem"));
  set("access.permissions_ca", file("permissions_ca.cert.pem"));
  set("access.governance", file("governance.p7s"));
  set("access.permissions", file("permissions.p7s"));
}

}  // namespace rondo::dds
