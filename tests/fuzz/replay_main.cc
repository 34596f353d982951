// Runs a fuzz target over every source file below the given folders, and over truncations and mutations of
// each.
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);

namespace {

void Run(const std::string& text) {
  LLVMFuzzerTestOneInput(reinterpret_cast<const uint8_t*>(text.data()), text.size());
}

}  // namespace

int main(int argc, char** argv) {
  size_t files = 0;
  for (int i = 1; i < argc; ++i) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(argv[i])) {
      const auto extension = entry.path().extension();
      if (!entry.is_regular_file() ||
          (extension != ".koord" && extension != ".spec" && extension != ".smt2" && extension != ".rondo" &&
           extension != ".toml" && extension != ".bin"))
        continue;
      std::ifstream in(entry.path(), std::ios::binary);
      const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
      ++files;
      Run(text);
      for (size_t cut = 1; cut < 12; ++cut) Run(text.substr(0, text.size() * cut / 12));
      // Every character in turn is dropped or replaced, in steps that keep this quick.
      const size_t step = text.size() / 40 + 1;
      for (size_t at = 0; at < text.size(); at += step) {
        std::string changed = text;
        changed[at] = "()[]:\n\t \"#=.\\\x80"[(at / step) % 14];
        Run(changed);
        changed.erase(at, 1);
        Run(changed);
      }
    }
  }
  std::printf("%zu files replayed\n", files);
  return files > 0 ? 0 : 1;
}
