import { string } from "../data/recording.ts";
import { el } from "../dom.ts";
import type { State } from "../state.ts";

/** The texts that made the run, as the trace keeps them, and what else it says of itself. */
export function sourceScreen(state: State): HTMLElement {
  const { run } = state.recording;
  const texts = new Map<string, string>();
  for (const name of ["program", "spec", "fleet"]) {
    if (string(run[name]) !== "") texts.set(name, string(run[name]));
  }
  const kept = run["texts"];
  if (typeof kept === "object" && kept !== null) {
    for (const [name, text] of Object.entries(kept)) texts.set(name, string(text));
  }
  const facts = Object.entries(run).filter(([, value]) => ["string", "number", "boolean"].includes(typeof value) && String(value).length < 80);
  const screen = el("div", { class: "source", tabindex: 0, role: "region", "aria-label": "the texts that made the run" });
  if (texts.size === 0) screen.append(el("p", {}, "The trace keeps no texts."));
  for (const [name, text] of texts) {
    const lines = text.split("\n").map((line) => el("li", {}, line === "" ? " " : line));
    screen.append(el("details", texts.size === 1 || name === "program" || lines.length < 80 ? { open: true } : {}, el("summary", {}, name), el("ol", { class: "code" }, ...lines)));
  }
  screen.append(el("details", {}, el("summary", {}, "about the run"),
    el("dl", {}, ...facts.flatMap(([name, value]) => [el("dt", {}, name), el("dd", {}, String(value))]))));
  return screen;
}
