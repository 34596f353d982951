import * as THREE from "three";
import { poseAt, type Robot } from "../data/recording.ts";
import { colourOf } from "../colours.ts";

const HEIGHT = 0.4; // times the radius

/** Shows robots of which a trace knows the radius alone: a disc each, with a nose where it heads. Two draw calls for all. */
export class Discs {
  readonly group = new THREE.Group();
  private readonly discs: THREE.InstancedMesh;
  private readonly noses: THREE.InstancedMesh;
  private readonly matrix = new THREE.Matrix4();

  constructor(private readonly robots: Robot[]) {
    const disc = new THREE.CylinderGeometry(1, 1, HEIGHT, 24).rotateX(Math.PI / 2).translate(0, 0, HEIGHT / 2);
    const nose = new THREE.ConeGeometry(0.35, 0.9, 12).rotateZ(-Math.PI / 2).translate(0.55, 0, HEIGHT + 0.1);
    const material = () => new THREE.MeshStandardMaterial({ roughness: 0.6 });
    this.discs = new THREE.InstancedMesh(disc, material(), robots.length);
    this.noses = new THREE.InstancedMesh(nose, material(), robots.length);
    robots.forEach((_, i) => {
      const colour = new THREE.Color(colourOf(i));
      this.discs.setColorAt(i, colour);
      this.noses.setColorAt(i, colour.clone().lerp(new THREE.Color("white"), 0.55));
    });
    for (const mesh of [this.discs, this.noses]) {
      mesh.frustumCulled = false;
      this.group.add(mesh);
    }
  }

  show(time: number): void {
    this.robots.forEach((robot, i) => {
      const pose = poseAt(robot, time);
      const size = pose === null ? 0 : Math.max(robot.radius, 1e-3);
      this.matrix.compose(
        new THREE.Vector3(...(pose?.position ?? [0, 0, 0])),
        new THREE.Quaternion(...(pose?.rotation ?? [0, 0, 0, 1])),
        new THREE.Vector3(size, size, size),
      );
      this.discs.setMatrixAt(i, this.matrix);
      this.noses.setMatrixAt(i, this.matrix);
    });
    this.discs.instanceMatrix.needsUpdate = this.noses.instanceMatrix.needsUpdate = true;
  }
}
