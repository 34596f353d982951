#include "reach/validated/series/box_series.h"

#include <algorithm>
#include <cmath>

namespace rondo::reach {

namespace {

Interval Enclosed(const LinearPart& part) {
  if (part.error == 0) return Interval::Point(part.factor);
  return Interval::Point(part.factor) + Interval{-part.error, part.error};
}
Interval Count(size_t k) { return Interval::Point(static_cast<double>(k)); }
bool Finite(Interval i) { return std::isfinite(i.lo) && std::isfinite(i.hi); }

// The angle of every (x, y) != 0 in the box, as one branch: nothing if the box meets the negative x axis.
bool Angle(Interval y, Interval x, Interval& out) {
  if (x.lo <= 0 && y.Contains(0)) return false;
  out = interval::Atan2(y, x);
  return true;
}

}  // namespace

BoxSeries::BoxSeries(const Program& program, size_t orders)
    : program_(program), orders_(orders), values_(program.code.size() * orders), rows_(program.code.size()) {}

void BoxSeries::SetFromDerivative(size_t variable, size_t output, size_t order) {
  At(program_.variable_nodes[variable], order + 1) = At(program_.outputs[output], order) / Count(order + 1);
}

Branch BoxSeries::BranchOf(size_t node) const {
  const Code& c = program_.code[node];
  const Interval a = Of(c.a, 0);
  if (c.op == CodeOp::kMax) {
    const Interval b = Of(c.b, 0);
    return a.lo >= b.hi ? Branch::kFirst : b.lo >= a.hi ? Branch::kSecond : Branch::kEither;
  }
  if (c.op == CodeOp::kAbs) return a.lo >= 0 ? Branch::kFirst : a.hi <= 0 ? Branch::kSecond : Branch::kEither;
  return a.hi < 0 ? Branch::kFirst : a.lo > 0 ? Branch::kSecond : Branch::kEither;
}

Interval BoxSeries::HullOf(size_t node) const {
  const Code& c = program_.code[node];
  if (c.op == CodeOp::kMax) return interval::Max(Of(c.a, 0), Of(c.b, 0));
  return c.op == CodeOp::kAbs ? interval::Abs(Of(c.a, 0)) : interval::Hull(Of(c.b, 0), Of(c.c, 0));
}

bool BoxSeries::First(uint32_t n, const std::vector<Branch>& branches, const std::vector<Interval>& held,
                      bool map) {
  const Code& c = program_.code[n];
  Interval& out = At(n, 0);
  switch (c.op) {
    case CodeOp::kVariable:
      return true;
    case CodeOp::kLinear:
      out = Enclosed(program_.constants[n]);
      for (uint32_t p = c.a; p < c.a + c.b; ++p) {
        const LinearPart& part = program_.parts[p];
        out = out + Enclosed(part) * At(part.node, 0);
      }
      break;
    case CodeOp::kProduct:
      out = c.a == c.b ? interval::Sqr(At(c.a, 0)) : At(c.a, 0) * At(c.b, 0);
      break;
    case CodeOp::kReciprocal:
      if (At(c.a, 0).Contains(0)) return false;
      out = Interval::Point(1) / At(c.a, 0);
      break;
    case CodeOp::kRoot:
      if (At(c.a, 0).lo <= 0) return false;
      out = interval::Sqrt(At(c.a, 0));
      break;
    case CodeOp::kSine:
      out = interval::Sin(At(c.a, 0));
      break;
    case CodeOp::kCosine:
      out = interval::Cos(At(c.a, 0));
      break;
    case CodeOp::kExp:
      out = interval::Exp(At(c.a, 0));
      break;
    case CodeOp::kLog:
      if (At(c.a, 0).lo <= 0) return false;
      out = interval::Log(At(c.a, 0));
      break;
    case CodeOp::kAtan:
      out = interval::Atan(At(c.a, 0));
      break;
    case CodeOp::kAtan2:
      if (!Angle(At(c.a, 0), At(c.b, 0), out)) return false;
      break;
    case CodeOp::kAbs:
    case CodeOp::kMax:
    case CodeOp::kChoose:
      if (branches[n] == Branch::kEither) {
        out = map ? HullOf(n) : held[n];
      } else if (c.op == CodeOp::kAbs) {
        out = branches[n] == Branch::kFirst ? At(c.a, 0) : -At(c.a, 0);
      } else if (c.op == CodeOp::kMax) {
        out = At(branches[n] == Branch::kFirst ? c.a : c.b, 0);
      } else {
        out = At(branches[n] == Branch::kFirst ? c.b : c.c, 0);
      }
      break;
  }
  return map || Finite(out);
}

void BoxSeries::Later(uint32_t n, size_t k, const std::vector<Branch>& branches) {
  const Code& c = program_.code[n];
  Interval* const out = &At(n, 0);
  const Interval* const a = &At(c.a, 0);
  Interval sum = Interval::Point(0);
  switch (c.op) {
    case CodeOp::kVariable:
      return;
    case CodeOp::kLinear:
      for (uint32_t p = c.a; p < c.a + c.b; ++p) {
        const LinearPart& part = program_.parts[p];
        sum = sum + Enclosed(part) * At(part.node, k);
      }
      break;
    case CodeOp::kProduct: {
      const Interval* const b = &At(c.b, 0);
      if (c.a == c.b) {
        for (size_t j = 0; 2 * j < k; ++j) sum = sum + a[j] * a[k - j];
        sum = sum + sum;
        if (k % 2 == 0) sum = sum + interval::Sqr(a[k / 2]);
      } else {
        for (size_t j = 0; j <= k; ++j) sum = sum + a[j] * b[k - j];
      }
      break;
    }
    case CodeOp::kReciprocal:
      for (size_t j = 1; j <= k; ++j) sum = sum - a[j] * out[k - j];
      sum = sum * out[0];
      break;
    case CodeOp::kRoot:
      sum = a[k];
      for (size_t j = 1; j < k; ++j) sum = sum - out[j] * out[k - j];
      sum = sum / (Interval::Point(2) * out[0]);
      break;
    case CodeOp::kSine:
    case CodeOp::kCosine: {
      const Interval* const partner = &At(c.op == CodeOp::kSine ? n + 1 : n - 1, 0);
      for (size_t j = 1; j <= k; ++j) sum = sum + Count(j) * a[j] * partner[k - j];
      sum = sum / Count(k);
      if (c.op == CodeOp::kCosine) sum = -sum;
      break;
    }
    case CodeOp::kExp:
      for (size_t j = 1; j <= k; ++j) sum = sum + Count(j) * a[j] * out[k - j];
      sum = sum / Count(k);
      break;
    case CodeOp::kLog:
    case CodeOp::kAtan: {
      const Interval* const below = &At(c.op == CodeOp::kLog ? c.a : c.b, 0);
      for (size_t j = 1; j < k; ++j) sum = sum + Count(j) * out[j] * below[k - j];
      sum = (a[k] - sum / Count(k)) / below[0];
      break;
    }
    case CodeOp::kAtan2: {
      const Interval* const x = &At(c.b, 0);
      const Interval* const below = &At(c.c, 0);
      for (size_t j = 1; j <= k; ++j) sum = sum + Count(j) * (a[j] * x[k - j] - x[j] * a[k - j]);
      for (size_t j = 1; j < k; ++j) sum = sum - Count(j) * out[j] * below[k - j];
      sum = sum / Count(k) / below[0];
      break;
    }
    case CodeOp::kAbs:
      if (branches[n] != Branch::kEither) sum = branches[n] == Branch::kFirst ? a[k] : -a[k];
      break;
    case CodeOp::kMax:
      if (branches[n] != Branch::kEither) sum = At(branches[n] == Branch::kFirst ? c.a : c.b, k);
      break;
    case CodeOp::kChoose:
      if (branches[n] != Branch::kEither) sum = At(branches[n] == Branch::kFirst ? c.b : c.c, k);
      break;
  }
  out[k] = sum;
}

bool BoxSeries::Decide(std::vector<Branch>& branches, std::vector<Interval>& held) {
  for (uint32_t n = 0; n < program_.code.size(); ++n) {
    const CodeOp op = program_.code[n].op;
    if (op == CodeOp::kAbs || op == CodeOp::kMax || op == CodeOp::kChoose) {
      branches[n] = BranchOf(n);
      held[n] = HullOf(n);
    }
    if (!First(n, branches, held, true)) return false;
  }
  return true;
}

bool BoxSeries::Compute(size_t order, const std::vector<Branch>& branches, const std::vector<Interval>& held,
                        bool map, uint32_t first, uint32_t end) {
  const auto count = std::min(end, static_cast<uint32_t>(program_.code.size()));
  if (order == 0) {
    for (uint32_t n = first; n < count; ++n) {
      if (!First(n, branches, held, map)) return false;
    }
    return true;
  }
  for (uint32_t n = first; n < count; ++n) Later(n, order, branches);
  return true;
}

Interval BoxSeries::Slope(uint32_t n) const {
  const Code& c = program_.code[n];
  const Interval one = Interval::Point(1);
  switch (c.op) {
    case CodeOp::kReciprocal:
      return -interval::Sqr(Of(n, 0));
    case CodeOp::kRoot:
      return one / (Interval::Point(2) * Of(n, 0));
    case CodeOp::kSine:
      return Of(n + 1, 0);
    case CodeOp::kCosine:
      return -Of(n - 1, 0);
    case CodeOp::kExp:
      return Of(n, 0);
    case CodeOp::kLog:
      return one / Of(c.a, 0);
    case CodeOp::kAtan:
      return one / Of(c.b, 0);
    default:
      return one;
  }
}

void BoxSeries::Gradient(const std::vector<uint32_t>& outputs, const std::vector<Branch>& branches,
                         const std::vector<uint32_t>& sources, bool map, std::vector<Interval>& out,
                         uint32_t first, uint32_t end) {
  const size_t variables = program_.variables.size();
  const size_t width = variables + sources.size();
  const auto count = static_cast<uint32_t>(program_.code.size());
  // Dense rows, but only the columns that a node depends on are ever touched.
  if (columns_.size() != count || sources != sources_) {
    columns_ = program_.depends;
    sources_ = sources;
    for (uint32_t s = 0; s < sources.size(); ++s) {
      std::vector<bool> below(count);
      below[sources[s]] = true;
      columns_[sources[s]].push_back(static_cast<uint32_t>(variables + s));
      for (uint32_t n = sources[s] + 1; n < count; ++n) {
        const Code& c = program_.code[n];
        bool uses = false;
        if (c.op == CodeOp::kLinear) {
          for (uint32_t p = c.a; p < c.a + c.b; ++p) uses = uses || below[program_.parts[p].node];
        } else if (c.op != CodeOp::kVariable) {
          uses =
              below[c.a] ||
              ((c.op == CodeOp::kProduct || c.op == CodeOp::kAtan2 || c.op == CodeOp::kMax) && below[c.b]) ||
              (c.op == CodeOp::kChoose && (below[c.b] || below[c.c]));
        }
        below[n] = uses;
        if (uses) columns_[n].push_back(static_cast<uint32_t>(variables + s));
      }
    }
  }
  for (uint32_t n = first; n < std::min(end, count); ++n) {
    std::vector<Interval>& row = rows_[n];
    row.assign(width, Interval::Point(0));
    const Code& c = program_.code[n];
    const auto add = [&](uint32_t from, Interval factor) {
      for (const uint32_t v : columns_[from]) row[v] = row[v] + factor * rows_[from][v];
    };
    switch (c.op) {
      case CodeOp::kVariable:
        row[c.a] = Interval::Point(1);
        break;
      case CodeOp::kLinear:
        for (uint32_t p = c.a; p < c.a + c.b; ++p) add(program_.parts[p].node, Enclosed(program_.parts[p]));
        break;
      case CodeOp::kProduct:
        add(c.a, Of(c.b, 0));
        add(c.b, Of(c.a, 0));
        break;
      case CodeOp::kAtan2:
        add(c.a, Of(c.b, 0) / Of(c.c, 0));
        add(c.b, -(Of(c.a, 0) / Of(c.c, 0)));
        break;
      case CodeOp::kReciprocal:
      case CodeOp::kRoot:
      case CodeOp::kExp:
      case CodeOp::kLog:
      case CodeOp::kAtan:
      case CodeOp::kSine:
      case CodeOp::kCosine:
        add(c.a, Slope(n));
        break;
      case CodeOp::kAbs:
        if (branches[n] != Branch::kEither) {
          add(c.a, Interval::Point(branches[n] == Branch::kFirst ? 1 : -1));
        } else if (map) {
          add(c.a, {-1, 1});
        }
        break;
      case CodeOp::kMax:
        if (branches[n] != Branch::kEither) {
          add(branches[n] == Branch::kFirst ? c.a : c.b, Interval::Point(1));
        } else if (map) {
          for (size_t v = 0; v < width; ++v) row[v] = interval::Hull(rows_[c.a][v], rows_[c.b][v]);
        }
        break;
      case CodeOp::kChoose:
        if (branches[n] != Branch::kEither) {
          add(branches[n] == Branch::kFirst ? c.b : c.c, Interval::Point(1));
        } else if (map) {
          for (size_t v = 0; v < width; ++v) row[v] = interval::Hull(rows_[c.b][v], rows_[c.c][v]);
        }
        break;
    }
    if (!map && (c.op == CodeOp::kAbs || c.op == CodeOp::kMax || c.op == CodeOp::kChoose) &&
        branches[n] == Branch::kEither) {
      // Held: a source of its own, independent of what it is made of.
      std::fill(row.begin(), row.end(), Interval::Point(0));
      const auto it = std::find(sources.begin(), sources.end(), n);
      if (it != sources.end())
        row[variables + static_cast<size_t>(it - sources.begin())] = Interval::Point(1);
    }
  }
  out.resize(outputs.size() * width);
  for (size_t r = 0; r < outputs.size(); ++r)
    std::copy(rows_[outputs[r]].begin(), rows_[outputs[r]].end(),
              out.begin() + static_cast<std::ptrdiff_t>(r * width));
}

}  // namespace rondo::reach
