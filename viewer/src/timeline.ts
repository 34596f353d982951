import { el, seconds } from "./dom.ts";
import type { State } from "./state.ts";

const BARS = 240;
const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 5, 10, 50];

/** The one clock of the page: plays, and moves through the run. Above it, how much happened when; red, what should not have. */
export function timeline(state: State): HTMLElement {
  const { recording } = state;
  const slider = el("input", { type: "range", min: recording.begin, max: recording.end, step: "any", "aria-label": "time" });
  const clock = el("output", { class: "clock" });
  const said = el("p", { class: "said", "aria-live": "polite" });
  const play = el("button", { type: "button", class: "play", title: "key Space", click: () => state.play(!state.playing) }, "play");
  const speed = el("select", { "aria-label": "speed", change: () => { state.speed = Number(speed.value); } },
    ...SPEEDS.map((s) => el("option", { value: s, ...(s === 1 ? { selected: true } : {}) }, `${s} ×`)));
  const density = el("canvas", { class: "density", width: BARS, height: 20, "aria-hidden": "true" });
  draw(density, state);
  slider.addEventListener("input", () => state.change({ time: Number(slider.value) }));
  let round = -2;
  state.onChange(() => {
    slider.value = String(state.look.time);
    slider.setAttribute("aria-valuetext", seconds(state.look.time));
    play.textContent = state.playing ? "pause" : "play";
    const now = state.round();
    clock.textContent = `${seconds(state.look.time)} of ${seconds(recording.end)}${now < 0 ? "" : `, round ${recording.rounds[now]!.round}`}`;
    if (now !== round && !state.playing && now >= 0) said.textContent = `round ${recording.rounds[now]!.round}`;
    round = now;
  });
  return el("footer", { class: "timeline" }, play, speed, el("div", { class: "track" }, density, slider), clock, said);
}

function draw(canvas: HTMLCanvasElement, state: State): void {
  const { begin, end, happenings, arrows, rounds } = state.recording;
  const context = canvas.getContext("2d");
  if (context === null) return;
  const bar = (time: number) => Math.min(BARS - 1, Math.max(0, Math.floor((time - begin) / Math.max(1e-9, end - begin) * BARS)));
  const counts = new Array<number>(BARS).fill(0);
  for (const happened of [...happenings, ...arrows, ...rounds]) counts[bar(happened.time)]! += 1;
  const most = Math.max(1, ...counts);
  context.fillStyle = "#8a8f98";
  counts.forEach((count, i) => context.fillRect(i, 20 - 18 * count / most, 1, 18 * count / most));
  context.fillStyle = "#e0312d";
  for (const happening of happenings) {
    if (happening.bad) context.fillRect(bar(happening.time) - 1, 0, 3, 20);
  }
}
