import { colourOf } from "../colours.ts";
import { poseAt, valueAt } from "../data/recording.ts";
import { el } from "../dom.ts";
import { Stage } from "../scene/stage.ts";
import type { State } from "../state.ts";

const PAUSE = 100; // milliseconds between two versions of the table, while it plays
const MOST = 200; // rows: beyond, only the robot that is chosen is shown besides

/** The space of the run, and beside it in words where everybody is. */
export function runScreen(state: State): HTMLElement {
  const stage = new Stage(state);
  const { robots } = state.recording;
  const button = (text: string, key: string, act: () => void) => el("button", { type: "button", title: `key ${key}`, click: act }, text);
  const tools = el("div", { class: "tools" },
    button("from above / at an angle", "T", () => state.change({ from: state.look.from === "top" ? "angle" : "top" })),
    button("follow", "F", () => state.change({ follow: !state.look.follow })),
    button("everything", "0", () => stage.home()),
    button("save a picture", "P", () => void save(stage)));
  const rows = robots.map((robot, i) => new Row(state, robot.name, i));
  const body = el("tbody", {}, ...rows.slice(0, MOST).flatMap((row) => row.elements));
  const table = el("table", { class: "robots" },
    el("caption", {}, `Where the robots are: metres, degrees${robots.length > MOST ? ` (the first ${MOST} of ${robots.length}, and the chosen one)` : ""}`),
    el("thead", {}, el("tr", {}, ...["robot", "x", "y", "z", "heading"].map((name) => el("th", { scope: "col" }, name)))), body);
  let extra = -1, updated = 0;
  const update = () => {
    // Nobody reads numbers faster.
    const now = performance.now();
    if (state.look.screen !== "run" || (state.playing && now - updated < PAUSE)) return;
    updated = now;
    const wanted = state.look.robot >= MOST ? state.look.robot : -1;
    if (wanted !== extra) {
      if (extra >= 0) rows[extra]!.elements.forEach((element) => element.remove());
      if (wanted >= 0) body.prepend(...rows[wanted]!.elements);
      extra = wanted;
    }
    rows.slice(0, MOST).forEach((row) => row.update());
    if (extra >= 0) rows[extra]!.update();
  };
  state.onChange(update);
  window.addEventListener("rondo-home", () => stage.home());
  window.addEventListener("rondo-picture", () => void save(stage));
  Object.assign(window, { rondo: { state, stage } });
  return el("div", { class: "run" }, stage.element, el("aside", { class: "side", tabindex: 0, "aria-label": "where the robots are" }, tools, table));
}

/** What the table says of one robot: made once, written anew where it changed. */
class Row {
  readonly elements: HTMLElement[];
  private readonly choose: HTMLElement;
  private readonly cells = Array.from({ length: 4 }, () => el("td"));
  private readonly states = el("td", { class: "of", colspan: 5 });

  constructor(private readonly state: State, name: string, private readonly index: number) {
    this.choose = el("button", { type: "button", click: () => state.change({ robot: this.chosen() ? -1 : index }) }, name);
    this.choose.style.borderLeft = `0.6em solid ${colourOf(index)}`;
    this.elements = [el("tr", {}, el("th", { scope: "row" }, this.choose), ...this.cells)];
    if (state.recording.robots[index]!.states.size > 0) this.elements.push(el("tr", {}, this.states));
  }

  private chosen(): boolean {
    return this.index === this.state.look.robot;
  }

  update(): void {
    const { look, recording } = this.state;
    const robot = recording.robots[this.index]!;
    const pose = poseAt(robot, look.time);
    const [x, y, z, w] = pose?.rotation ?? [0, 0, 0, 1];
    const heading = Math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)) * 180 / Math.PI;
    const numbers = pose === null ? ["", "", "", ""] : [...pose.position.map((v) => v.toFixed(3)), heading.toFixed(1)];
    this.cells.forEach((cell, k) => write(cell, numbers[k]!));
    write(this.states, [...robot.states].map(([name, track]) => `${name} ${valueAt(track, look.time)?.toFixed(3) ?? "?"}`).join(", "));
    this.choose.setAttribute("aria-pressed", this.chosen() ? "true" : "false");
    for (const element of this.elements) element.classList.toggle("chosen", this.chosen());
  }
}

function write(element: HTMLElement, text: string): void {
  if (element.textContent !== text) element.textContent = text;
}

async function save(stage: Stage): Promise<void> {
  const blob = await stage.picture();
  if (blob === null) return;
  const link = el("a", { href: URL.createObjectURL(blob), download: "run.png" });
  link.click();
  URL.revokeObjectURL(link.href);
}
