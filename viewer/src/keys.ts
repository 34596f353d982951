import { el } from "./dom.ts";
import { SCREENS, type State } from "./state.ts";

const HELP: [string, string][] = [
  ["Space", "play or pause"],
  ["← →", "one round back or on; one second where there are no rounds"],
  ["Shift + ← →", "to what happened before or next"],
  ["N, B", "to the next or the last thing that should not have happened"],
  ["Home, End", "to the beginning or the end"],
  [`1 … ${SCREENS.length}`, "the screens"],
  ["T", "look from above or at an angle"],
  ["F", "follow the chosen robot"],
  ["J, K", "choose the next or the last robot; Escape: none"],
  ["0", "look at everything"],
  ["P", "save a picture"],
  ["/", "search what happened"],
  ["?", "this help"],
];

/** Lets keys alone reach everything. Returns the help, which is to be put into the page. */
export function keys(state: State): HTMLDialogElement {
  const dialog = el("dialog", { "aria-label": "keys" },
    el("h2", {}, "Keys"),
    el("dl", {}, ...HELP.flatMap(([key, what]) => [el("dt", {}, key), el("dd", {}, what)])),
    el("p", {}, "In the space: drag turns, the right button moves, the wheel comes nearer; two double clicks measure a distance on the ground."),
    el("button", { type: "button", click: () => dialog.close() }, "close"));
  const choose = (step: number) => {
    const count = state.recording.robots.length;
    if (count > 0) state.change({ robot: (Math.max(state.look.robot, step > 0 ? -1 : 0) + step + count) % count });
  };
  const actions: Record<string, () => void> = {
    " ": () => state.play(!state.playing),
    Home: () => state.change({ time: state.recording.begin }),
    End: () => state.change({ time: state.recording.end }),
    n: () => state.jump(1, (happening) => happening.bad),
    b: () => state.jump(-1, (happening) => happening.bad),
    t: () => state.change({ from: state.look.from === "top" ? "angle" : "top", screen: "run" }),
    f: () => state.change({ follow: !state.look.follow }),
    j: () => choose(1),
    k: () => choose(-1),
    Escape: () => state.change({ robot: -1 }),
    "0": () => window.dispatchEvent(new Event("rondo-home")),
    p: () => window.dispatchEvent(new Event("rondo-picture")),
    "/": () => {
      state.change({ screen: "events" });
      document.getElementById("search")?.focus();
    },
    "?": () => dialog.showModal(),
  };
  SCREENS.forEach((screen, i) => { actions[String(i + 1)] = () => state.change({ screen }); });
  window.addEventListener("keydown", (event) => {
    if (dialog.open || event.ctrlKey || event.metaKey || event.altKey) return;
    const target = event.target as HTMLElement;
    const writes = target instanceof HTMLInputElement && target.type === "search";
    if (writes && event.key !== "Escape") return;
    if (writes) target.blur();
    const arrow = event.key === "ArrowRight" ? 1 : event.key === "ArrowLeft" ? -1 : 0;
    // Sliders and lists have arrows of their own, buttons a space.
    const own = target instanceof HTMLInputElement || target instanceof HTMLSelectElement;
    if (arrow !== 0 && !own) {
      if (event.shiftKey) state.jump(arrow, () => true);
      else state.step(arrow);
      event.preventDefault();
      return;
    }
    const act = actions[event.key] ?? actions[event.key.toLowerCase()];
    if (act === undefined || (event.key === " " && target instanceof HTMLButtonElement) || (own && event.key !== "?" && event.key.length > 1)) return;
    act();
    event.preventDefault();
  });
  return dialog;
}
