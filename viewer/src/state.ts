import { last, type Happening, type Recording } from "./data/recording.ts";

export const SCREENS = ["run", "story", "states", "plots", "events", "source"] as const;
export type Screen = (typeof SCREENS)[number];

/** What is looked at: one moment, one robot, one screen. Lives in the address, so that it can be passed on. */
export interface Look {
  time: number;
  screen: Screen;
  robot: number;
  from: "angle" | "top";
  follow: boolean;
}

/** Holds what is looked at, and tells everybody who listens when that changes. */
export class State {
  look: Look = { time: 0, screen: "run", robot: -1, from: "angle", follow: false };
  playing = false;
  speed = 1;
  private readonly listeners: (() => void)[] = [];

  constructor(readonly recording: Recording) {
    this.look.time = recording.begin;
  }

  onChange(listener: () => void): void {
    this.listeners.push(listener);
  }

  change(change: Partial<Look>): void {
    const { begin, end } = this.recording;
    this.look = { ...this.look, ...change };
    this.look.time = Math.min(end, Math.max(begin, this.look.time));
    for (const listener of this.listeners) listener();
  }

  play(on: boolean): void {
    this.playing = on;
    if (on && this.look.time >= this.recording.end) this.change({ time: this.recording.begin });
    else this.change({});
  }

  /** Moves by one round of a program; by a second where there are none. */
  step(direction: 1 | -1): void {
    const times = this.recording.rounds.map((round) => round.time);
    this.change({ time: next(times, this.look.time, direction) ?? this.look.time + direction });
  }

  /** Moves to the next thing that happened, or that should not have. */
  jump(direction: 1 | -1, wanted: (happening: Happening) => boolean): void {
    const times = this.recording.happenings.filter(wanted).map((happening) => happening.time);
    const time = next(times, this.look.time, direction);
    if (time !== null) this.change({ time });
  }

  /** Returns the round under way; -1 before the first one, or where there are none. */
  round(): number {
    return last(this.recording.rounds.map((round) => round.time), this.look.time);
  }

  toHash(): string {
    const { time, screen, robot, from, follow } = this.look;
    const parts = [`t=${time.toFixed(3)}`, `screen=${screen}`];
    const name = this.recording.robots[robot]?.name;
    if (name !== undefined) parts.push(`robot=${encodeURIComponent(name)}`);
    if (from === "top") parts.push("from=top");
    if (follow) parts.push("follow=1");
    return `#${parts.join("&")}`;
  }

  fromHash(hash: string): void {
    const said = new URLSearchParams(hash.replace(/^#/, ""));
    const time = Number(said.get("t"));
    const screen = SCREENS.find((name) => name === said.get("screen"));
    this.change({
      ...(said.has("t") && Number.isFinite(time) ? { time } : {}),
      ...(screen === undefined ? {} : { screen }),
      robot: this.recording.robots.findIndex((robot) => robot.name === said.get("robot")),
      from: said.get("from") === "top" ? "top" : "angle",
      follow: said.get("follow") === "1",
    });
  }
}

function next(times: number[], time: number, direction: 1 | -1): number | null {
  const moment = 1e-6;
  const ahead = times.filter((t) => (direction > 0 ? t > time + moment : t < time - moment));
  if (ahead.length === 0) return null;
  return direction > 0 ? Math.min(...ahead) : Math.max(...ahead);
}
