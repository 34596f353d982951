#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "diag/render.h"

namespace rondo::diag {
namespace {

struct Painter {
  bool on;
  std::string operator()(std::string_view code, std::string_view text) const {
    return on ? fmt::format("\x1b[{}m{}\x1b[0m", code, text) : std::string(text);
  }
};

std::string_view SeverityColour(Severity severity) {
  switch (severity) {
    case Severity::kError:
      return "1;31";
    case Severity::kWarning:
      return "1;33";
    case Severity::kNote:
      return "1;36";
  }
  return "";
}

struct Mark {
  uint32_t line;
  uint32_t column;  // 1-based
  uint32_t width;
  bool primary;
  std::string message;
};

// A span over several lines is shown on its first line, up to the end of that line.
Mark MakeMark(const SourceSet& sources, Span span, bool primary, std::string message) {
  const Position begin = sources.Locate(span.file, span.begin);
  const Position end = sources.Locate(span.file, std::max(span.begin, span.end));
  const uint32_t line_end = CountCodePoints(sources.Line(span.file, begin.line)) + 1;
  const uint32_t stop = end.line == begin.line ? end.column : line_end;
  return {begin.line, begin.column, stop > begin.column ? stop - begin.column : 1, primary,
          std::move(message)};
}

constexpr uint32_t kWidest = 160;  // code points of a line that are shown
constexpr std::string_view kCut = "\xE2\x80\xA6",
                           kUnknown = "\xEF\xBF\xBD";  // an ellipsis, a replacement character

// What a message quotes may be as long as a file.
std::string Shown(std::string_view text, size_t longest = 300) {
  std::string shown = Escaped(text.substr(0, longest));
  if (text.size() > longest) shown += kCut;
  return shown;
}

// One character for each code point, so that carets stay below what they point at: a space for a tab, and one that says
// so for what cannot be shown.
std::string Flatten(std::string_view line) {
  std::string result;
  for (size_t i = 0; i < line.size();) {
    size_t end = i + 1;
    while (end < line.size() && (static_cast<unsigned char>(line[end]) & 0xC0U) == 0x80U) ++end;
    const std::string_view point = line.substr(i, end - i);
    if (point == "\t")
      result += ' ';
    else
      result += Escaped(point) == point ? point : kUnknown;
    i = end;
  }
  return result;
}

// The part of a line, from a code point on, that is shown; the first is 0.
struct Part {
  std::string text;
  uint32_t first = 0, last = 0;
};

// Around what is marked, if the line is long.
Part PartOf(std::string_view line, const Mark& mark) {
  const uint32_t length = CountCodePoints(line);
  if (length <= kWidest) return {Flatten(line), 0, length};
  const uint32_t before = kWidest / 4;
  const uint32_t first =
      std::min(mark.column - 1 > before ? mark.column - 1 - before : 0, length - kWidest / 2);
  const uint32_t last = std::min(length, first + kWidest);
  size_t begin = 0, end = 0;
  for (size_t i = 0, count = 0; i < line.size(); ++i) {
    if ((static_cast<unsigned char>(line[i]) & 0xC0U) == 0x80U) continue;
    if (count == first) begin = i;
    if (count == last) end = i;
    ++count;
  }
  if (last == length) end = line.size();
  return {(first > 0 ? std::string(kCut) : "") + Flatten(line.substr(begin, end - begin)) +
              (last < length ? std::string(kCut) : ""),
          first, last};
}

}  // namespace

std::string RenderText(const SourceSet& sources, const Diagnostic& d, Colour colour) {
  const Painter paint{colour == Colour::kOn};
  const std::string_view tone = SeverityColour(d.severity);
  std::string out = fmt::format("{}{} [{}]\n", paint(tone, fmt::format("{}: ", SeverityName(d.severity))),
                                Shown(d.message), Info(d.kind).id);

  // The primary file first, then the others in the order of their labels.
  std::vector<FileId> files;
  std::map<FileId, std::vector<Mark>> marks;
  const auto add = [&](Span span, bool primary, const std::string& message) {
    if (!span.file.valid()) return;
    if (!marks.contains(span.file)) files.push_back(span.file);
    marks[span.file].push_back(MakeMark(sources, span, primary, message));
  };
  add(d.span, true, d.label);
  for (const Label& label : d.labels) add(label.span, false, label.message);

  uint32_t last_line = 1;
  for (auto& [file, list] : marks) {
    std::stable_sort(list.begin(), list.end(), [](const Mark& a, const Mark& b) { return a.line < b.line; });
    last_line = std::max(last_line, list.back().line);
  }
  const size_t gutter = std::max<size_t>(2, fmt::formatted_size("{}", last_line));
  const std::string bar = paint("34", fmt::format("{:{}} |", "", gutter));
  for (size_t i = 0; i < files.size(); ++i) {
    const FileId file = files[i];
    const std::vector<Mark>& list = marks[file];
    const auto head = std::find_if(list.begin(), list.end(), [](const Mark& m) { return m.primary; });
    const Mark& at = head != list.end() ? *head : list.front();
    out += fmt::format("{:{}}{} {}:{}:{}\n{}\n", "", gutter, paint("34", i == 0 ? "-->" : ":::"),
                       Escaped(sources.path(file)), at.line, at.column, bar);
    uint32_t shown = 0;
    Part part;
    for (const Mark& mark : list) {
      // Of a long line, each mark has its own part.
      if (mark.line != shown || mark.column - 1 < part.first || mark.column - 1 > part.last) {
        shown = mark.line;
        part = PartOf(sources.Line(file, mark.line), mark);
        out += fmt::format("{} {}\n", paint("34", fmt::format("{:>{}} |", mark.line, gutter)), part.text);
      }
      const uint32_t column = mark.column - 1 - part.first + (part.first > 0 ? 1 : 0);
      const std::string line(
          std::min(mark.width, std::max(1U, part.last + 1 - std::min(part.last, mark.column - 1))),
          mark.primary ? '^' : '-');
      out += fmt::format("{} {:{}}{}{}\n", bar, "", column, paint(mark.primary ? tone : "34", line),
                         mark.message.empty() ? "" : " " + Shown(mark.message));
    }
  }
  for (const std::string& note : d.notes) {
    size_t start = 0;
    bool first = true;
    while (start <= note.size()) {
      const size_t end = std::min(note.find('\n', start), note.size());
      out += fmt::format("{:{}} {} {}\n", "", gutter, paint("34", first ? "=" : "|"),
                         Escaped(std::string_view(note).substr(start, end - start)));
      first = false;
      start = end + 1;
    }
  }
  for (const std::string& help : d.helps)
    out += fmt::format("{} {}\n", paint("32", "help:"), Shown(help, 1000));
  for (const FixIt& fix : d.fixes) {
    const Position begin = sources.Locate(fix.span.file, fix.span.begin);
    const Position end = sources.Locate(fix.span.file, fix.span.end);
    if (begin.line != end.line || fix.replacement.find('\n') != std::string::npos) continue;
    const std::string_view line = sources.Line(fix.span.file, begin.line);
    if (line.size() > kWidest) continue;
    const size_t length = fix.span.end - fix.span.begin;
    const auto at = fix.span.begin - static_cast<size_t>(line.data() - sources.text(fix.span.file).data());
    out += fmt::format(
        "{}\n{} {}{}{}\n{} {:{}}{}\n", bar, paint("34", fmt::format("{:>{}} |", begin.line, gutter)),
        Flatten(line.substr(0, at)), paint("32", fix.replacement), Flatten(line.substr(at + length)), bar, "",
        begin.column - 1, paint("32", std::string(std::max(1u, CountCodePoints(fix.replacement)), '~')));
  }
  return out;
}

std::string RenderLine(const SourceSet& sources, const Diagnostic& d) {
  std::string place;
  if (d.span.file.valid()) {
    const Position at = sources.Locate(d.span.file, d.span.begin);
    place = fmt::format("{}:{}:{}: ", Escaped(sources.path(d.span.file)), at.line, at.column);
  }
  std::string message = Shown(d.message);
  std::ranges::replace(message, '\n', ' ');
  return fmt::format("{}: {}{} [{}]\n", SeverityName(d.severity), place, message, Info(d.kind).id);
}

}  // namespace rondo::diag
