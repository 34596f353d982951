// Where partial functions are defined: a normal form must not say less of that than what is written.
#include <algorithm>

#include "expr/elementary.h"
#include "expr/substitute.h"
#include "solve/certify/arithmetic/normal.h"

namespace rondo::solve::certify {

using expr::Elementary;
using expr::Op;

std::optional<Normal::Key> Normal::KeyOf(Elementary function, PolyId argument) {
  if (!expr::IsPartialFunction(function)) return std::nullopt;
  if (function != Elementary::kSqrt) return Key{function, argument};
  // Where a root is defined does not depend on the scale of its argument.
  Poly p = poly(argument);
  if (p.size() == 1 && p.begin()->first.size() == 1 && Rational(0) < p.begin()->second) {
    // max(..., c) >= 0 for a number c >= 0
    const Atom& a = atoms_[p.begin()->first[0].index()];
    const bool max = a.kind == Atom::Kind::kFunction && a.function == Elementary::kMax;
    for (size_t i = 0; max && i < a.args.size(); ++i) {
      if (const auto value = ConstantOf(poly(a.args[i])); value && *value >= Rational(0)) return std::nullopt;
    }
  }
  if (const auto value = ConstantOf(p); value && *value >= Rational(0)) return std::nullopt;
  const Rational lead = p.begin()->second;
  const Rational scale = Rational(1) / (lead < Rational(0) ? Rational(0) - lead : lead);
  for (auto& [m, c] : p) c = c * scale;
  return Key{function, Intern(std::move(p))};
}

// What must be defined for the polynomial to have a value: partial functions, and choices, of which only the
// taken branch counts.
void Normal::KeysOf(PolyId id, std::set<Key>& keys, std::set<PolyId>& seen) {
  if (!seen.insert(id).second) return;
  const Poly p = poly(id);
  for (const auto& [m, c] : p) {
    for (const AtomId a : m) {
      const Atom atom = atoms_[a.index()];
      if (atom.kind == Atom::Kind::kChoice) {
        keys.insert({Elementary::kCount_, AtomPoly(atom)});
        continue;
      }
      if (atom.kind == Atom::Kind::kFunction) {
        if (const auto key = KeyOf(atom.function, atom.args[0])) keys.insert(*key);
      }
      for (const PolyId arg : atom.args) KeysOf(arg, keys, seen);
    }
  }
}

bool Normal::HasPartial(TermId term) {
  std::unordered_set<TermId> seen;
  bool found = false;
  expr::VisitPostorder(arena_, term, seen, [&](TermId t) {
    found = found || (arena_.op(t) == Op::kElementary && expr::IsPartialFunction(arena_.elementary_of(t)));
  });
  return found;
}

// The same of a term as it is written; false if a branch or condition of a choice says more than its normal
// form.
bool Normal::Written(TermId term, std::set<Key>& keys, std::unordered_set<TermId>& seen) {
  if (!seen.insert(term).second) return true;
  const Op op = arena_.op(term);
  if (op == Op::kIte) {
    if (!HasPartial(term)) return true;
    keys.insert({Elementary::kCount_, Number(term)});
    return Faithful(arena_.arg(term, 0)) && FaithfulNumber(arena_.arg(term, 1)) &&
           FaithfulNumber(arena_.arg(term, 2));
  }
  // A value that is known exactly is defined.
  if (op == Op::kElementary && expr::IsPartialFunction(arena_.elementary_of(term)) &&
      !ConstantOf(poly(Number(term)))) {
    if (const auto key = KeyOf(arena_.elementary_of(term), Number(arena_.arg(term, 0)))) keys.insert(*key);
  }
  return std::ranges::all_of(arena_.args(term), [&](TermId a) { return Written(a, keys, seen); });
}

bool Normal::Keeps(const std::vector<TermId>& terms, PolyId normal) {
  std::set<Key> written, kept;
  std::unordered_set<TermId> seen;
  for (const TermId t : terms) {
    if (!Written(t, written, seen)) return false;
  }
  std::set<PolyId> visited;
  if (normal.valid()) KeysOf(normal, kept, visited);
  return std::includes(kept.begin(), kept.end(), written.begin(), written.end());
}

bool Normal::FaithfulNumber(TermId term) { return Keeps({term}, Number(term)); }

bool Normal::FaithfulLiteral(TermId literal) {
  return Keeps({arena_.arg(literal, 0), arena_.arg(literal, 1)}, formula(Of(literal)).poly);
}

bool Normal::Faithful(TermId t) {
  if (const auto it = faithful_.find(t); it != faithful_.end()) return it->second;
  bool result = true;
  switch (arena_.op(t)) {
    case Op::kNot:
    case Op::kAnd:
    case Op::kOr:
    case Op::kIte:
      result = std::ranges::all_of(arena_.args(t), [this](TermId a) { return Faithful(a); });
      break;
    case Op::kEq:
      result = arena_.sort_of(arena_.arg(t, 0)) == arena_.Bool()
                   ? Faithful(arena_.arg(t, 0)) && Faithful(arena_.arg(t, 1))
                   : FaithfulLiteral(t);
      break;
    case Op::kLe:
    case Op::kLt:
      result = FaithfulLiteral(t);
      break;
    default:
      break;  // constants and variables
  }
  faithful_.emplace(t, result);
  return result;
}

}  // namespace rondo::solve::certify
