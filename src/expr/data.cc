// The constructors of applications, arrays, records and lists.
#include <algorithm>

#include "base/check.h"
#include "expr/arena.h"

namespace rondo::expr {

TermId Arena::Apply(SymbolId function, std::vector<TermId> args) {
  const Symbol& f = symbol(function);
  CHECK(f.parameters.size() == args.size()) << f.name;
  for (size_t i = 0; i < args.size(); ++i)
    CHECK(sort_of(args[i]) == f.parameters[i]) << f.name << " argument " << i;
  if (args.empty()) return Variable(function);
  return Intern(Op::kApply, f.result, function.value, args);
}

TermId Arena::Select(TermId array, TermId index) {
  const Sort& s = sort(sort_of(array));
  CHECK(s.kind == SortKind::kArray && s.parts[0] == sort_of(index));
  const SortId element = s.parts[1];
  if (op(array) == Op::kStore) {
    const TermId base = arg(array, 0);
    const TermId at = arg(array, 1);
    const TermId value = arg(array, 2);
    return Fire(Rewrite::kSelectStore, Op::kSelect, element, 0, {array, index},
                Ite(Eq(at, index), value, Select(base, index)));
  }
  return Intern(Op::kSelect, element, 0, std::vector{array, index});
}

TermId Arena::Store(TermId array, TermId index, TermId value) {
  const Sort& s = sort(sort_of(array));
  CHECK(s.kind == SortKind::kArray && s.parts[0] == sort_of(index) && s.parts[1] == sort_of(value));
  if (op(array) == Op::kStore && arg(array, 1) == index) {
    return Fire(Rewrite::kStoreStore, Op::kStore, sort_of(array), 0, {array, index, value},
                Store(arg(array, 0), index, value));
  }
  return Intern(Op::kStore, sort_of(array), 0, std::vector{array, index, value});
}

TermId Arena::MakeRecord(SortId s, std::vector<TermId> fields) {
  const Sort& record = sort(s);
  CHECK(record.kind == SortKind::kRecord && record.parts.size() == fields.size());
  for (size_t i = 0; i < fields.size(); ++i) CHECK(sort_of(fields[i]) == record.parts[i]) << record.name;
  const auto projects = [&](size_t i) {
    return op(fields[i]) == Op::kField && term(fields[i]).payload == i &&
           arg(fields[i], 0) == arg(fields[0], 0) && sort_of(arg(fields[i], 0)) == s;
  };
  bool same = op(fields[0]) == Op::kField;
  for (size_t i = 0; same && i < fields.size(); ++i) same = projects(i);
  if (same) {
    const TermId whole = arg(fields[0], 0);
    return Fire(Rewrite::kRecordFields, Op::kRecord, s, 0, std::move(fields), whole);
  }
  return Intern(Op::kRecord, s, 0, fields);
}

TermId Arena::Field(TermId record, uint32_t field) {
  const Sort& s = sort(sort_of(record));
  CHECK(s.kind == SortKind::kRecord && field < s.parts.size());
  const SortId result = s.parts[field];
  const auto fire = [&](Rewrite rewrite, TermId simple) {
    return Fire(rewrite, Op::kField, result, field, {record}, simple);
  };
  if (op(record) == Op::kRecord) return fire(Rewrite::kFieldRecord, arg(record, field));
  if (op(record) == Op::kIte) {
    const TermId condition = arg(record, 0);
    const TermId then = Field(arg(record, 1), field);
    const TermId otherwise = Field(arg(record, 2), field);
    return fire(Rewrite::kFieldIte, Ite(condition, then, otherwise));
  }
  return Intern(Op::kField, result, field, std::vector{record});
}

TermId Arena::MakeList(SortId element, std::vector<TermId> items) {
  for (const TermId item : items) CHECK(sort_of(item) == element);
  return Intern(Op::kListMake, List(element), 0, items);
}

TermId Arena::Length(TermId list) {
  CHECK(sort(sort_of(list)).kind == SortKind::kList);
  if (op(list) == Op::kListMake) {
    return Fire(Rewrite::kLengthMake, Op::kListLength, int_, 0, {list},
                IntNumber(static_cast<int64_t>(args(list).size())));
  }
  return Intern(Op::kListLength, int_, 0, std::vector{list});
}

TermId Arena::At(TermId list, TermId index) {
  const Sort& s = sort(sort_of(list));
  CHECK(s.kind == SortKind::kList && sort_of(index) == int_);
  const SortId element = s.parts[0];
  if (op(list) == Op::kListMake && IsNumber(index)) {
    const Rational& i = number(index);
    for (size_t k = 0; k < args(list).size(); ++k) {
      if (i == Rational(static_cast<int64_t>(k))) {
        return Fire(Rewrite::kAtMake, Op::kListAt, element, 0, {list, index}, arg(list, k));
      }
    }
  }
  return Intern(Op::kListAt, element, 0, std::vector{list, index});
}

TermId Arena::Append(TermId list, TermId element) {
  const Sort& s = sort(sort_of(list));
  CHECK(s.kind == SortKind::kList && s.parts[0] == sort_of(element));
  return Intern(Op::kListAppend, sort_of(list), 0, std::vector{list, element});
}

TermId Arena::Remove(TermId list, TermId element) {
  const Sort& s = sort(sort_of(list));
  CHECK(s.kind == SortKind::kList && s.parts[0] == sort_of(element));
  return Intern(Op::kListRemove, sort_of(list), 0, std::vector{list, element});
}

TermId Arena::Set(TermId list, TermId index, TermId element) {
  const Sort& s = sort(sort_of(list));
  CHECK(s.kind == SortKind::kList && sort_of(index) == int_ && s.parts[0] == sort_of(element));
  return Intern(Op::kListSet, sort_of(list), 0, std::vector{list, index, element});
}

TermId Arena::Insert(TermId list, TermId index, TermId element) {
  const Sort& s = sort(sort_of(list));
  CHECK(s.kind == SortKind::kList && sort_of(index) == int_ && s.parts[0] == sort_of(element));
  return Intern(Op::kListInsert, sort_of(list), 0, std::vector{list, index, element});
}

TermId Arena::Drop(TermId list, TermId index) {
  CHECK(sort(sort_of(list)).kind == SortKind::kList && sort_of(index) == int_);
  return Intern(Op::kListDrop, sort_of(list), 0, std::vector{list, index});
}

TermId Arena::Slice(TermId list, TermId from, TermId to) {
  CHECK(sort(sort_of(list)).kind == SortKind::kList && sort_of(from) == int_ && sort_of(to) == int_);
  return Intern(Op::kListSlice, sort_of(list), 0, std::vector{list, from, to});
}

}  // namespace rondo::expr
