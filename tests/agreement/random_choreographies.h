#pragma once

#include <array>
#include <random>
#include <string>

namespace rondo::choreo {

/// Writes a random choreography of three robots. Most are not well-formed.
class RandomChoreography {
 public:
  explicit RandomChoreography(uint64_t seed) : rng_(seed) {}

  std::string Whole() {
    std::string text =
        "robot R {\n state x : length in [-9 m, 9 m]\n motion Idle() interruptible [0 s, inf) {}\n motion "
        "Go() noninterruptible [1 s, 1 s] {}\n motion Slow() noninterruptible [1 s, 2 s] {}\n motion "
        "Rest() interruptible [0 s, 2 s] {}\n motion Mid() interruptible [1 s, 2 s] {}\n}\n"
        "world W { a: R b: R c: R }\nchoreography C in W {\n";
    if (Pick(4) == 0) text += "option equal_durations\n";
    return text + Steps("abc", 3) + "}\n";
  }

 private:
  size_t Pick(size_t n) { return static_cast<size_t>(rng_() % n); }

  std::string Message(const std::string& robots) {
    const size_t from = Pick(robots.size());
    const size_t to = (from + 1 + Pick(robots.size() - 1)) % robots.size();
    return std::string(1, robots[from]) + " -> " + robots[to] + ": l" + std::to_string(Pick(3)) + "()\n";
  }

  std::string Motion(const std::string& robots) {
    const size_t going = Pick(robots.size() + 1);
    std::string text = "{ ";
    for (size_t r = 0; r < robots.size(); ++r)
      text += std::string(r == 0 ? "" : ", ") + robots[r] + ": " +
              (r == going     ? "Go()"
               : Pick(4) == 0 ? Motion()
                              : "Idle()");
    return text + " }\n";
  }

  std::string Motion() {
    static constexpr std::array<const char*, 6> kMotions = {"Idle()", "Idle()", "Go()",
                                                            "Slow()", "Rest()", "Mid()"};
    return kMotions[Pick(kMotions.size())];
  }

  std::string Steps(const std::string& robots, int depth) {
    std::string text;
    const size_t count = 1 + Pick(3);
    for (size_t i = 0; i < count; ++i) text += Step(robots, depth);
    return text;
  }

  std::string Step(const std::string& robots, int depth) {
    if (robots.size() == 1) return robots + ": " + Motion() + "\n";
    switch (depth == 0 ? Pick(2) : Pick(7)) {
      case 0:
      case 1:
        return Message(robots);
      case 2:
        return Motion(robots);
      case 3: {
        const char chooser = robots[Pick(robots.size())];
        std::string text = std::string("choose at ") + chooser + " {\n";
        for (int b = 0; b < 2; ++b) {
          const char other = robots[(robots.find(chooser) + 1 + Pick(robots.size() - 1)) % robots.size()];
          text += std::string("when ") + chooser + ".x > 0 m {\n" + chooser + " -> " + other + ": k" +
                  std::to_string(b) + "()\n" + Steps(robots, depth - 1) + "}\n";
        }
        return text + "}\n";
      }
      case 4: {
        const size_t lone = Pick(robots.size());
        const char last = robots[lone];
        const std::string rest = robots.substr(0, lone) + robots.substr(lone + 1);
        return "parallel {\nthread {\n" + Steps(rest, depth - 1) + "}\nthread {\n" +
               Steps(std::string(1, last), depth - 1) + "}\n}\n";
      }
      case 5:
        return "rec X" + std::to_string(depth) + " {\n" + Steps(robots, depth - 1) + Leave(robots, depth) +
               "}\n";
      default:
        return Message(robots) + Motion(robots);
    }
  }

  // Either round again or on; the others are told by one who knows.
  std::string Leave(const std::string& robots, int depth) {
    const char chooser = robots[Pick(robots.size())];
    std::string again, on;
    for (const char r : robots) {
      if (r == chooser) continue;
      again += std::string(1, chooser) + " -> " + r + ": again()\n";
      on += std::string(1, chooser) + " -> " + r + ": on()\n";
    }
    return std::string("choose at ") + chooser + " {\nwhen " + chooser + ".x > 0 m {\n" + again +
           "continue X" + std::to_string(depth) + " }\nwhen " + chooser + ".x <= 0 m {\n" + on + "}\n}\n";
  }

  std::mt19937_64 rng_;
};

}  // namespace rondo::choreo
