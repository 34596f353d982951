import { forEachMessage } from "./mcap.ts";
import { type Grid, type Marker, type Pose, readGrid, readJoints, readMarkers, readPath, readPose } from "./messages.ts";

/** Values that change over time, in order of time: `width` numbers for each moment. */
export interface Track {
  times: number[];
  values: number[];
  width: number;
}

export interface Robot {
  name: string;
  /** Metres; 0 where bodies are shown. */
  radius: number;
  /** Position and quaternion: seven numbers each. */
  pose: Track;
  /** By name: states in SI units. */
  states: Map<string, Track>;
  /** Where it was told to go: raw messages. */
  paths: { time: number; bytes: Uint8Array }[];
}

/** Something that happened at a moment. `bad`: that should not have. */
export interface Happening {
  time: number;
  kind: string;
  robots: number[];
  text: string;
  bad: boolean;
}

/** Something that a robot did for a while. */
export interface Span {
  robot: number;
  text: string;
  from: number;
  to: number;
}

export interface Arrow {
  time: number;
  from: number;
  to: number;
  text: string;
}

/** A run, as a trace tells it. Times in seconds. */
export interface Recording {
  title: string;
  run: Record<string, unknown>;
  robots: Robot[];
  world: Marker[];
  /** By time: the bodies then, raw. */
  bodies: { time: number; bytes: Uint8Array }[];
  map: { time: number; bytes: Uint8Array }[];
  rounds: { time: number; round: number; events: string[] }[];
  /** What all variables were, as often as the trace says it. */
  states: { time: number; label: string; state: Json }[];
  happenings: Happening[];
  spans: Span[];
  arrows: Arrow[];
  begin: number;
  end: number;
  /** What is wrong with the file, and what was left out of it. */
  problems: string[];
}

export type Json = Record<string, unknown>;

function object(value: unknown): Json {
  return typeof value === "object" && value !== null && !Array.isArray(value) ? (value as Json) : {};
}
export function string(value: unknown): string {
  return typeof value === "string" ? value : value === undefined || value === null ? "" : JSON.stringify(value);
}
function number(value: unknown): number {
  return typeof value === "number" && Number.isFinite(value) ? value : 0;
}

class Reader {
  readonly recording: Recording = {
    title: "", run: {}, robots: [], world: [], bodies: [], map: [], rounds: [], states: [], happenings: [], spans: [], arrows: [],
    begin: 0, end: 0, problems: [],
  };
  private readonly open = new Map<number, Span>();
  private damaged = 0;
  private origin: number | null = null;
  private lines = 0;

  read(name: string, file: Uint8Array): Recording {
    const r = this.recording;
    r.title = name;
    const wrong = forEachMessage(file, (message) => {
      try {
        // Logs of robots count from 1970: then the first message is the beginning.
        this.origin ??= message.time > 1e8 ? message.time : 0;
        const time = Math.max(0, message.time - this.origin);
        r.end = Math.max(r.end, time);
        this.message(message.topic, time, message.bytes, message.encoding);
      } catch (error) {
        if (!(error instanceof RangeError || error instanceof SyntaxError)) throw error;
        ++this.damaged;
      }
    });
    if (wrong !== null) r.problems.push(wrong);
    if (this.damaged > 0) r.problems.push(`${this.damaged} messages could not be read`);
    for (const span of this.open.values()) r.spans.push({ ...span, to: r.end });
    r.spans.sort((a, b) => a.from - b.from);
    this.finish();
    const name_ = string(r.run["program_name"]);
    if (name_ !== "") r.title = `${name_}, ${r.run["seed"] === undefined ? "no seed" : `seed ${string(r.run["seed"])}`}`;
    return r;
  }

  private robot(name: string): number {
    const robots = this.recording.robots;
    let index = robots.findIndex((robot) => robot.name === name);
    if (index < 0) {
      index = robots.length;
      robots.push({ name, radius: 0, pose: { times: [], values: [], width: 7 }, states: new Map(), paths: [] });
    }
    return index;
  }

  private message(topic: string, time: number, bytes: Uint8Array, encoding: string): void {
    const r = this.recording;
    if (encoding === "json") {
      const json = object(JSON.parse(new TextDecoder().decode(bytes)));
      if (topic === "/rondo/run") this.run(json);
      if (topic === "/rondo/round") this.round(time, json);
      if (topic === "/rondo/event") this.event(time, json);
      if (topic === "/rondo/step") this.step(time, json);
      if (topic === "/rondo/log") this.line(time, json);
      return;
    }
    if (topic === "/world") r.world = readMarkers(bytes);
    if (topic === "/bodies") r.bodies.push({ time, bytes });
    if (topic === "/map") r.map.push({ time, bytes });
    const [, name, what] = /^\/([^/]+)\/(pose|path|joint_states)$/.exec(topic) ?? [];
    if (name === undefined) return;
    const robot = r.robots[this.robot(name)]!;
    if (what === "pose") {
      const { position, rotation } = readPose(bytes);
      push(robot.pose, time, [...position, ...rotation]);
    } else if (what === "path") {
      robot.paths.push({ time, bytes });
    } else {
      const { names, positions } = readJoints(bytes);
      names.forEach((state, i) => {
        if (!robot.states.has(state)) robot.states.set(state, { times: [], values: [], width: 1 });
        push(robot.states.get(state)!, time, [positions[i] ?? 0]);
      });
    }
  }

  private run(json: Json): void {
    this.recording.run = json;
    for (const robot of Array.isArray(json["robots"]) ? json["robots"] : []) {
      const index = this.robot(string(object(robot)["name"]));
      this.recording.robots[index]!.radius = number(object(robot)["radius"]);
    }
  }

  private round(time: number, json: Json): void {
    const events = Array.isArray(json["events"]) ? json["events"].map(string) : [];
    this.recording.rounds.push({ time, round: number(json["round"]), events });
  }

  // A step of a run that was explored.
  private step(time: number, json: Json): void {
    const round = this.recording.rounds.length;
    const events = Array.isArray(json["events"]) ? json["events"].map(string) : [];
    this.recording.rounds.push({ time, round, events });
    this.recording.states.push({ time, label: round === 0 ? "start" : `round ${round}`, state: object(json["state"]) });
  }

  // A line of the log of a robot, or of the logs of all.
  private line(time: number, json: Json): void {
    const did = string(json["did"]);
    const robot = this.index(json["robot"]);
    ++this.lines;
    // Robots of choreographies say what simulations do: a message is told by whom it is for.
    if (did === "begins" || did === "ends") return this.event(time, { kind: did, robot: json["robot"], motion: json["what"] });
    if (did === "took") return this.event(time, { kind: "message", from: json["peer"], to: json["robot"], label: json["what"], values: json["values"] });
    const place = json["round"] === undefined ? "" : `epoch ${string(json["epoch"])}, round ${string(json["round"])}`;
    const gaveUp = did === "leaves" && ["failed", "lost"].includes(string(json["outcome"]));
    const words = [place, string(json["outcome"]), string(json["what"]), string(json["peer"]) && `with ${string(json["peer"])}`, string(json["said"])];
    const findings = Array.isArray(this.recording.run["findings"]) ? this.recording.run["findings"].map(object) : [];
    for (const finding of findings.filter((f) => f["line"] === this.lines - 1))
      this.recording.happenings.push({ time, kind: string(finding["wrong"]), robots: [robot], text: string(finding["text"]), bad: true });
    this.recording.happenings.push({ time, kind: did, robots: [robot], text: words.filter((w) => w !== "").join(", "), bad: did === "breaks" || gaveUp });
    if (place !== "") this.recording.spans.push({ robot, text: `${did} ${place}`, from: time, to: time });
    if (typeof json["state"] === "object") this.recording.states.push({ time, label: `${this.recording.robots[robot]?.name ?? ""}: ${place}`, state: object(json["state"]) });
  }

  // What a run breaks, it breaks at its end.
  private finish(): void {
    const r = this.recording;
    const breaks = string(r.run["breaks"]);
    if (breaks !== "") r.happenings.push({ time: r.end, kind: "breaks", robots: [], text: breaks, bad: true });
    const wrong = string(r.run["wrong"]);
    if (wrong !== "" && !r.happenings.some((h) => h.bad)) r.happenings.push({ time: r.end, kind: "wrong", robots: [], text: wrong, bad: true });
  }

  private event(time: number, json: Json): void {
    const r = this.recording;
    const happen = (kind: string, robots: unknown[], text: string, bad: boolean) =>
      r.happenings.push({ time, kind, robots: robots.filter((n) => n !== undefined).map((n) => this.index(n)), text, bad });
    switch (json["kind"]) {
      case "message": {
        const [from, to] = [this.robot(string(json["from"])), this.robot(string(json["to"]))];
        const values = Array.isArray(json["values"]) ? json["values"].map((v) => String(Number(number(v).toPrecision(4)))) : [];
        const text = values.length === 0 ? string(json["label"]) : `${string(json["label"])}(${values.join(", ")})`;
        r.arrows.push({ time, from, to, text });
        happen("message", [json["from"], json["to"]], text, false);
        return;
      }
      case "begins": {
        const robot = this.robot(string(json["robot"]));
        this.open.set(robot, { robot, text: string(json["motion"]), from: time, to: time });
        happen("motion", [json["robot"]], string(json["motion"]), false);
        return;
      }
      case "ends": {
        const robot = this.robot(string(json["robot"]));
        const span = this.open.get(robot);
        this.open.delete(robot);
        if (span !== undefined) r.spans.push({ ...span, to: time });
        return;
      }
      case "incident":
        happen(string(json["wrong"]), [], string(json["what"]), true);
        return;
      case "end":
        happen("end", [], `the run ended: ${string(json["why"])}`, false);
        return;
    }
    const robot = json["robot"];
    switch (json["event"]) {
      case "collision":
        happen("collision", [robot], `${string(robot)} touches ${string(json["with"])}`, true);
        return;
      case "violation":
        happen("violation", robot === "" ? [] : [robot], string(json["what"]), true);
        return;
      case "fault":
        happen("fault", [robot], string(json["what"]), true);
        return;
      case "log":
        happen("output", [robot], string(json["text"]), false);
        return;
      case "end":
        happen("end", [], `the run ended: ${string(json["why"])}`, false);
        return;
      default:
        happen(string(json["event"] ?? json["kind"]), robot === undefined ? [] : [robot], string(json["what"]), false);
    }
  }

  // Robots are named, or numbered from 0.
  private index(robot: unknown): number {
    return typeof robot === "number" && Number.isInteger(robot) && robot >= 0 && robot < this.recording.robots.length ? robot : this.robot(string(robot));
  }
}

function push(track: Track, time: number, values: number[]): void {
  track.times.push(time);
  track.values.push(...values);
}

/** Reads a trace (MCAP). Never throws for what is in the file: `problems` say what could not be read. */
export function readRecording(name: string, file: Uint8Array): Recording {
  return new Reader().read(name, file);
}

/** Returns the index of the last of these times that is not after `time`; -1: there is none. */
export function last(times: ArrayLike<number>, time: number): number {
  let [low, high] = [0, times.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle]! <= time) low = middle + 1;
    else high = middle;
  }
  return low - 1;
}

/** Returns where a robot is at a moment, between the two poses around it; null before the first one. */
export function poseAt(robot: Robot, time: number): Pose | null {
  const { times, values } = robot.pose;
  const i = last(times, time);
  if (i < 0) return null;
  const at = (k: number) => values.slice(7 * k, 7 * k + 7);
  const a = at(i);
  const b = i + 1 < times.length ? at(i + 1) : a;
  const gap = i + 1 < times.length ? times[i + 1]! - times[i]! : 0;
  const share = gap > 0 ? (time - times[i]!) / gap : 0;
  // The shorter way around.
  const sign = a[3]! * b[3]! + a[4]! * b[4]! + a[5]! * b[5]! + a[6]! * b[6]! < 0 ? -1 : 1;
  const mixed = a.map((v, k) => v + share * ((k < 3 ? b[k]! : sign * b[k]!) - v));
  const length = Math.hypot(mixed[3]!, mixed[4]!, mixed[5]!, mixed[6]!) || 1;
  return {
    position: [mixed[0]!, mixed[1]!, mixed[2]!],
    rotation: [mixed[3]! / length, mixed[4]! / length, mixed[5]! / length, mixed[6]! / length],
  };
}

/** Returns the value of a state at a moment: the last that was told; null before the first one. */
export function valueAt(track: Track, time: number): number | null {
  const i = last(track.times, time);
  return i < 0 ? null : track.values[i]!;
}

/** Returns the bodies at a moment: those that were told last. Empty if there are none, or their message is damaged. */
export function bodiesAt(recording: Recording, time: number): Marker[] {
  return lastRead(recording.bodies, time, readMarkers) ?? [];
}

export function mapAt(recording: Recording, time: number): Grid | null {
  return lastRead(recording.map, time, readGrid);
}

export function pathAt(robot: Robot, time: number): Float32Array | null {
  return lastRead(robot.paths, time, readPath);
}

function lastRead<T>(list: { time: number; bytes: Uint8Array }[], time: number, read: (bytes: Uint8Array) => T): T | null {
  let [low, high] = [0, list.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (list[middle]!.time <= time) low = middle + 1;
    else high = middle;
  }
  if (low === 0) return null;
  try {
    return read(list[low - 1]!.bytes);
  } catch (error) {
    if (error instanceof RangeError) return null;
    throw error;
  }
}
