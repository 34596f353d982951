#include "diag/registry_tables.h"

namespace rondo::diag {
namespace {

constexpr KindInfo kTable[] = {
    {Kind::kFileUnreadable, "file-unreadable", Severity::kError, "a file that cannot be read",
     "The file is missing, is a folder, or may not be read; the message has the words of the system. Everything that does not depend "
     "on it is\n"
     "checked all the same.",
     "Step:\n    eff:\n        stop\n", "check"},
    {Kind::kFileKind, "file-kind", Severity::kError, "a file of another kind than the one that is needed",
     "What the file is, is told by its content: a trace, a picture, a robot in XML, a choreography where a Koord program should be.\n"
     "Programs and fleets are text in UTF-8. The message says what the file is, and, if there is one, the verb that takes it.",
     "<?xml version=\"1.0\"?>\n<robot name=\"arm\">\n</robot>\n", "check"},
    {Kind::kFileMore, "file-more", Severity::kNote, "there are more errors than are shown",
     "Of each file the first twenty errors are shown, and twenty warnings. They often follow from the first ones: mend those, and look again.",
     "1 $ $ $ $ $ $ $ $ $ $ $ $ $ $ $ $ $ $ $ $ $ $ $ $\n", "check"},
};

}  // namespace

std::span<const KindInfo> FileKinds() { return kTable; }

}  // namespace rondo::diag
