import uPlot from "uplot";
import { colourOf } from "../colours.ts";
import { type Recording, valueAt } from "../data/recording.ts";
import { el } from "../dom.ts";
import type { State } from "../state.ts";

interface Series {
  label: string;
  robot: number;
  at: (index: number) => number | null;
}

const MOST = 2000; // points

function chart(state: State, title: string, times: number[], series: Series[]): { element: HTMLElement; redraw: () => void } {
  const data = [times, ...series.map((s) => times.map((_, i) => s.at(i)))] as uPlot.AlignedData;
  const cursor = (u: uPlot) => {
    const x = u.valToPos(state.look.time, "x", true);
    u.ctx.save();
    u.ctx.strokeStyle = "#ff3b9d";
    u.ctx.lineWidth = 2;
    u.ctx.beginPath();
    u.ctx.moveTo(x, u.bbox.top);
    u.ctx.lineTo(x, u.bbox.top + u.bbox.height);
    u.ctx.stroke();
    u.ctx.restore();
  };
  const ink = getComputedStyle(document.documentElement).getPropertyValue("--ink").trim() || "#222";
  const axis: uPlot.Axis = { stroke: ink, grid: { stroke: "#8a8f9855" }, ticks: { stroke: "#8a8f98" } };
  const element = el("section", { class: "chart" }, el("h2", {}, title));
  const plot = new uPlot({
    width: 900, height: 240, scales: { x: { time: false } }, axes: [{ ...axis, label: "seconds" }, axis],
    series: [{ label: "s" }, ...series.map((s, i) => ({ label: s.label, stroke: colourOf(s.robot), width: 1.5, dash: i % 3 === 1 ? [8, 4] : i % 3 === 2 ? [2, 3] : [] }))],
    hooks: { draw: [cursor] },
  }, data, element);
  plot.over.addEventListener("click", (event) => state.change({ time: plot.posToVal(event.offsetX, "x") }));
  new ResizeObserver(() => plot.setSize({ width: Math.max(300, element.clientWidth - 24), height: 240 })).observe(element);
  return { element, redraw: () => plot.redraw(false) };
}

function momentsOf(recording: Recording): number[] {
  const steps = Math.min(MOST, Math.max(2, ...recording.robots.map((robot) => robot.pose.times.length)));
  return Array.from({ length: steps }, (_, i) => recording.begin + (recording.end - recording.begin) * i / (steps - 1));
}

/** How the states of robots, or else their places, change; and how near robots come to each other. */
export function plotsScreen(state: State): HTMLElement {
  const { recording } = state;
  const screen = el("div", { class: "plots", tabindex: 0, role: "region", "aria-label": "values over time; the screen of the run has them as a table" });
  const charts: { element: HTMLElement; redraw: () => void }[] = [];
  // Made when they are first looked at: charts need a size.
  const make = () => {
    const times = momentsOf(recording);
    const place = (robot: number, k: number) => (i: number) => {
      const track = recording.robots[robot]!.pose;
      const at = Math.min(track.times.length - 1, Math.round(i / (times.length - 1) * (track.times.length - 1)));
      return track.values[7 * at + k] ?? null;
    };
    const told = recording.robots.some((robot) => robot.states.size > 0);
    if (told) {
      recording.robots.forEach((robot, r) => {
        if (robot.states.size > 0)
          charts.push(chart(state, `${robot.name}: metres, radians`, times, [...robot.states].map(([name, track]) => ({ label: name, robot: r, at: (i) => valueAt(track, times[i]!) }))));
      });
    } else {
      const few = recording.robots.slice(0, 16);
      for (const [k, name] of ["x", "y", "z"].entries())
        charts.push(chart(state, `${name} in metres${few.length < recording.robots.length ? ` (the first ${few.length} robots)` : ""}`, times,
          few.map((robot, r) => ({ label: robot.name, robot: r, at: place(r, k) }))));
    }
    screen.append(...charts.map((c) => c.element));
  };
  state.onChange(() => {
    if (state.look.screen !== "plots") return;
    if (charts.length === 0) make();
    for (const c of charts) c.redraw();
  });
  return screen;
}
