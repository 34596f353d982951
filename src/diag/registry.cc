#include <array>

#include "base/check.h"
#include "diag/kind.h"
#include "diag/registry_tables.h"

namespace rondo::diag {
namespace {

constexpr size_t kKinds = static_cast<size_t>(Kind::kCount_);

std::array<KindInfo, kKinds> BuildTable() {
  std::array<KindInfo, kKinds> table{};
  for (const auto family : {FileKinds(), SyntaxKinds(), SmtKinds(), RobotKinds(), ChoreoKinds(),
                            ChoreoProofKinds(), ProcessKinds(), KoordNameKinds(), KoordTypeKinds(),
                            KoordControlKinds(), KoordProofKinds(), KoordRunKinds(), ReachKinds()}) {
    for (const KindInfo& info : family) table[static_cast<size_t>(info.kind)] = info;
  }
  for (size_t i = 0; i < kKinds; ++i) CHECK(!table[i].id.empty()) << "no registry entry for kind " << i;
  return table;
}

const std::array<KindInfo, kKinds>& Table() {
  static const std::array<KindInfo, kKinds> table = BuildTable();
  return table;
}

}  // namespace

const KindInfo& Info(Kind kind) { return Table()[static_cast<size_t>(kind)]; }

const KindInfo* FindKind(std::string_view id) {
  for (const KindInfo& info : Table()) {
    if (info.id == id) return &info;
  }
  return nullptr;
}

std::span<const KindInfo> AllKinds() { return Table(); }

std::string_view SeverityName(Severity severity) {
  switch (severity) {
    case Severity::kError:
      return "error";
    case Severity::kWarning:
      return "warning";
    case Severity::kNote:
      return "note";
  }
  return "";
}

}  // namespace rondo::diag
