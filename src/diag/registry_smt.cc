#include "diag/registry_tables.h"

namespace rondo::diag {
namespace {

constexpr KindInfo kTable[] = {
    {Kind::kSmtSyntax, "smt-syntax", Severity::kError, "a command or term of SMT-LIB that cannot be read",
     "Scripts are lists in parentheses; each command and each operator has a fixed form, which the message names.\n"
     "Reading goes on behind the list, so that one mistake hides no other.",
     "(declare-fun x () Real)\n(assert (>= x 1)\n", "solve"},
    {Kind::kSmtUndeclared, "smt-undeclared", Severity::kError,
     "a name that is not declared, or declared twice",
     "Every variable is declared once, before it is used: `(declare-fun x () Real)`. Definitions made with\n"
     "`define-fun` share the same names.",
     "(declare-fun speed () Real)\n(assert (>= sped 1))\n(check-sat)\n", "solve"},
    {Kind::kSmtSort, "smt-sort", Severity::kError, "a term of the wrong sort, or a wrong number of arguments",
     "Formulas are of sort Bool, numbers of sort Int or Real; an Int becomes a Real where one is needed, never the\n"
     "other way round.",
     "(declare-fun x () Real)\n(assert (and x true))\n(check-sat)\n", "solve"},
    {Kind::kSmtUnsupported, "smt-unsupported", Severity::kError, "a part of SMT-LIB that Rondo does not read",
     "`rondo solve` reads quantifier-free scripts over Real, Int and Bool with elementary functions: the dialect of\n"
     "dReal. Functions without interpretation, arrays, bit vectors and quantifiers are not part of it.",
     "(declare-fun f (Real) Real)\n(check-sat)\n", "solve"},
    {Kind::kCertificateRejected, "certificate-rejected", Severity::kError,
     "a certificate that does not show what it should",
     "A certificate refutes the assertions above its proof step by step. The checker knows nothing of how it was\n"
     "found: it accepts a step only if it can establish it with its own arithmetic. A rejected certificate says\n"
     "nothing about the assertions; if `rondo solve` wrote it as it is, that is a bug of Rondo.\n"
     "\n"
     "A certificate of `rondo reach` names a contract and says how its tube was computed. The contract is read\n"
     "from its file again and must be shown as it stands there now; a checker that integrates less sharply\n"
     "than the prover may fail to show what is true.",
     "(declare-fun x () Real)\n(assert (<= x 1.0))\n(contradiction)\n", "certify"},
};

}  // namespace

std::span<const KindInfo> SmtKinds() { return kTable; }

}  // namespace rondo::diag
