#pragma once

#include "runtime/rounds/settings.h"
#include "sim/fleet/tables.h"

namespace rondo::sim {

/// Reads `on_loss`: `halt`, `wait` or `evict`. Reports other words, and `evict` for two robots, which have no
/// majority without each other.
runtime::rounds::OnLoss ReadOnLoss(Tables& tables, const toml::table& table, runtime::rounds::OnLoss usual,
                                   size_t robots);

/// Reads `exchange`: `all-to-all`, `sequencer` or `central`. Reports other words.
runtime::rounds::Exchange ReadExchange(Tables& tables, const toml::table& table,
                                       runtime::rounds::Exchange usual);

}  // namespace rondo::sim
