#include "koord/syntax/foreign.h"

namespace rondo::koord {
namespace {

struct Foreign {
  WordPlace place;
  std::string_view word, instead;
};
constexpr WordPlace kItem = WordPlace::kItem, kStatement = WordPlace::kStatement;
constexpr Foreign kForeign[] = {
    {kItem, "enum", "write `def Name {first, second}`"},
    {kItem, "struct", "write `def Name:` and the members below"},
    {kItem, "class", "write `def Name:` and the members below"},
    {kItem, "record", "write `def Name:` and the members below"},
    {kItem, "function", "write `def name(int x) -> int:`"},
    {kItem, "fn", "write `def name(int x) -> int:`"},
    {kItem, "import", "modules of the platform begin with `using`; a specification stands in NAME.spec"},
    {kItem, "event", "an event begins with its name: `Name:`, then `pre:` and `eff:`"},
    {kItem, "global", "write `allwrite:`, or `allread:` if each robot writes its own cell"},
    {kItem, "shared", "write `allwrite:`, or `allread:` if each robot writes its own cell"},
    {kItem, "var", "variables stand under `local:`, `allread:` or `allwrite:`"},
    {kItem, "variables", "variables stand under `local:`, `allread:` or `allwrite:`"},
    {kItem, "assert", "write `invariant name: ...`"},
    {kItem, "property", "write `invariant name: ...`"},
    {kStatement, "loop", "write `for i in range(8):`"},
    {kStatement, "repeat", "write `for i in range(8):`"},
    {kStatement, "do", "write `for i in range(8):`"},
    {kStatement, "elseif", "write `elif`"},
    {kStatement, "elsif", "write `elif`"},
    {kStatement, "switch", "write `if` and `elif`"},
    {kStatement, "match", "write `if` and `elif`"},
    {kStatement, "case", "write `if` and `elif`"},
    {kStatement, "let", "write the type: `int x = 0`"},
    {kStatement, "var", "write the type: `int x = 0`"},
    {kStatement, "auto", "write the type: `int x = 0`"},
    {kStatement, "const", "write a `param int n = 3` outside of events, or `int n = 3` here"},
    {kStatement, "lock", "write `atomic:`"},
    {kStatement, "synchronized", "write `atomic:`"},
    {kStatement, "await", "an event waits for its `pre`"},
    {kStatement, "wait", "an event waits for its `pre`"},
    {kStatement, "sleep", "an event waits for its `pre`; a round takes `delta` seconds"},
    {kStatement, "skip", "write `pass`"},
    {kStatement, "print", "write to a stream: declare `stream out` under `local:`, and `out << value`"},
    {kStatement, "assert", "what must hold is an `invariant` outside of events"},
};

}  // namespace

std::string_view AlternativeFor(std::string_view word, WordPlace place) {
  for (const Foreign& f : kForeign) {
    if (f.place == place && f.word == word) return f.instead;
  }
  return {};
}

}  // namespace rondo::koord
