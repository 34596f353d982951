#include "reach/certify/models/linearise.h"

#include "reach/certify/models/upward.h"
#include "reach/problem/bounds.h"

namespace rondo::reach::certify {

namespace {

// Is the function defined on all of its arguments? What is encloses the defined part only.
bool IsDefined(const Code& c, const std::vector<Interval>& v) {
  switch (c.op) {
    case CodeOp::kReciprocal:
      return v[c.a].lo > 0 || v[c.a].hi < 0;
    case CodeOp::kRoot:
    case CodeOp::kLog:
      return v[c.a].lo > 0;
    default:
      return true;
  }
}

Choice ChoiceOf(const Code& c, const std::vector<Interval>& v) {
  const auto sign = [](Interval x) {
    return x.hi <= 0 ? Choice::kSecond : x.lo >= 0 ? Choice::kFirst : Choice::kOpen;
  };
  switch (c.op) {
    case CodeOp::kAbs:
      return sign(v[c.a]);
    case CodeOp::kMax:
      return v[c.a].lo >= v[c.b].hi   ? Choice::kFirst
             : v[c.b].lo >= v[c.a].hi ? Choice::kSecond
                                      : Choice::kOpen;
    case CodeOp::kChoose:  // the first one if a <= 0, else the second one
      return v[c.a].hi < 0 ? Choice::kFirst : v[c.a].lo > 0 ? Choice::kSecond : Choice::kOpen;
    case CodeOp::kAtan2:
      return v[c.b].lo > 0 || !v[c.a].Contains(0.0) ? Choice::kFirst : Choice::kOpen;
    default:
      return Choice::kFirst;
  }
}

class Slopes {
 public:
  Slopes(const Program& program, OnBox& on) : p_(program), on_(on), n_(program.variables.size()) {
    rows_.assign(program.code.size() * n_, Interval::Point(0));
  }

  Interval* Row(size_t node) { return rows_.data() + node * n_; }

  void Node(uint32_t node) {
    const Code& c = p_.code[node];
    const std::vector<Interval>& v = on_.values;
    const Interval one = Interval::Point(1);
    switch (c.op) {
      case CodeOp::kVariable:
        Row(node)[c.a] = one;
        break;
      case CodeOp::kLinear:
        for (uint32_t i = c.a; i < c.a + c.b; ++i)
          Add(node, p_.parts[i].node, Interval::Point(p_.parts[i].factor) + Around(p_.parts[i].error));
        break;
      case CodeOp::kProduct:
        Add(node, c.a, v[c.b]);
        Add(node, c.b, v[c.a]);
        break;
      case CodeOp::kReciprocal:
        Add(node, c.a, -interval::Sqr(v[node]));
        break;
      case CodeOp::kRoot:
        Add(node, c.a, one / (Interval::Point(2) * v[node]));
        break;
      case CodeOp::kSine:
        Add(node, c.a, interval::Cos(v[c.a]));
        break;
      case CodeOp::kCosine:
        Add(node, c.a, -interval::Sin(v[c.a]));
        break;
      case CodeOp::kExp:
        Add(node, c.a, v[node]);
        break;
      case CodeOp::kLog:
        Add(node, c.a, one / v[c.a]);
        break;
      case CodeOp::kAtan:
        Add(node, c.a, one / (one + interval::Sqr(v[c.a])));
        break;
      case CodeOp::kAtan2: {
        if (on_.choices[node] == Choice::kOpen) break;  // as if it did not depend on anything
        const Interval square = interval::Sqr(v[c.a]) + interval::Sqr(v[c.b]);
        Add(node, c.a, v[c.b] / square);
        Add(node, c.b, -(v[c.a] / square));
        break;
      }
      case CodeOp::kAbs:
        Add(node, c.a,
            on_.choices[node] == Choice::kFirst    ? one
            : on_.choices[node] == Choice::kSecond ? -one
                                                   : Interval{-1, 1});
        break;
      case CodeOp::kMax:
      case CodeOp::kChoose: {
        const uint32_t first = c.op == CodeOp::kMax ? c.a : c.b;
        const uint32_t second = c.op == CodeOp::kMax ? c.b : c.c;
        for (const uint32_t variable : p_.depends[node]) {
          const Interval a = Row(first)[variable];
          const Interval b = Row(second)[variable];
          Row(node)[variable] = on_.choices[node] == Choice::kFirst    ? a
                                : on_.choices[node] == Choice::kSecond ? b
                                                                       : interval::Hull(a, b);
        }
        break;
      }
    }
  }

 private:
  void Add(uint32_t node, uint32_t argument, Interval slope) {
    for (const uint32_t v : p_.depends[argument]) {
      const Interval own = Row(argument)[v];
      if (own != Interval::Point(0)) Row(node)[v] = Row(node)[v] + slope * own;
    }
  }

  const Program& p_;
  OnBox& on_;
  size_t n_;
  std::vector<Interval> rows_;
};

}  // namespace

bool Linearise(const Program& program, const interval::Box& box, size_t count, OnBox& out,
               const Nearby* nearby) {
  out.values = ValuesOn(program, box);
  out.choices.assign(program.code.size(), Choice::kFirst);
  Slopes slopes(program, out);
  for (uint32_t node = 0; node < program.code.size(); ++node) {
    const Code& c = program.code[node];
    if (!IsDefined(c, out.values) || !IsFinite(out.values[node])) return false;
    out.choices[node] = ChoiceOf(c, out.values);
    slopes.Node(node);
    if (nearby == nullptr) continue;
    // The mean value theorem: f(p + e) - f(p) = J e.
    double error = 0;
    for (const uint32_t v : program.depends[node]) {
      if (v < nearby->errors.size()) error += Magnitude(slopes.Row(node)[v]) * nearby->errors[v];
    }
    const Interval near = nearby->nodes[node] + Around(Up(error));
    if (IsFinite(near)) out.values[node] = interval::Meet(out.values[node], near);
  }
  const size_t n = program.variables.size();
  out.slopes.clear();
  for (size_t i = 0; i < count; ++i) {
    const Interval* row = slopes.Row(program.outputs[i]);
    for (size_t j = 0; j < n; ++j) {
      if (!IsFinite(row[j])) return false;
    }
    out.slopes.insert(out.slopes.end(), row, row + n);
  }
  return true;
}

}  // namespace rondo::reach::certify
