// Where partial functions are defined: a normal form must not say less of that than what is written.
#include <algorithm>

#include "expr/substitute.h"
#include "solve/certify/normal.h"

namespace rondo::solve::certify {

using expr::Elementary;
using expr::Op;

namespace {

bool IsPartial(Elementary f) {
  return f == Elementary::kSqrt || f == Elementary::kLog || f == Elementary::kAsin || f == Elementary::kAcos;
}

}  // namespace

std::optional<Normal::Key> Normal::KeyOf(Elementary function, PolyId argument) {
  if (!IsPartial(function)) return std::nullopt;
  if (function != Elementary::kSqrt) return Key{function, argument};
  // Where a root is defined does not depend on the scale of its argument.
  Poly p = poly(argument);
  if (const auto value = ConstantOf(p); value && *value >= Rational(0)) return std::nullopt;
  const Rational lead = p.begin()->second;
  const Rational scale = Rational(1) / (lead < Rational(0) ? Rational(0) - lead : lead);
  for (auto& [m, c] : p) c = c * scale;
  return Key{function, Intern(std::move(p))};
}

void Normal::KeysOf(PolyId id, std::set<Key>& keys) {
  const Poly p = poly(id);
  for (const auto& [m, c] : p) {
    for (const AtomId a : m) {
      const Atom atom = atoms_[a.index()];
      if (atom.kind == Atom::Kind::kFunction) {
        if (const auto key = KeyOf(atom.function, atom.args[0])) keys.insert(*key);
      }
      if (atom.kind == Atom::Kind::kChoice) KeysOf(atom.condition, keys);
      for (const PolyId arg : atom.args) KeysOf(arg, keys);
    }
  }
}

void Normal::KeysOf(FormulaId id, std::set<Key>& keys) {
  const Formula f = formula(id);
  if (f.kind == Formula::Kind::kLiteral) KeysOf(f.poly, keys);
  for (const FormulaId part : f.parts) KeysOf(part, keys);
}

std::set<Normal::Key> Normal::Written(TermId term) {
  std::set<Key> written;
  std::unordered_set<TermId> seen;
  expr::VisitPostorder(arena_, term, seen, [&](TermId t) {
    if (arena_.op(t) != Op::kElementary || !IsPartial(arena_.elementary_of(t))) return;
    // A value that is known exactly is defined.
    if (ConstantOf(poly(Number(t)))) return;
    if (const auto key = KeyOf(arena_.elementary_of(t), Number(arena_.arg(t, 0)))) written.insert(*key);
  });
  return written;
}

bool Normal::IsTotal(TermId term) { return Written(term).empty(); }

bool Normal::FaithfulLiteral(TermId literal) {
  const std::set<Key> written = Written(literal);
  if (written.empty()) return true;
  std::set<Key> kept;
  KeysOf(Of(literal), kept);
  return std::includes(kept.begin(), kept.end(), written.begin(), written.end());
}

bool Normal::Faithful(TermId t) {
  switch (arena_.op(t)) {
    case Op::kNot:
    case Op::kAnd:
    case Op::kOr:
    case Op::kIte:
      return std::ranges::all_of(arena_.args(t), [this](TermId a) { return Faithful(a); });
    case Op::kEq:
      if (arena_.sort_of(arena_.arg(t, 0)) == arena_.Bool())
        return Faithful(arena_.arg(t, 0)) && Faithful(arena_.arg(t, 1));
      return FaithfulLiteral(t);
    case Op::kLe:
    case Op::kLt:
      return FaithfulLiteral(t);
    default:
      return true;  // constants and variables
  }
}

}  // namespace rondo::solve::certify
