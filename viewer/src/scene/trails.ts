import * as THREE from "three";
import { colourOf } from "../colours.ts";
import { last, pathAt, type Robot } from "../data/recording.ts";

const MOST = 300_000; // segments of all trails
const LIFT = 2e-3; // metres above the ground

function lines(positions: Float32Array, colours: Float32Array): THREE.LineSegments {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
  geometry.setAttribute("color", new THREE.BufferAttribute(colours, 3));
  const made = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ vertexColors: true, transparent: true, opacity: 0.8 }));
  made.frustumCulled = false;
  return made;
}

/** Shows where all robots were until now: one draw call, and nothing to be made anew from moment to moment. */
export class Trails {
  readonly lines: THREE.LineSegments;
  private readonly times: Float64Array;

  constructor(robots: Robot[]) {
    const all = robots.reduce((sum, robot) => sum + robot.pose.times.length, 0);
    const stride = Math.max(1, Math.ceil(all / MOST));
    const segments: { time: number; robot: number; from: number; to: number }[] = [];
    robots.forEach((robot, r) => {
      for (let k = stride; k < robot.pose.times.length; k += stride) segments.push({ time: robot.pose.times[k]!, robot: r, from: k - stride, to: k });
    });
    segments.sort((a, b) => a.time - b.time);
    this.times = Float64Array.from(segments, (segment) => segment.time);
    const positions = new Float32Array(6 * segments.length), colours = new Float32Array(6 * segments.length);
    const colour = new THREE.Color();
    segments.forEach(({ robot, from, to }, i) => {
      const { values } = robots[robot]!.pose;
      [from, to].forEach((k, end) => {
        for (let c = 0; c < 3; ++c) positions[6 * i + 3 * end + c] = values[7 * k + c]! + (c === 2 ? LIFT : 0);
        colour.set(colourOf(robot)).toArray(colours, 6 * i + 3 * end);
      });
    });
    this.lines = lines(positions, colours);
  }

  show(time: number): void {
    this.lines.geometry.setDrawRange(0, 2 * (last(this.times, time) + 1));
  }
}

/** Shows where robots are told to go, as they were told last. */
export class Paths {
  readonly lines: THREE.LineSegments;
  private shown = "";

  constructor(private readonly robots: Robot[]) {
    const most = 2 * robots.reduce((sum, robot) => sum + Math.max(0, ...robot.paths.map((path) => path.bytes.length / 60)), 0) + 2;
    this.lines = lines(new Float32Array(3 * Math.ceil(most)), new Float32Array(3 * Math.ceil(most)));
  }

  show(time: number): void {
    const now = this.robots.map((robot) => last(robot.paths.map((path) => path.time), time)).join();
    if (now === this.shown) return;
    this.shown = now;
    const position = this.lines.geometry.getAttribute("position") as THREE.BufferAttribute;
    const colours = this.lines.geometry.getAttribute("color") as THREE.BufferAttribute;
    const colour = new THREE.Color();
    let at = 0;
    this.robots.forEach((robot, r) => {
      const points = pathAt(robot, time) ?? new Float32Array();
      colour.set(colourOf(r)).lerp(new THREE.Color("#8a8f98"), 0.4);
      for (let k = 3; k + 2 < points.length && at + 1 < position.count; k += 3) {
        for (const begin of [k - 3, k]) {
          position.setXYZ(at, points[begin]!, points[begin + 1]!, points[begin + 2]! + LIFT);
          colours.setXYZ(at++, colour.r, colour.g, colour.b);
        }
      }
    });
    position.needsUpdate = colours.needsUpdate = true;
    this.lines.geometry.setDrawRange(0, at);
  }
}
