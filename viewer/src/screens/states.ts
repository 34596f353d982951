import { type Json, last } from "../data/recording.ts";
import { el } from "../dom.ts";
import type { State } from "../state.ts";

/** Returns the parts of a value that are no lists or objects themselves, by where they stand: `x[2].y`. */
function leaves(value: unknown, path: string, into: Map<string, string>): Map<string, string> {
  if (Array.isArray(value)) {
    if (value.length === 0) into.set(path, "[]");
    value.forEach((part, i) => leaves(part, `${path}[${i}]`, into));
  } else if (typeof value === "object" && value !== null) {
    for (const [name, part] of Object.entries(value)) leaves(part, path === "" ? name : `${path}.${name}`, into);
  } else {
    into.set(path, typeof value === "string" ? value : JSON.stringify(value));
  }
  return into;
}

/** What all variables are after the step that is looked at, and what they were before it. */
export function statesScreen(state: State): HTMLElement {
  const { states } = state.recording;
  const all = states.map((s) => leaves(s.state satisfies Json, "", new Map<string, string>()));
  const only = el("input", { type: "checkbox", id: "only", checked: true });
  const body = el("tbody");
  const title = el("h2", {});
  const fill = () => {
    if (state.look.screen !== "states") return;
    const i = Math.max(0, last(states.map((s) => s.time), state.look.time));
    const now = all[i] ?? new Map<string, string>(), before = i > 0 ? all[i - 1]! : now;
    title.textContent = states.length === 0 ? "The trace has no states of programs." : `${states[i]!.label}, ${i + 1} of ${states.length}`;
    const names = [...new Set([...before.keys(), ...now.keys()])];
    const rows = names.map((name) => ({ name, was: before.get(name) ?? "", is: now.get(name) ?? "" }));
    const shown = rows.filter((row) => !only.checked || i === 0 || row.was !== row.is);
    body.replaceChildren(...shown.map((row) => el("tr", row.was === row.is ? {} : { class: "changed" },
      el("th", { scope: "row" }, row.name), el("td", {}, row.was === row.is ? "" : row.was === "" ? "(nothing)" : row.was), el("td", {}, row.is === "" ? "(nothing)" : row.is))));
    if (shown.length === 0 && states.length > 0) body.append(el("tr", {}, el("td", { colspan: 3 }, "nothing changed")));
  };
  only.addEventListener("change", fill);
  state.onChange(fill);
  return el("div", { class: "states", tabindex: 0, role: "region", "aria-label": "variables" }, title,
    el("p", {}, only, el("label", { for: "only" }, " only what the step changed")),
    el("table", {}, el("caption", {}, "Variables"),
      el("thead", {}, el("tr", {}, ...["variable", "before", "after"].map((name) => el("th", { scope: "col" }, name)))), body));
}
