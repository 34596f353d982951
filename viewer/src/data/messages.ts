import { Cdr } from "./cdr.ts";

/** Metres, and a unit quaternion x, y, z, w. */
export interface Pose {
  position: [number, number, number];
  rotation: [number, number, number, number];
}

/** What a marker is (visualization_msgs/Marker). */
export const CUBE = 1, SPHERE = 2, CYLINDER = 3, TRIANGLES = 11;

/** A solid: extents along its own axes in metres, colour from 0 to 1, corners of triangles in metres. */
export interface Marker {
  group: string;
  id: number;
  kind: number;
  pose: Pose;
  size: [number, number, number];
  colour: [number, number, number, number];
  corners: Float32Array;
}

export interface Grid {
  resolution: number;
  width: number;
  height: number;
  origin: [number, number];
  cells: Int8Array;
}

function header(cdr: Cdr): void {
  cdr.i32();
  cdr.u32();
  cdr.text();
}

// Where nothing can be is no place: the message counts as damaged.
const FAR = 1e9;

function pose(cdr: Cdr): Pose {
  const made: Pose = {
    position: [cdr.f64(), cdr.f64(), cdr.f64()],
    rotation: [cdr.f64(), cdr.f64(), cdr.f64(), cdr.f64()],
  };
  if (![...made.position, ...made.rotation].every((v) => Math.abs(v) < FAR)) throw new RangeError("no place");
  return made;
}

/** geometry_msgs/PoseStamped */
export function readPose(bytes: Uint8Array): Pose {
  const cdr = new Cdr(bytes);
  header(cdr);
  return pose(cdr);
}

/** nav_msgs/Path: its points, three numbers each. */
export function readPath(bytes: Uint8Array): Float32Array {
  const cdr = new Cdr(bytes);
  header(cdr);
  const points = new Float32Array(3 * cdr.count(60));
  for (let i = 0; i < points.length; i += 3) {
    header(cdr);
    points.set(pose(cdr).position, i);
  }
  return points;
}

/** sensor_msgs/JointState */
export function readJoints(bytes: Uint8Array): { names: string[]; positions: Float64Array } {
  const cdr = new Cdr(bytes);
  header(cdr);
  const names = Array.from({ length: cdr.count(4) }, () => cdr.text());
  return { names, positions: cdr.f64s() };
}

/** nav_msgs/OccupancyGrid */
export function readGrid(bytes: Uint8Array): Grid {
  const cdr = new Cdr(bytes);
  header(cdr);
  cdr.i32();
  cdr.u32();
  const [resolution, width, height] = [cdr.f32(), cdr.u32(), cdr.u32()];
  const origin = pose(cdr).position;
  const cells = cdr.i8s();
  if (cells.length !== width * height) throw new RangeError("the map has another size than it says");
  return { resolution, width, height, origin: [origin[0], origin[1]], cells };
}

/** visualization_msgs/MarkerArray */
export function readMarkers(bytes: Uint8Array): Marker[] {
  const cdr = new Cdr(bytes);
  return Array.from({ length: cdr.count(100) }, () => {
    header(cdr);
    const marker: Marker = {
      group: cdr.text(),
      id: cdr.i32(),
      kind: cdr.i32(),
      pose: (cdr.i32(), pose(cdr)),
      size: [cdr.f64(), cdr.f64(), cdr.f64()],
      colour: [cdr.f32(), cdr.f32(), cdr.f32(), cdr.f32()],
      corners: (cdr.i32(), cdr.u32(), cdr.u8(), new Float32Array(3 * cdr.count(24))),
    };
    for (let i = 0; i < marker.corners.length; ++i) marker.corners[i] = cdr.f64();
    for (let n = cdr.count(16); n > 0; --n) cdr.f32(), cdr.f32(), cdr.f32(), cdr.f32();
    cdr.text();
    // A picture, and where it lies: Rondo writes none.
    header(cdr);
    cdr.text();
    cdr.i8s();
    for (let n = cdr.count(8); n > 0; --n) cdr.f32(), cdr.f32();
    cdr.text();
    cdr.text();
    cdr.text();
    cdr.i8s();
    cdr.u8();
    return marker;
  });
}
