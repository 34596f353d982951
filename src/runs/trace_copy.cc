#include "runs/trace_copy.h"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <vector>

#include "trace/reader.h"

namespace rondo::runs {
namespace {

std::string Name(const trace::Message& m) {
  return fmt::format("{} at t = {:.6f} s", m.topic, static_cast<double>(m.time) * 1e-9);
}

}  // namespace

base::Result<std::string> CopyOf(const std::function<base::Result<bool>(const std::string& path)>& write) {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / fmt::format("rondo-replay-{}.mcap", ::getpid());
  const auto written = write(path.string());
  if (!written.ok())
    return base::Error{fmt::format("cannot write `{}`: {}", path.string(), written.error().message)};
  auto bytes = trace::ReadTrace(path.string());
  std::error_code ignored;
  std::filesystem::remove(path, ignored);
  return bytes;
}

std::string FirstDifference(std::string_view a, std::string_view b) {
  struct Kept {
    std::string name;
    std::string bytes;
    uint64_t time;
  };
  std::vector<Kept> first;
  const auto keep = trace::ForEachMessage(a, [&](const trace::Message& m) {
    first.push_back({Name(m), std::string(m.topic) + std::string(m.bytes), m.time});
    return true;
  });
  if (!keep.ok()) return keep.error().message;
  size_t i = 0;
  std::string result;
  const auto compare = trace::ForEachMessage(b, [&](const trace::Message& m) {
    if (i >= first.size())
      result = fmt::format("the run goes on: {}", Name(m));
    else if (first[i].time != m.time || first[i].bytes != std::string(m.topic) + std::string(m.bytes))
      result = first[i].name == Name(m) ? first[i].name
                                        : fmt::format("{} in the trace, {} now", first[i].name, Name(m));
    ++i;
    return result.empty();
  });
  if (!compare.ok()) return compare.error().message;
  if (result.empty() && i < first.size())
    result = fmt::format("the run ends earlier: {} is missing", first[i].name);
  return result.empty() ? "the messages are the same; the files differ in their index" : result;
}

}  // namespace rondo::runs
