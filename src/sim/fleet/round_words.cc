#include "sim/fleet/round_words.h"

#include <algorithm>

namespace rondo::sim {

using runtime::rounds::Exchange;
using runtime::rounds::OnLoss;

OnLoss ReadOnLoss(Tables& tables, const toml::table& table, OnLoss usual, size_t robots) {
  const std::vector<std::string> words = {"halt", "wait", "evict"};  // in the order of the enumeration
  const std::string word = tables.Word(table, "on_loss", std::string(Name(usual)), words);
  const auto on_loss = static_cast<OnLoss>(std::ranges::find(words, word) - words.begin());
  const toml::node* node = table.get("on_loss");
  if (on_loss == OnLoss::kEvict && robots == 2 && node != nullptr)
    tables.Wrong(tables.At(*node), "two robots have no majority without each other, so none can be evicted");
  return on_loss;
}

Exchange ReadExchange(Tables& tables, const toml::table& table, Exchange usual) {
  std::vector<std::string> words;
  for (const Exchange e : {Exchange::kAllToAll, Exchange::kSequencer, Exchange::kCentral})
    words.emplace_back(Name(e));
  const std::string word = tables.Word(table, "exchange", std::string(Name(usual)), words);
  return static_cast<Exchange>(std::ranges::find(words, word) - words.begin());
}

}  // namespace rondo::sim
