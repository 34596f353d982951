#include "driver/man_pages.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>

#include "base/version.h"

namespace rondo::driver {
namespace {

// Text as roff has it: what would be a command is not.
std::string Plain(const std::string& text) {
  std::string result;
  for (const char c : text) {
    const bool begins = result.empty() || result.back() == '\n';
    if (begins && (c == '.' || c == '\'')) result += "\\&";
    if (c == '\\') {
      result += "\\e";
    } else if (c == '-') {
      result += "\\-";
    } else {
      result += c;
    }
  }
  return result;
}

std::string Upper(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

std::string Head(const std::string& name, const std::string& what) {
  return fmt::format(".TH {} 1 \"\" \"rondo {}\" \"Rondo\"\n.SH NAME\n{} \\- {}\n", Upper(Plain(name)),
                     base::Version(), Plain(name), Plain(what));
}

// `UINT` of `UINT:UINT in [1 - 9]`; the words themselves of a choice between words.
std::string TypeOf(const CLI::Option& option) {
  std::string type = option.get_type_name();
  const size_t colon = type.find(':');
  if (colon == std::string::npos) return type;
  return type.substr(colon + 1).starts_with('{') ? type.substr(colon + 1) : type.substr(0, colon);
}

std::string Options(const CLI::App& app) {
  std::string text;
  for (const CLI::Option* option : app.get_options()) {
    std::string name = option->get_positional() ? "\\fI" + Plain(option->get_name(true)) + "\\fR" : "";
    for (const std::string& word : option->get_snames())
      name += (name.empty() ? "" : ", ") + ("\\fB\\-" + Plain(word)) + "\\fR";
    for (const std::string& word : option->get_lnames())
      name += (name.empty() ? "" : ", ") + ("\\fB\\-\\-" + Plain(word)) + "\\fR";
    const std::string type = option->get_type_size() > 0 && !option->get_positional()
                                 ? " \\fI" + Plain(TypeOf(*option)) + "\\fR"
                                 : "";
    text += fmt::format(".TP\n{}{}\n{}\n", name, type, Plain(option->get_description()));
  }
  return text;
}

std::string Footer(const CLI::App& app) {
  return app.get_footer().empty() ? "" : fmt::format(".SH NOTES\n.nf\n{}\n.fi\n", Plain(app.get_footer()));
}

std::string PageOf(const CLI::App& verb) {
  std::string places;
  for (const CLI::Option* option : verb.get_options()) {
    if (option->get_positional())
      places += fmt::format(" \\fI{}\\fR{}", Plain(option->get_name(true)),
                            option->get_expected_max() > 1 ? "..." : "");
  }
  std::string text = Head("rondo-" + verb.get_name(), verb.get_description());
  text += fmt::format(".SH SYNOPSIS\n\\fBrondo {}\\fR [\\fIOPTIONS\\fR]{}\n.SH OPTIONS\n{}",
                      Plain(verb.get_name()), places, Options(verb));
  for (const CLI::App* inner : verb.get_subcommands({}))
    text += fmt::format(".SS {}\n{}\n{}", Plain(inner->get_name()), Plain(inner->get_description()),
                        Options(*inner));
  return text + Footer(verb) + ".SH SEE ALSO\n.BR rondo (1)\n";
}

}  // namespace

std::vector<std::pair<std::string, std::string>> ManPages(const CLI::App& app) {
  std::vector<std::pair<std::string, std::string>> pages;
  std::string text = Head("rondo", app.get_description());
  text += fmt::format(
      ".SH SYNOPSIS\n\\fBrondo\\fR \\fIVERB\\fR [\\fIOPTIONS\\fR] ...\n.SH OPTIONS\n{}.SH VERBS\n",
      Options(app));
  std::string also;
  for (const CLI::App* verb : app.get_subcommands({})) {
    text += fmt::format(".TP\n\\fB{}\\fR\n{}\n", Plain(verb->get_name()), Plain(verb->get_description()));
    also += fmt::format("{}.BR {} (1)", also.empty() ? "" : " ,\n", Plain("rondo-" + verb->get_name()));
    pages.emplace_back(fmt::format("rondo-{}.1", verb->get_name()), PageOf(*verb));
  }
  pages.emplace_back("rondo.1", text + Footer(app) + ".SH SEE ALSO\n" + also + "\n");
  return pages;
}

}  // namespace rondo::driver
