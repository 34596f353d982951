import { readRecording } from "./data/recording.ts";
import { el } from "./dom.ts";
import { keys } from "./keys.ts";
import { eventsScreen } from "./screens/events.ts";
import { plotsScreen } from "./screens/plots.ts";
import { runScreen } from "./screens/run.ts";
import { sourceScreen } from "./screens/source.ts";
import { statesScreen } from "./screens/states.ts";
import { storyScreen } from "./screens/story.ts";
import { SCREENS, type Screen, State } from "./state.ts";
import { timeline } from "./timeline.ts";

const NAMES: Record<Screen, string> = { run: "Run", story: "Story", states: "States", plots: "Plots", events: "Events", source: "Source" };

/** Opens what `rondo view` put into the page: gzip in base64, in a script that is none. */
async function embedded(): Promise<{ name: string; bytes: Uint8Array } | null> {
  const element = document.getElementById("rondo-data");
  const text = element?.textContent?.trim() ?? "";
  if (element === null || text === "") return null;
  const packed = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  return { name: element.dataset["name"] ?? "a trace", bytes: new Uint8Array(await new Response(stream).arrayBuffer()) };
}

function open(name: string, bytes: Uint8Array): void {
  const recording = readRecording(name, bytes);
  const state = new State(recording);
  const made: Record<Screen, () => HTMLElement> = {
    run: () => runScreen(state), story: () => storyScreen(state), states: () => statesScreen(state),
    plots: () => plotsScreen(state),
    events: () => eventsScreen(state), source: () => sourceScreen(state),
  };
  const main = el("main", { id: "screen", tabindex: -1 });
  const tabs = SCREENS.map((screen, i) =>
    el("button", { type: "button", title: `key ${i + 1}`, click: () => state.change({ screen }) }, `${NAMES[screen]}`));
  const dialog = keys(state);
  const help = el("button", { type: "button", title: "key ?", click: () => dialog.showModal() }, "keys");
  const problems = recording.problems.map((text) => el("p", { class: "problem", role: "alert" }, text));
  const bad = recording.happenings.filter((happening) => happening.bad).length;
  const verdict = el("span", { class: bad > 0 ? "verdict bad" : "verdict" }, bad > 0 ? `✗ ${bad} that should not have happened` : "✓ nothing wrong was recorded");
  document.title = recording.title;
  document.body.replaceChildren(
    el("header", {}, el("h1", {}, recording.title), verdict, el("nav", { "aria-label": "screens" }, ...tabs, help)),
    ...problems, main, timeline(state), dialog);
  const screens = new Map<Screen, HTMLElement>();
  let shown: Screen | null = null;
  let noted = false;
  state.onChange(() => {
    const { screen } = state.look;
    tabs.forEach((tab, i) => (SCREENS[i] === screen ? tab.setAttribute("aria-current", "page") : tab.removeAttribute("aria-current")));
    if (!noted) {
      // Browsers slow down whoever writes the address all the time.
      noted = true;
      setTimeout(() => {
        noted = false;
        history.replaceState(null, "", state.toHash());
      }, 100);
    }
    if (screen === shown) return;
    shown = screen;
    if (!screens.has(screen)) {
      screens.set(screen, made[screen]());
      main.replaceChildren(screens.get(screen)!);
      state.change({});
      return;
    }
    main.replaceChildren(screens.get(screen)!);
    state.change({});
  });
  window.addEventListener("hashchange", () => state.fromHash(location.hash));
  state.fromHash(location.hash);
  // A run without any place is looked at as a story.
  if (location.hash === "" && recording.bodies.length === 0 && recording.robots.every((robot) => robot.pose.times.length === 0)) state.change({ screen: "story" });
  run(state);
  Object.assign(window, { rondo: { ...(window as { rondo?: object }).rondo, state } }); // for tests, and for whoever is curious
}

/** Lets time pass while it plays. */
function run(state: State): void {
  let before = performance.now();
  const tick = (now: number) => {
    const dt = Math.min(0.25, (now - before) / 1000);
    before = now;
    if (state.playing) {
      const time = state.look.time + dt * state.speed;
      if (time >= state.recording.end) state.playing = false;
      state.change({ time });
    }
    requestAnimationFrame(tick);
  };
  requestAnimationFrame(tick);
}

/** Asks for a trace, where none is in the page. */
function ask(message: string): void {
  const input = el("input", { type: "file", accept: ".mcap", id: "file" });
  const take = (file: File | undefined) => {
    if (file !== undefined) void file.arrayBuffer().then((buffer) => open(file.name, new Uint8Array(buffer)));
  };
  input.addEventListener("change", () => take(input.files?.[0]));
  document.body.replaceChildren(el("main", { class: "ask" }, el("h1", {}, "Rondo"), el("p", {}, message), el("label", { for: "file" }, "A trace (.mcap), or drop one here: "), input));
  document.body.addEventListener("dragover", (event) => event.preventDefault());
  document.body.addEventListener("drop", (event) => {
    event.preventDefault();
    take(event.dataTransfer?.files[0]);
  });
}

embedded().then(
  (data) => (data === null ? ask("Look at what robots did.") : open(data.name, data.bytes)),
  (error: unknown) => ask(`What is in this page is damaged: ${error instanceof Error ? error.message : String(error)}`));
