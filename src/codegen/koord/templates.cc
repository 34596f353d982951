#include "codegen/koord/templates.h"

namespace rondo::codegen {

const std::string_view kHeader =
    R"(// Made by `rondo build`. Changes are lost when it is made again.
#pragma once

#include <rondo/program/effects.h>

namespace koord::{name} {{

using namespace rondo::program;

inline constexpr int64_t kRobots = {robots};
constexpr bool IsRobot(int64_t robot) {{ return 0 <= robot && robot < kRobots; }}
constexpr int64_t operator""_i(unsigned long long number) {{ return static_cast<int64_t>(number); }}
using Str = Text<{text}>;

{types}namespace param {{

{params}
}}  // namespace param

// What all robots read; the items of arrays of {robots} are written by the robot with that number.
{shared}// What one robot has for itself, what its sensors read, and what its actuators are told.
{local}{in}{out}enum class Event : uint8_t {{ {events} }};

// What an event may write, by variable; of arrays with one item for each robot, the robot's own.
struct Changes {{
{changes}}};
namespace cell {{
enum : size_t {{
{cells}}};
}}  // namespace cell
using Effect = BasicEffect<Event, cell::kCount, Changes, Lines<{lines}, {said}>>;

// Answers the questions that the program asks. Each method is called in the round, and has to answer at once: with `kLater`, the
// robot skips and asks again.
class Calls {{
 public:
  virtual ~Calls() = default;
{calls}}};

struct To;

// Ties the program together, for the functions of `rondo/program/effects.h`.
struct Program {{
  using Shared = ::koord::{name}::Shared;
  using Local = ::koord::{name}::Local;
  using In = ::koord::{name}::In;
  using Out = ::koord::{name}::Out;
  using Event = ::koord::{name}::Event;
  using Changes = ::koord::{name}::Changes;
  using Effect = ::koord::{name}::Effect;
  using Calls = ::koord::{name}::Calls;
  using To = ::koord::{name}::To;
  using InitBody = void (*)(Step&, const View<Program>&, To&);
  struct BeginBody {{
    InitBody body;
    bool per_robot;
  }};
  struct Promise {{
    FormulaCode<Program> when;  ///< no function: always
    FormulaCode<Program> always;
    bool at_end;
  }};
  static constexpr size_t kRobots = {robots};
  static constexpr uint64_t kDigest = {digest:#018x};
  static constexpr size_t kStopped = cell::stopped;
{tables}
  // See `rondo/program/effects.h`.
  static size_t Effects(const Self<Program>& self, Calls& calls, Choice* choice, std::span<Effect> effects) noexcept;
  static void RunEvent(const Self<Program>& self, Event event, Calls& calls, Choice* choice, Effect& effect) noexcept;
  static bool Begin(Shared& shared, std::span<Local> local, std::span<const In> in, std::span<Out> out, Calls& calls,
                    Effect& effect) noexcept;
  static void Init(const Self<Program>& self, Calls& calls, Choice* choice, Effect& effect) noexcept;
  static void FallBack(const Self<Program>& self, size_t fallback, Calls& calls, Effect& effect) noexcept;

  // Calls `cell(number, value in changes, value in the state)` for each variable and item that robot `robot` may write.
  template <typename ChangesType, typename Cell>
  static void EachCell([[maybe_unused]] int64_t robot, ChangesType& changes, [[maybe_unused]] Shared& shared, Local& local,
                       [[maybe_unused]] Out& out, const Cell& cell) {{
{each}  }}
  // Calls `visit(value)` for each variable, and each item of arrays, that all robots may write, and that one robot has of its own.
  template <typename Visit>
  static void EachShared([[maybe_unused]] Shared& shared, const Visit& visit) {{
    (void)visit;
{each_shared}  }}
  template <typename Visit>
  static void EachOwn([[maybe_unused]] size_t robot, [[maybe_unused]] Shared& shared, Local& local, [[maybe_unused]] In& in,
                      [[maybe_unused]] Out& out, const Visit& visit) {{
{each_own}    visit(local.stopped);
  }}
}};

}}  // namespace koord::{name}
)";

const std::string_view kSource =
    R"(// Made by `rondo build`. Changes are lost when it is made again.
{include} "koord/{name}.h"

namespace koord::{name} {{

// Gives events what they may write.
struct To : Writing<Program> {{
{accessors}}};

{functions}// The events: `r` takes faults, `v` is what the robot sees, `to` is where it writes. Comments
// give lines of the program, and braces places in it: the line, the column, and how many bytes.
namespace events {{
namespace {{

{events}}}  // namespace
}}  // namespace events

{formulas}{tables}
size_t Program::Effects(const Self<Program>& self, Calls& calls, Choice* choice, std::span<Effect> effects) noexcept {{
  return rondo::program::Effects<Program>(self, calls, choice, effects);
}}
void Program::RunEvent(const Self<Program>& self, Event event, Calls& calls, Choice* choice, Effect& effect) noexcept {{
  rondo::program::RunEvent<Program>(self, static_cast<size_t>(event), calls, choice, effect);
}}
bool Program::Begin(Shared& shared, std::span<Local> local, std::span<const In> in, std::span<Out> out, Calls& calls,
                    Effect& effect) noexcept {{
  return rondo::program::Begin<Program>(shared, local, in, out, calls, effect);
}}
void Program::Init(const Self<Program>& self, Calls& calls, Choice* choice, Effect& effect) noexcept {{
  rondo::program::Init<Program>(self, calls, choice, effect);
}}
void Program::FallBack(const Self<Program>& self, size_t fallback, Calls& calls, Effect& effect) noexcept {{
  rondo::program::FallBack<Program>(self, fallback, calls, effect);
}}

}}  // namespace koord::{name}
)";

const std::string_view kCore =
    R"(// Made by `rondo build`. Changes are lost when it is made again.
#include <rondo/program/core.h>

{include} "koord/{name}.h"

namespace koord::{name} {{

struct Asking final : Calls {{
  explicit Asking(CoreHost& h) : host(h) {{}}
  CoreHost& host;
  static std::vector<std::string> Questions() {{ return {{{questions}}}; }}
{methods}}};

std::unique_ptr<Core> MakeCore() {{ return std::make_unique<CoreOf<Program, Asking>>(); }}

}}  // namespace koord::{name}
)";

}  // namespace rondo::codegen
