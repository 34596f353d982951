#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "base/id.h"
#include "expr/op.h"
#include "expr/rational.h"

/// Sorts, symbols and hash-consed terms: the one language in which every part of Rondo states what must hold.
namespace rondo::expr {

/// Name sorts, symbols and terms of one arena.
using SortId = base::Id<struct SortTag>;
using SymbolId = base::Id<struct SymbolTag>;
using TermId = base::Id<struct TermTag>;

/// Says what the members of a sort are; see `Sort` for its parts.
enum class SortKind : uint8_t { kBool, kInt, kReal, kEnum, kRecord, kArray, kList, kOpaque };

/// Describes a set of values. A sort is known by its name: equal names, one id.
struct Sort {
  SortKind kind;
  std::string name;
  std::vector<std::string> names;  ///< members of an enumeration, fields of a record
  std::vector<SortId> parts;       ///< record: field sorts; array: index, element; list: element
};

/// Is a constant, a variable or a function that the logic does not interpret.
struct Symbol {
  std::string name;
  std::vector<SortId> parameters;  ///< none: a constant or a variable
  SortId result;
  bool bound = false;  ///< whether it is a variable of exactly one quantifier
};

/// Is an operator applied to arguments. Its arguments are found with `Arena::args`.
struct Term {
  Op op;
  SortId sort;
  uint32_t payload = 0;  ///< symbol, number, member, field, or how many variables a quantifier binds
  uint32_t first = 0;    ///< where its arguments begin in the arena's list of all arguments
  uint32_t count = 0;    ///< how many arguments it has
};

/// Owns sorts, symbols and terms. Equal terms have equal ids. Building is single-threaded; reading is not.
///
/// The constructors simplify. Each simplification is a named `Rewrite`, and the test `rewrites` has a solver
/// prove that each preserves meaning. Constructors CHECK sorts: an ill-sorted term is a bug of the caller.
class Arena {
 public:
  Arena();
  Arena(const Arena&) = delete;
  Arena& operator=(const Arena&) = delete;

  // -- sorts
  SortId Bool() const { return bool_; }
  SortId Int() const { return int_; }
  SortId Real() const { return real_; }
  /// Returns the enumeration, record or opaque sort with this name; made at the first call, found at later
  /// ones.
  SortId Enum(std::string_view name, std::vector<std::string> members);
  SortId Record(std::string_view name, std::vector<std::string> fields, std::vector<SortId> sorts);
  SortId Opaque(std::string_view name);
  SortId Array(SortId index, SortId element);
  SortId List(SortId element);
  const Sort& sort(SortId id) const { return sorts_[id.index()]; }
  size_t sort_count() const { return sorts_.size(); }

  // -- symbols
  /// Returns the symbol with this name, made at the first call; later calls must give the same sorts (CHECK).
  SymbolId Declare(std::string_view name, std::vector<SortId> parameters, SortId result);
  /// Returns a symbol unlike any other, called `name`, or `name!1`, `name!2`, ...
  SymbolId Fresh(std::string_view name, std::vector<SortId> parameters, SortId result);
  bool IsDeclared(std::string_view name) const { return symbol_names_.contains(std::string(name)); }
  const Symbol& symbol(SymbolId id) const { return symbols_[id.index()]; }

  // -- leaves
  TermId True() const { return true_; }
  TermId False() const { return false_; }
  TermId Constant(bool value) const { return value ? true_ : false_; }
  /// Returns a number of sort Int or Real.
  TermId Number(SortId sort, const Rational& value);
  TermId IntNumber(int64_t value) { return Number(int_, Rational(value)); }
  /// Returns a member of an enumeration, counted from 0.
  TermId Member(SortId sort, uint32_t member);
  TermId Variable(SymbolId symbol);
  TermId FreshConstant(std::string_view name, SortId sort) { return Variable(Fresh(name, {}, sort)); }
  /// Returns a variable for one quantifier (see `Forall`), unlike any other.
  TermId FreshBound(std::string_view name, SortId sort);

  // -- logic
  TermId Not(TermId a);
  TermId And(const std::vector<TermId>& args);
  TermId And(TermId a, TermId b) { return And(std::vector<TermId>{a, b}); }
  TermId Or(const std::vector<TermId>& args);
  TermId Or(TermId a, TermId b) { return Or(std::vector<TermId>{a, b}); }
  TermId Implies(TermId a, TermId b) { return Or(Not(a), b); }
  TermId Eq(TermId a, TermId b);
  TermId Ite(TermId condition, TermId then, TermId otherwise);
  /// Quantifies the body. `variables` come from FreshBound and belong to this quantifier alone.
  TermId Forall(const std::vector<TermId>& variables, TermId body);
  TermId Exists(const std::vector<TermId>& variables, TermId body);

  // -- arithmetic; both sides of a binary operation have the same sort
  TermId Add(std::vector<TermId> args);
  TermId Add(TermId a, TermId b) { return Add(std::vector<TermId>{a, b}); }
  TermId Sub(TermId a, TermId b) { return Add(a, Neg(b)); }
  TermId Neg(TermId a);
  TermId Mul(TermId a, TermId b);
  TermId Divide(TermId a, TermId b);  ///< of reals; a/0 is some number, as in SMT-LIB
  TermId IntDiv(TermId a, TermId b);  ///< Euclidean; a div 0 is some number
  TermId Mod(TermId a, TermId b);
  TermId Le(TermId a, TermId b);
  TermId Lt(TermId a, TermId b);
  TermId ToReal(TermId a);
  TermId Apply(Elementary function, std::vector<TermId> args);  ///< of reals; see Elementary for arities

  // -- functions, arrays, records, lists
  TermId Apply(SymbolId function, std::vector<TermId> args);
  TermId Select(TermId array, TermId index);
  TermId Store(TermId array, TermId index, TermId value);
  TermId MakeRecord(SortId sort, std::vector<TermId> fields);
  TermId Field(TermId record, uint32_t field);
  TermId MakeList(SortId element, std::vector<TermId> items);
  TermId Length(TermId list);
  TermId At(TermId list, TermId index);  ///< some element when the index is out of range
  TermId Append(TermId list, TermId element);
  /// Returns the list without the first occurrence of the element; the same list if there is none.
  TermId Remove(TermId list, TermId element);

  /// Returns the list with another element at the index; the same list when the index is out of range.
  TermId Set(TermId list, TermId index, TermId element);
  /// Returns the list with the element between those before the index and those from it on; the same list if
  /// there is no such place.
  TermId Insert(TermId list, TermId index, TermId element);
  /// Returns the list without the item at the index; the same list when the index is out of range.
  TermId Drop(TermId list, TermId index);
  /// Returns the items from one index up to, not including, another one; the same list unless 0 <= from <= to
  /// <= length.
  TermId Slice(TermId list, TermId from, TermId to);

  // -- reading
  const Term& term(TermId id) const { return terms_[id.index()]; }
  Op op(TermId id) const { return terms_[id.index()].op; }
  SortId sort_of(TermId id) const { return terms_[id.index()].sort; }
  std::span<const TermId> args(TermId id) const;
  TermId arg(TermId id, size_t i) const { return args(id)[i]; }
  const Rational& number(TermId id) const;
  Elementary elementary_of(TermId id) const { return static_cast<Elementary>(terms_[id.index()].payload); }
  SymbolId symbol_of(TermId id) const { return SymbolId(terms_[id.index()].payload); }
  bool IsNumber(TermId id) const { return op(id) == Op::kNumber; }
  /// Reports whether a variable of a quantifier occurs outside that quantifier. Such terms make no sense on
  /// their own.
  bool IsOpen(TermId id) const { return open_[id.index()]; }
  bool HasQuantifier(TermId id) const { return quantified_[id.index()]; }
  /// Reports whether some part of it may have no value (a root, a logarithm, an arcsine or arccosine). What
  /// is simplified keeps where such parts have one (docs/adr/0005-undefined-terms.md).
  bool IsPartial(TermId id) const { return partial_[id.index()]; }
  size_t size() const { return terms_.size(); }

  /// Returns the operator applied as it stands, nothing simplified: for tests and for rebuilding.
  TermId Raw(Op op, SortId sort, uint32_t payload, std::vector<TermId> args);
  /// Returns the term with the operator of `like` and other arguments, built through the simplifying
  /// constructors.
  TermId Rebuild(const Term& like, std::vector<TermId> args);

  /// Is called with (rewrite, plain term, simplified term) whenever a rewrite fires. For tests only.
  std::function<void(Rewrite, TermId, TermId)> observer;

 private:
  struct Hash {
    const Arena* arena;
    size_t operator()(TermId id) const;
  };
  struct Equal {
    const Arena* arena;
    bool operator()(TermId a, TermId b) const;
  };
  SortId AddSort(Sort sort);
  bool HasFreeBound(TermId id, std::span<const TermId> own) const;
  TermId Intern(Op op, SortId sort, uint32_t payload, std::span<const TermId> args);
  TermId Fire(Rewrite rewrite, Op op, SortId sort, uint32_t payload, std::vector<TermId> args, TermId result);
  TermId Junction(Op op, const std::vector<TermId>& args);
  TermId Quantify(Op op, const std::vector<TermId>& variables, TermId body);
  TermId Compare(Op op, TermId a, TermId b);
  TermId Zero(TermId t);
  /// Returns a - b if that is a number whatever the variables are.
  std::optional<Rational> ConstantDistance(TermId a, TermId b) const;

  std::vector<Sort> sorts_;
  std::unordered_map<std::string, SortId> sort_names_;
  std::vector<Symbol> symbols_;
  std::unordered_map<std::string, SymbolId> symbol_names_;
  std::unordered_map<std::string, int> serials_;  // of fresh symbols, by name
  std::vector<Rational> numbers_;
  std::unordered_map<std::string, uint32_t> number_ids_;
  std::vector<Term> terms_;
  std::vector<TermId> pool_;
  std::vector<bool> open_;
  std::vector<bool> quantified_;
  std::vector<bool> partial_;
  std::unordered_set<TermId, Hash, Equal> interned_;
  SortId bool_, int_, real_;
  TermId true_, false_;
};

}  // namespace rondo::expr
