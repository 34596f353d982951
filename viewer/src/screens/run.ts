import { colourOf } from "../colours.ts";
import { poseAt, valueAt } from "../data/recording.ts";
import { el } from "../dom.ts";
import { Stage } from "../scene/stage.ts";
import type { State } from "../state.ts";

/** The space of the run, and beside it in words where everybody is. */
export function runScreen(state: State): HTMLElement {
  const stage = new Stage(state);
  const table = el("table", { class: "robots" });
  const button = (text: string, key: string, act: () => void) => el("button", { type: "button", title: `key ${key}`, click: act }, text);
  const tools = el("div", { class: "tools" },
    button("from above / at an angle", "T", () => state.change({ from: state.look.from === "top" ? "angle" : "top" })),
    button("follow", "F", () => state.change({ follow: !state.look.follow })),
    button("everything", "0", () => stage.home()),
    button("save a picture", "P", () => void save(stage)));
  const update = () => {
    if (state.look.screen !== "run") return;
    table.replaceChildren(
      el("caption", {}, "Where the robots are: metres, degrees"),
      el("thead", {}, el("tr", {}, ...["robot", "x", "y", "z", "heading"].map((name) => el("th", { scope: "col" }, name)))),
      el("tbody", {}, ...state.recording.robots.flatMap((robot, i) => rows(state, robot.name, i))));
  };
  state.onChange(update);
  window.addEventListener("rondo-home", () => stage.home());
  window.addEventListener("rondo-picture", () => void save(stage));
  return el("div", { class: "run" }, stage.element, el("aside", { class: "side", tabindex: 0, "aria-label": "where the robots are" }, tools, table));
}

function rows(state: State, name: string, index: number): HTMLElement[] {
  const robot = state.recording.robots[index]!;
  const pose = poseAt(robot, state.look.time);
  const [x, y, z, w] = pose?.rotation ?? [0, 0, 0, 1];
  const heading = Math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)) * 180 / Math.PI;
  const states = [...robot.states].map(([state_, track]) => `${state_} ${valueAt(track, state.look.time)?.toFixed(3) ?? "?"}`).join(", ");
  const chosen = index === state.look.robot;
  const choose = el("button", { type: "button", "aria-pressed": chosen ? "true" : "false", click: () => state.change({ robot: chosen ? -1 : index }) }, name);
  choose.style.borderLeft = `0.6em solid ${colourOf(index)}`;
  const numbers = pose === null ? ["", "", "", ""] : [...pose.position.map((v) => v.toFixed(3)), heading.toFixed(1)];
  const mark = chosen ? { class: "chosen" } : {};
  const first = el("tr", mark, el("th", { scope: "row" }, choose), ...numbers.map((text) => el("td", {}, text)));
  return states === "" ? [first] : [first, el("tr", mark, el("td", { class: "of", colspan: 5 }, states))];
}

async function save(stage: Stage): Promise<void> {
  const blob = await stage.picture();
  if (blob === null) return;
  const link = el("a", { href: URL.createObjectURL(blob), download: "run.png" });
  link.click();
  URL.revokeObjectURL(link.href);
}
