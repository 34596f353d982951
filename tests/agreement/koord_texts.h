#pragma once

#include <random>
#include <string>

#include "koord/check/check.h"
#include "koord/syntax/parser.h"

/// Random small Koord programs.
namespace rondo::koord {

/// Writes programs: with few states, most of them, and with something of everything.
class Texts {
 public:
  explicit Texts(uint64_t seed) : rng_(seed) {}

  std::string Whole() {
    sensor_ = Pick(3) == 0;
    cells_ = Pick(4) == 0;
    nested_ = Pick(4) == 0;
    record_ = Pick(5) == 0;
    points_ = Pick(6) == 0;
    folds_ = Pick(3) == 0;
    lists_ = Pick(4) == 0;
    std::string text;
    if (record_) text += "def adt Rec:\n    int a\n    int k[2]\n";
    if (cells_ || nested_)
      text += "def fun item(int[3] xs, int k) -> int:\n    return xs[min(max(k, 0), 2)]\n";
    if (sensor_) text += "using M:\n    sensors:\n        bool near\n    actuators:\n        int power\n";
    text += "allread:\n    int x[N_sys] = 0\n    bool up[N_sys] = false\n";
    text += "allwrite:\n    int s = 0\n    int t = 1\n";
    if (cells_) text += "    int c[3]\n";
    if (nested_) text += "    int g[2][3]\n";
    text += "local:\n    int n = 0\n    bool b = false\n";
    if (record_) text += "    Rec r\n";
    if (points_) text += "    pos p = pos(0, 0, 0)\n";
    if (lists_) text += "    List<int> l\n";
    if (cells_ || nested_ || record_ || lists_) text += "init:\n";
    if (lists_) text += "    l = [1, 2]\n";
    if (cells_) text += "    c[0] = 0\n    c[1] = 0\n    c[2] = 0\n";
    if (record_) text += "    r.a = 0\n    r.k[0] = 0\n    r.k[1] = 0\n";
    for (const char* cell : {"0][0", "0][1", "0][2", "1][0", "1][1", "1][2"}) {
      if (nested_) text += std::string("    g[") + cell + "] = 0\n";
    }
    const size_t events = 1 + Pick(3);
    for (size_t e = 0; e < events; ++e) text += Event(e);
    const size_t invariants = 1 + Pick(2);
    for (size_t i = 0; i < invariants; ++i)
      text += "invariant i" + std::to_string(i) + (Pick(5) == 0 ? " at rounds: " : ": ") + Invariant() + "\n";
    if (sensor_ && Pick(2) == 0) text += "assume M.calm when M.power > 0 always M.near == old(M.near)\n";
    if (sensor_ && Pick(3) == 0) text += "assume M.back when M.power > 1 finally M.near\n";
    return text;
  }

 private:
  size_t Pick(size_t n) { return static_cast<size_t>(rng_() % n); }
  template <size_t N>
  std::string One(const char* const (&list)[N]) {
    return list[Pick(N)];
  }

  std::string Int() {
    if (local_ && Pick(6) == 0) return "v";
    switch (Pick(9)) {
      case 7:
        return "(" + One({"n", "s", "1"}) + " if " + Bool(0) + " else " + Int() + ")";
      case 0:
        return std::to_string(Pick(4));
      case 1:
        return "s";
      case 2:
        return "t";
      case 3:
        return "n";
      case 4:
        return "x[pid]";
      case 5:
        return Pick(2) == 0 ? "pid" : "N_sys";
      case 6:
        return "(" + Int() + One({" + ", " - "}) + Int() + ")";
      default:
        return Part();
    }
  }

  // Over all robots.
  std::string Fold() {
    return One({"(count i in ID: up[i])", "(count i in ID: x[i] > s)", "(sum i in ID: x[i])",
                "(min i in ID: x[i])", "(max i in ID: x[i] - i)", "(argmin i in ID: x[i])",
                "(argmax i in ID: x[i] + n)", "(count i in ID: exists j in ID: x[j] > x[i])"});
  }
  // Integers made of what is none.
  std::string Rounded() {
    return One({"floor(n / 2.0)", "ceil(x[pid] / 2.0 - 1)", "round(s - 0.5)", "sign(n - t)",
                "floor(sqrt(t * t + 1))", "floor(hypot(n, s))", "floor(sqrt(abs(s)))"});
  }

  // Something of what only some programs have.
  std::string Part() {
    if (folds_ && Pick(2) == 0) return Pick(2) == 0 ? Fold() : Rounded();
    switch (Pick(4)) {
      case 0:
        if (cells_) return Pick(2) == 0 ? "c[" + std::to_string(Pick(3)) + "]" : "item(c, " + Int() + ")";
        break;
      case 1:
        if (nested_)
          return Pick(2) == 0 ? "g[" + std::to_string(Pick(2)) + "][" + std::to_string(Pick(3)) + "]"
                              : "item(g[" + std::to_string(Pick(2)) + "], n)";
        break;
      case 2:
        if (record_) return One({"r.a", "r.k[0]", "r.k[1]"});
        break;
      default:
        break;
    }
    return "min(" + Int() + ", 2)";
  }

  std::string Bool(int depth = 2) {
    switch (Pick(depth > 0 ? 8 : 5)) {
      case 0:
        return "b";
      case 1:
        return "up[pid]";
      case 2:
        return sensor_ ? "M.near" : "b";
      case 3:
      case 4:
        return Int() + One({" == ", " <= ", " < ", " != "}) + Int();
      case 5:
        return "not (" + Bool(depth - 1) + ")";
      case 6:
        return "(" + Bool(depth - 1) + One({" and ", " or "}) + Bool(depth - 1) + ")";
      default:
        if (points_ && Pick(2) == 0) return One({"dist(p, pos(0, 0, 0)) <= 1", "dist(p, pos(1, 0, 0)) == 1"});
        return One({"(forall j in ID: not up[j])", "(exists j in ID: x[j] > 0)",
                    "(forall j in ID: x[j] <= s)", "(exists i in ID: forall j in ID: x[j] <= x[i])"});
    }
  }

  std::string Statement(const std::string& indent, int depth) {
    if (Pick(6) == 0) return indent + Special() + "\n";
    if (lists_ && Pick(3) == 0) return ChangeOfList(indent);
    if (folds_ && Pick(3) == 0) return Counted(indent);
    if (local_ && Pick(5) == 0)
      return indent +
             One({"v -= 1", "v *= 2", "v /= 2", "v--", "pass", "n = v - v", "v = n",
                  "v = v + 1 if b else 0"}) +
             "\n";
    if (local_ && Pick(8) == 0) {
      return indent + "while v < n within " + One({"2", "4"}) + ":\n" + indent + "    v += 1\n" + indent +
             "    " + One({"b = not b", "continue", "n = v", "break"}) + "\n";
    }
    switch (Pick(depth > 0 ? 11 : 7)) {
      case 0:
        return indent + "n = " + Capped() + "\n";
      case 1:
        return indent + "b = " + Bool(1) + "\n";
      case 2:
        return indent + "x[pid] = " + Capped() + "\n";
      case 3:
        return indent + "up[pid] = " + Bool(1) + "\n";
      case 4:
        return indent + "s = " + Capped() + "\n";
      case 5:
        return indent + "t = " + Capped() + "\n";
      case 6:
        if (sensor_ && Pick(2) == 0) return indent + "M.power = " + Capped() + "\n";
        return cells_ ? indent + "c[" + (Pick(2) == 0 ? "1" : "min(max(n, 0), 2)") + "] = " + Capped() + "\n"
                      : indent + "stop\n";
      case 7:
      case 8:
        return indent + "if " + Bool(1) + ":\n" + Statement(indent + "    ", depth - 1) + indent + "else:\n" +
               Statement(indent + "    ", depth - 1);
      case 9:
        return indent + "for k = 0, 2:\n" + Statement(indent + "    ", 0);
      default:
        return indent + "atomic:\n" + Statement(indent + "    ", depth - 1) +
               Statement(indent + "    ", depth - 1);
    }
  }

  // What counts and sums are kept by: with a lock, and without.
  std::string Counted(const std::string& indent) {
    const bool lock = Pick(4) != 0;
    const std::string deep = indent + (lock ? "    " : "");
    const std::string change = One({"if (count i in ID: up[i]) < 2:\n    up[pid] = true",
                                    "if x[pid] < 2 and s < 2:\n    x[pid] += 1\n    s += 1",
                                    "if x[pid] > 0 and s > 0:\n    x[pid] -= 1\n    s -= 1",
                                    "if up[pid]:\n    up[pid] = false\n    t = 0",
                                    "if not up[pid] and t < 2:\n    up[pid] = true\n    t += 1",
                                    "s = min((count i in ID: up[i]), 2)", "if x[pid] == 0:\n    x[pid] = 1"});
    std::string text = lock ? indent + "atomic:\n" : "";
    for (size_t from = 0; from < change.size();) {
      const size_t end = std::min(change.find('\n', from), change.size());
      text += deep + change.substr(from, end - from) + "\n";
      from = end + 1;
    }
    return text;
  }

  // Mostly possible; the list stays short.
  std::string ChangeOfList(const std::string& indent) {
    const std::string k = One({"0", "1", "n", "len(l) - 1", "len(l)"});
    const std::string statement =
        One({"l.insert(K, n)", "l.insert(K, 2)", "l.pop(K)", "l = l[K:]", "l = l[0:K]", "l = l[1:K]"});
    std::string written = statement;
    while (written.find('K') != std::string::npos) written.replace(written.find('K'), 1, k);
    const bool grows = statement.starts_with("l.insert");
    const std::string fits = grows ? "0 <= " + k + " and " + k + " <= len(l) and len(l) < 3"
                             : statement == "l = l[1:K]"    ? "1 <= " + k + " and " + k + " <= len(l)"
                             : statement.starts_with("l =") ? "0 <= " + k + " and " + k + " <= len(l)"
                                                            : "0 <= " + k + " and " + k + " < len(l)";
    const std::string guard = grows && Pick(6) == 0 ? "len(l) < 3" : Pick(6) == 0 ? "b" : fits;
    return indent + "if " + guard + ":\n" + indent + "    " + written + "\n";
  }

  // Choices, and writes to what only some programs have.
  std::string Special() {
    switch (Pick(5)) {
      case 0:
        return "n = any int in 0.." + std::to_string(Pick(3));
      case 1:
        return "s = min(max(any q in [n, 0, t], 0), 2)";
      case 2:
        if (nested_) {
          const std::string row = Pick(2) == 0 ? std::to_string(Pick(2)) : "min(max(n, 0), 1)";
          if (Pick(4) == 0) return "g[" + row + "] = g[" + std::to_string(Pick(2)) + "]";
          return "g[" + row + "][" + (Pick(2) == 0 ? std::to_string(Pick(3)) : "min(max(s, 0), 2)") +
                 "] = " + Capped();
        }
        break;
      case 3:
        if (record_) return std::string(One({"r.a", "r.k[0]", "r.k[min(max(n, 0), 1)]"})) + " = " + Capped();
        break;
      default:
        if (points_) return "p = pos(" + Capped() + ", 0, 0)";
        break;
    }
    return "n = any int in 1..2";
  }

  // Small, so that there are few states.
  std::string Capped() { return "min(max(" + Int() + ", 0), 2)"; }

  std::string Event(size_t number) {
    std::string text = "E" + std::to_string(number) + ":\n";
    text += std::string("    pre") + (Pick(5) == 0 ? " urgent" : "") + ": " +
            (Pick(4) == 0 ? "true" : Bool()) + "\n";
    text += "    eff:\n";
    const size_t count = 1 + Pick(3);
    local_ = Pick(2) == 0;
    if (local_) text += "        int v = " + std::string(One({"n", "s", "2", "x[pid] - 1"})) + "\n";
    for (size_t i = 0; i < count; ++i) text += Statement("        ", 2);
    local_ = false;
    return text;
  }

  std::string Invariant() {
    if (folds_ && Pick(2) == 0)
      return One({"(count i in ID: up[i]) <= 1", "(count i in ID: up[i]) <= 2", "(sum i in ID: x[i]) <= 2",
                  "(max i in ID: x[i]) <= s + 1", "(min i in ID: n[i]) <= 0", "(argmin i in ID: x[i]) == 0",
                  "(count i in ID: up[i]) >= 1 or s <= 1", "forall j in ID: x[j] <= (max i in ID: x[i])",
                  "(count i in ID: b[i]) < N_sys or t >= 1", "(sum i in ID: x[i]) == s",
                  "(sum i in ID: x[i]) >= s", "(count i in ID: up[i]) == t", "(count i in ID: up[i]) >= s",
                  "(sum i in ID: x[i]) <= 2 * N_sys", "(sum i in ID: x[i]) >= 0",
                  "(count i in ID: x[i] > 0) >= s", "(sum i in ID: x[i]) >= (count i in ID: x[i] > 0)"});
    if (lists_ && Pick(2) == 0)
      return One({"forall i in ID: len(l[i]) <= 3", "forall i in ID: len(l[i]) <= 2",
                  "forall i in ID: forall a in l[i]: a > 0",
                  "forall i in ID: forall k in range(len(l[i])): l[i][k] <= 2",
                  "forall i in ID: exists k in range(len(l[i])): l[i][k] == 2",
                  "forall i in ID: len(l[i]) == 0 or l[i][0] >= 1"});
    if (Pick(4) == 0) return Existential();
    switch (Pick(8)) {
      case 0:
        return "s <= 2";
      case 1:
        return "s + t <= " + std::to_string(1 + Pick(4));
      case 2:
        return "forall i in ID: n[i] <= " + std::to_string(Pick(3));
      case 3:
        return "forall i, j in ID: up[i] and up[j] implies i == j";
      case 4:
        return "forall i in ID: up[i] implies x[i] <= s";
      case 5:
        return "forall i in ID: b[i] implies up[i]";
      case 6:
        return "forall i in ID: x[i] >= 0 and n[i] <= s + 2";
      default:
        if (nested_)
          return One({"g[0][1] + g[1][2] <= 3", "g[0] == g[1] implies g[0][2] == g[1][2]", "g[1][0] <= 1"});
        if (record_)
          return One({"forall i in ID: r[i].a <= 2", "forall i in ID: r[i].k[0] + r[i].k[1] <= 3"});
        if (points_)
          return One(
              {"forall i, j in ID: dist(p[i], p[j]) <= 2", "forall i in ID: dist(p[i], pos(0, 0, 0)) <= 1",
               "forall i, j in ID: dist(p[i], p[j]) <= dist(p[i], pos(0, 0, 0)) + dist(p[j], pos(0, 0, 0))"});
        return cells_ ? "c[0] + c[1] <= 3" : "exists i in ID: not up[i]";
    }
  }

  std::string Existential() {
    return One({"exists i in ID: not up[i]", "exists i in ID: x[i] <= s",
                "exists i in ID: forall j in ID: x[j] <= x[i]",
                "forall j in ID: exists i in ID: n[i] >= n[j]", "not (forall i in ID: up[i])",
                "forall j in ID: up[j] implies exists i in ID: up[i] and x[i] >= x[j]",
                "exists i in ID: s == i or s >= N_sys", "exists i in ID: n[i] == 0"});
  }

  std::mt19937_64 rng_;
  bool sensor_ = false;
  bool cells_ = false;
  bool local_ = false;  // the event has a local variable `v`
  bool nested_ = false;
  bool record_ = false;
  bool points_ = false;
  bool folds_ = false;
  bool lists_ = false;
};

/// Holds a program that was read from a text.
struct Loaded {
  diag::SourceSet sources;
  diag::Diagnostics diagnostics;
  Program program;
  Model model;

  diag::FileId file;

  explicit Loaded(const std::string& text, const std::string& spec = {}) : file(sources.Add("random", text)) {
    Parse(sources, file, program, diagnostics);
    if (!spec.empty()) Parse(sources, sources.Add("specification", spec), program, diagnostics);
    if (!diagnostics.has_errors()) model = Check(program, diagnostics);
  }
  bool good() const { return !diagnostics.has_errors(); }
};

}  // namespace rondo::koord
