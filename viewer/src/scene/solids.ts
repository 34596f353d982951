import * as THREE from "three";
import { CUBE, CYLINDER, type Marker, SPHERE, TRIANGLES } from "../data/messages.ts";

const unit = {
  cube: new THREE.BoxGeometry(1, 1, 1),
  sphere: new THREE.SphereGeometry(0.5, 24, 16),
  // Along z, as markers have it.
  cylinder: new THREE.CylinderGeometry(0.5, 0.5, 1, 32).rotateX(Math.PI / 2),
};

function geometryOf(marker: Marker): THREE.BufferGeometry | null {
  if (marker.kind === CUBE) return unit.cube;
  if (marker.kind === SPHERE) return unit.sphere;
  if (marker.kind === CYLINDER) return unit.cylinder;
  if (marker.kind !== TRIANGLES) return null;
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(marker.corners, 3));
  geometry.computeVertexNormals();
  return geometry;
}

function place(mesh: THREE.Object3D, marker: Marker): void {
  mesh.position.set(...marker.pose.position);
  mesh.quaternion.set(...marker.pose.rotation);
  mesh.scale.set(...marker.size);
}

/** Shows a list of solids, which may change from moment to moment: a solid keeps its mesh for as long as its shape stays. */
export class Solids {
  readonly group = new THREE.Group();
  private readonly meshes = new Map<string, { mesh: THREE.Mesh; kind: number; corners: number }>();

  show(markers: Marker[]): void {
    const seen = new Set<string>();
    for (const marker of markers) {
      const key = `${marker.id} ${marker.group}`;
      seen.add(key);
      let known = this.meshes.get(key);
      if (known === undefined || known.kind !== marker.kind || known.corners !== marker.corners.length) {
        if (known !== undefined) this.group.remove(known.mesh);
        const geometry = geometryOf(marker);
        if (geometry === null) continue;
        const [r, g, b, a] = marker.colour;
        const material = new THREE.MeshStandardMaterial({
          color: new THREE.Color(r, g, b), roughness: 0.7, opacity: a, transparent: a < 1, side: THREE.DoubleSide, flatShading: marker.kind === TRIANGLES,
        });
        known = { mesh: new THREE.Mesh(geometry, material), kind: marker.kind, corners: marker.corners.length };
        known.mesh.name = marker.group;
        this.meshes.set(key, known);
        this.group.add(known.mesh);
      } else if (marker.kind === TRIANGLES) {
        const position = known.mesh.geometry.getAttribute("position") as THREE.BufferAttribute;
        position.copyArray(marker.corners);
        position.needsUpdate = true;
      }
      place(known.mesh, marker);
    }
    for (const [key, known] of this.meshes) known.mesh.visible = seen.has(key);
  }
}
