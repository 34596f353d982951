// Any datagrams and any record on the disk: a core with a Koord program behind it takes them, and ends. Each datagram
// gets the sum that it needs, so that what is behind it is tried, too.
#include <algorithm>
#include <cstdint>
#include <memory>

#include "koord/check/check.h"
#include "koord/node/node.h"
#include "koord/syntax/parser.h"
#include "runtime/rounds/core.h"

namespace {

using namespace rondo;
using runtime::codec::Bytes;
using runtime::codec::View;

constexpr const char* kProgram =
    "using M:\n    sensors:\n        float x\nallwrite:\n    List<int> queue\n    string name = \"a\"\nallread:\n    int "
    "c[N_sys]\nAdd:\n    eff:\n        atomic:\n            queue.append(pid)\n        c[pid] += 1\n";

// Compiled once; a run leaves no more behind than lists.
struct Compiled {
  Compiled() {
    Parse(sources, sources.Add("fuzz.koord", kProgram), program, diagnostics);
    model = Check(program, diagnostics);
    team = koord::semantics::Team::Make(model, {3, {}, {}, {}}, diagnostics);
  }
  diag::SourceSet sources;
  diag::Diagnostics diagnostics;
  koord::Program program;
  koord::Model model;
  std::unique_ptr<koord::semantics::Team> team;
};

void Seal(Bytes& bytes, size_t at, View summed) {
  const uint64_t sum = runtime::codec::Sum(summed);
  for (size_t i = 0; i < 8; ++i) bytes[at + i] = static_cast<uint8_t>(sum >> (8 * i));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static Compiled compiled;
  koord::node::Node node(*compiled.team, 0, nullptr, 1);
  View input(data, size);
  // Two bytes of length, and so many bytes.
  const auto take = [&] {
    const size_t header = std::min<size_t>(2, input.size());
    size_t count = 0;
    for (size_t i = 0; i < header; ++i) count |= size_t{input[i]} << (8 * i);
    input = input.subspan(header);
    const View taken = input.first(std::min(count, input.size()));
    input = input.subspan(taken.size());
    return Bytes(taken.begin(), taken.end());
  };
  runtime::rounds::Settings settings;
  settings.robots = 3;
  settings.on_loss = runtime::rounds::OnLoss::kEvict;
  Bytes record = take();
  settings.parts = runtime::rounds::PartsOf(static_cast<runtime::rounds::Exchange>(record.size() % 3));
  record.resize(record.size() + 8);
  Seal(record, record.size() - 8, View(record).first(record.size() - 8));
  runtime::rounds::Core core(settings, node, nullptr, record);
  runtime::rounds::Outputs outputs;
  runtime::rounds::Time now = 0;
  core.Step(now, {}, outputs);
  while (!input.empty()) {
    Bytes datagram(8);
    const Bytes body = take();
    datagram.insert(datagram.end(), body.begin(), body.end());
    Seal(datagram, 0, View(datagram).subspan(8));
    outputs.Clear();
    now += 1'000'000 * (1 + static_cast<int64_t>(body.size() % 200));
    core.Step(now, datagram, outputs);
  }
  return 0;
}
