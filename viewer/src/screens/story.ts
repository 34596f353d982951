import { colourOf } from "../colours.ts";
import { el, seconds, svg } from "../dom.ts";
import type { State } from "../state.ts";

const AXIS = 104, NARROW = 190, WIDE = 420, SECOND = 40, MOST = 30_000, HEAD = 40; // pixels

/**
 * A lane for each robot, time downwards: what it did for how long, messages as arrows, rounds as lines with the event that each robot ran.
 * The cursor is a line; a click moves it.
 */
export function storyScreen(state: State): HTMLElement {
  const { recording } = state;
  const lane = Math.max(NARROW, Math.min(WIDE, (window.innerWidth - AXIS - 40) / Math.max(1, recording.robots.length)));
  const scale = Math.min(SECOND, MOST / Math.max(1, recording.end - recording.begin));
  const y = (time: number) => 14 + (time - recording.begin) * scale;
  const x = (robot: number) => AXIS + lane * (robot + 0.5);
  const width = AXIS + lane * recording.robots.length + 20;
  const height = y(recording.end) + 30;
  const drawing = svg("svg", { width, height, viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": "what each robot did; the screen of events says the same in words" });
  const heads = svg("svg", { width, height: HEAD, class: "heads", role: "img", "aria-label": "the robots" });
  recording.robots.forEach((robot, i) => {
    drawing.append(svg("line", { x1: x(i), x2: x(i), y1: 0, y2: height, class: "lane" }));
    heads.append(
      svg("rect", { x: x(i) - lane / 2 + 8, y: 8, width: lane - 16, height: 24, rx: 4, fill: colourOf(i) }),
      svg("text", { x: x(i), y: 25, class: "name" }, short(robot.name, lane - 24)));
  });
  const step = [0.1, 0.2, 0.5, 1, 2, 5, 10, 30, 60, 300, 600].find((s) => s * scale >= 40) ?? 3600;
  for (let t = Math.ceil(recording.begin / step) * step; t <= recording.end; t += step)
    drawing.append(svg("line", { x1: AXIS - 6, x2: width, y1: y(t), y2: y(t), class: "tick" }), svg("text", { x: AXIS - 10, y: y(t) + 4, class: "time" }, seconds(t)));
  for (const span of recording.spans) {
    const h = Math.max(2, (span.to - span.from) * scale);
    const bar = svg("rect", { x: x(span.robot) - 7, y: y(span.from), width: 14, height: h, rx: 3, class: "span", fill: colourOf(span.robot) });
    bar.append(svg("title", {}, `${span.text}, ${seconds(span.from)} to ${seconds(span.to)}`));
    drawing.append(bar);
    if (h >= 14) drawing.append(svg("text", { x: x(span.robot) + 12, y: y(span.from) + 12, class: "small" }, short(span.text, lane / 2 - 8)));
  }
  let below = -Infinity;
  for (const round of recording.rounds) {
    if (y(round.time) < below) continue; // too near: the table has all
    below = y(round.time) + 14;
    round.events.forEach((event, robot) => {
      if (event !== "") drawing.append(svg("text", { x: x(robot), y: y(round.time) + 4, class: "event" }, short(event, lane - 12)));
    });
    drawing.append(svg("text", { x: 4, y: y(round.time) + 4, class: "small" }, `#${round.round}`));
  }
  // Messages of one moment stand below each other, in their order.
  let free = -Infinity;
  for (const arrow of recording.arrows) {
    const [from, to, at] = [x(arrow.from), x(arrow.to), Math.max(y(arrow.time), free)];
    free = at + 15;
    const back = to > from ? -1 : 1;
    drawing.append(
      svg("path", { d: `M ${from} ${at} H ${to} m ${7 * back} -4 l ${-7 * back} 4 l ${7 * back} 4`, class: "arrow" }),
      svg("text", { x: from + (to > from ? lane : -lane) / 2, y: at - 4, class: "message" }, short(arrow.text, lane - 20)));
  }
  for (const happening of recording.happenings.filter((h) => h.bad))
    drawing.append(svg("text", { x: AXIS + 4, y: y(happening.time) + 18, class: "bad" }, `✗ ${happening.text}`));
  const cursor = svg("line", { x1: 0, x2: width, class: "cursor" });
  drawing.append(cursor);
  drawing.addEventListener("click", (event) => {
    const box = drawing.getBoundingClientRect();
    state.change({ time: recording.begin + ((event as MouseEvent).clientY - box.top - 14) / scale });
  });
  const scroller = el("div", { class: "story", tabindex: 0, role: "region", "aria-label": "what each robot did" });
  scroller.append(heads, drawing);
  state.onChange(() => {
    if (state.look.screen !== "story") return;
    const at = y(state.look.time);
    cursor.setAttribute("y1", String(at));
    cursor.setAttribute("y2", String(at));
    const { scrollTop, clientHeight } = scroller;
    if (at < scrollTop + HEAD || at > scrollTop + clientHeight - 40) scroller.scrollTop = at - clientHeight / 2;
  });
  return scroller;
}

function short(text: string, width: number): string {
  const most = Math.max(3, Math.floor(width / 6.2));
  return text.length <= most ? text : `${text.slice(0, most - 1)}…`;
}
