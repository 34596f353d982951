import * as THREE from "three";
import type { Grid } from "../data/messages.ts";

/** Returns a grid of metres around these bounds, with the axes from the origin: x (east) red, y (north) green, z up blue. */
export function groundOf(bounds: THREE.Box3, ink: THREE.ColorRepresentation): THREE.Group {
  const group = new THREE.Group();
  const size = bounds.getSize(new THREE.Vector3());
  const middle = bounds.getCenter(new THREE.Vector3());
  const extent = Math.max(size.x, size.y, 2);
  const cell = extent > 60 ? 10 : 1;
  const cells = Math.min(200, 2 * Math.ceil(extent / 2 / cell) + 4);
  const grid = new THREE.GridHelper(cells * cell, cells, ink, ink).rotateX(Math.PI / 2);
  grid.position.set(Math.round(middle.x / cell) * cell, Math.round(middle.y / cell) * cell, bounds.min.z - 2e-3);
  grid.material.opacity = 0.35;
  grid.material.transparent = true;
  const axes = new THREE.AxesHelper(Math.min(1, extent / 4));
  group.add(grid, axes);
  return group;
}

/** Returns a map of occupied cells as a picture on the ground: unknown cells are not drawn. */
export function mapOf(grid: Grid): THREE.Mesh {
  const pixels = new Uint8Array(4 * grid.width * grid.height);
  grid.cells.forEach((cell, i) => {
    const shade = cell < 0 ? 128 : 240 - 2.2 * cell;
    pixels.set([shade, shade, shade, cell < 0 ? 0 : 220], 4 * i);
  });
  const texture = new THREE.DataTexture(pixels, grid.width, grid.height);
  texture.magFilter = THREE.NearestFilter;
  texture.needsUpdate = true;
  const [w, h] = [grid.width * grid.resolution, grid.height * grid.resolution];
  const mesh = new THREE.Mesh(new THREE.PlaneGeometry(w, h), new THREE.MeshBasicMaterial({ map: texture, transparent: true }));
  mesh.position.set(grid.origin[0] + w / 2, grid.origin[1] + h / 2, -1e-3);
  return mesh;
}
