#pragma once

#include "base/ring.h"
#include "runtime/rounds/outputs.h"

namespace rondo::transport {

/// Returns what CLOCK_BOOTTIME says, in nanoseconds: it never steps back and runs through suspension.
runtime::rounds::Time BootTime();
/// Converts a span to seconds, as people have them.
inline double Seconds(runtime::rounds::Time span) { return static_cast<double>(span) * 1e-9; }

/// Hands datagrams from threads to another one.
class Mailbox {
 public:
  /// Is a datagram, and whom it is for.
  struct Letter {
    uint32_t to = 0;
    runtime::codec::Bytes bytes;
  };

  /// @param longest  how many wait at most; the oldest give way.
  explicit Mailbox(size_t longest) : letters_(longest) {}

  void Put(uint32_t to, runtime::codec::View bytes);
  /// Waits until this moment, at most, for the oldest letter. Returns false, with `letter` empty, if there was none.
  bool Take(runtime::rounds::Time until, Letter& letter);
  /// Ends all waiting, for ever.
  void Close() { letters_.Close(); }
  bool closed() const { return letters_.closed(); }

 private:
  base::Ring<Letter> letters_;
};

}  // namespace rondo::transport
