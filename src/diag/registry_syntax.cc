#include "diag/registry_tables.h"

namespace rondo::diag {
namespace {

constexpr KindInfo kTable[] = {
    {Kind::kSyntaxUnexpected, "syntax-unexpected", Severity::kError, "something else should stand here",
     "The text cannot be read from this place on. The message names what was found and what the grammar asks for.\n"
     "Reading goes on behind the line, so that one mistake hides no other.",
     "Step:\n    pre: 1 < 2 < 3\n    eff:\n        stop\n", "check"},
    {Kind::kSyntaxIndentation, "syntax-indentation", Severity::kError,
     "the indentation of a line fits no block",
     "Blocks are made by indentation. A line must start exactly where the other lines of its block start, and only a\n"
     "line that opens a block (such as `eff:` or `if ...:`) may be followed by deeper lines.",
     "Step:\n    eff:\n            stop\n        stop\n", "check"},
    {Kind::kSyntaxTab, "syntax-tab", Severity::kWarning, "a tab in the indentation",
     "Editors show tabs with different widths, so that what looks aligned may not be. A tab counts up to the next\n"
     "multiple of 8 columns. `rondo fmt` replaces tabs by blanks.",
     "Step:\n\teff:\n\t\tstop\n", "check"},
    {Kind::kSyntaxUnknownCharacter, "syntax-unknown-character", Severity::kError,
     "a character that means nothing here",
     "Outside strings and comments only the characters of names, numbers and operators have a meaning. The character\n"
     "is skipped.",
     "Step:\n    eff:\n        stop $\n", "check"},
    {Kind::kSyntaxUnterminatedString, "syntax-unterminated-string", Severity::kError,
     "a string without an end",
     "A string ends with the quote that it began with, on the same line. Write `\\n` for a line end inside a string.",
     "using Log:\n    actuators:\n        stream stdout\nStep:\n    eff:\n        Log.stdout << \"hello\n",
     "check"},
    {Kind::kSyntaxNumber, "syntax-number", Severity::kError, "a number that cannot be read",
     "Numbers are written 12, 1.5, .5, 5. or 1e-3, and names do not start with a digit. A number that is not zero has a\n"
     "size from 2.3e-308 to 1.7e308: proofs have it exactly, robots as the nearest double.",
     "local:\n    int n = 12ab\nStep:\n    eff:\n        stop\n", "check"},
    {Kind::kSyntaxNesting, "syntax-nesting", Severity::kError, "nested too deeply",
     "Expressions and statements may be nested up to a fixed depth, far beyond what people write. A generated program\n"
     "should name parts of its expressions instead.",
     "local:\n"
     "    int n = "
     "((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((1))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))\n"
     "Step:\n"
     "    eff:\n"
     "        stop\n",
     "check"},
    {Kind::kSyntaxReservedName, "syntax-reserved-name", Severity::kError,
     "a word of the language used as a name",
     "Words such as `pre`, `eff`, `atomic` or `pid` structure programs and cannot name variables, types or functions.",
     "local:\n    int eff\nStep:\n    eff:\n        stop\n", "check"},
};

}  // namespace

std::span<const KindInfo> SyntaxKinds() { return kTable; }

}  // namespace rondo::diag
