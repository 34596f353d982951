import { el, seconds } from "../dom.ts";
import { last } from "../data/recording.ts";
import type { State } from "../state.ts";

const MOST = 5000; // rows

/** Everything that happened, in words: what is searched for, what should not have been, and the rounds. */
export function eventsScreen(state: State): HTMLElement {
  const { recording } = state;
  const search = el("input", { type: "search", id: "search", placeholder: "search (key /)", "aria-label": "search" });
  const body = el("tbody");
  const count = el("p", { role: "status" });
  let rows: { time: number; row: HTMLElement }[] = [];
  const names = (robots: number[]) => robots.map((r) => recording.robots[r]?.name ?? `robot ${r}`).join(" → ");
  const all = [
    ...recording.happenings,
    ...recording.rounds.map((round) => ({
      time: round.time, kind: `round ${round.round}`, robots: [] as number[], bad: false,
      text: round.events.map((event, i) => (event === "" ? "" : `${recording.robots[i]?.name ?? i}: ${event}`)).filter((t) => t !== "").join(", "),
    })),
  ].sort((a, b) => a.time - b.time);
  const fill = () => {
    const wanted = search.value.toLowerCase();
    const shown = all.filter((h) => wanted === "" || `${h.kind} ${names(h.robots)} ${h.text}`.toLowerCase().includes(wanted));
    rows = shown.slice(0, MOST).map((h) => ({
      time: h.time,
      row: el("tr", h.bad ? { class: "bad" } : {},
        el("td", {}, el("button", { type: "button", click: () => state.change({ time: h.time }) }, seconds(h.time))),
        el("td", {}, h.bad ? `✗ ${h.kind}` : h.kind), el("td", {}, names(h.robots)), el("td", {}, h.text)),
    }));
    body.replaceChildren(...rows.map((r) => r.row));
    count.textContent = `${shown.length} of ${all.length}${shown.length > MOST ? `, the first ${MOST} of them shown` : ""}`;
    mark();
  };
  const mark = () => {
    const now = last(rows.map((r) => r.time), state.look.time);
    rows.forEach((r, i) => r.row.toggleAttribute("data-now", i === now));
    if (state.look.screen === "events") rows[now]?.row.scrollIntoView({ block: "nearest" });
  };
  search.addEventListener("input", fill);
  state.onChange(mark);
  fill();
  return el("div", { class: "events" }, search, count,
    el("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": "events" },
      el("table", {}, el("caption", {}, "What happened"),
        el("thead", {}, el("tr", {}, ...["time", "what", "robots", ""].map((t) => (t === "" ? el("th", { scope: "col" }, "in words") : el("th", { scope: "col" }, t))))), body)));
}
