#include "diag/registry_tables.h"

namespace rondo::diag {
namespace {

constexpr KindInfo kTable[] = {
    {Kind::kFileUnreadable, "file-unreadable", Severity::kError, "a file that cannot be read",
     "The file is missing, is a folder, or may not be read; the message has the words of the system. Everything that does not depend "
     "on it is\n"
     "checked all the same.",
     "Step:\n    eff:\n        stop\n", "check"},
};

}  // namespace

std::span<const KindInfo> FileKinds() { return kTable; }

}  // namespace rondo::diag
