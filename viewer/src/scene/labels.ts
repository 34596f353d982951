import * as THREE from "three";
import { el } from "../dom.ts";

export interface Label {
  text: string;
  position: [number, number, number];
  colour: string;
  chosen: boolean;
}

const LINE = 16; // pixels

/** Writes names beside what they belong to, in the plane of the screen; those that would cover each other move up. */
export class Labels {
  readonly element = el("div", { class: "labels", "aria-hidden": "true" });

  show(labels: Label[], camera: THREE.Camera, width: number, height: number): void {
    const at = new THREE.Vector3();
    const placed: { x: number; y: number; w: number }[] = [];
    const children: HTMLElement[] = [];
    const points = labels.map((label) => {
      at.set(...label.position).project(camera);
      return { label, x: (at.x + 1) * width / 2, y: (1 - at.y) * height / 2, seen: Math.abs(at.x) <= 1 && Math.abs(at.y) <= 1 && at.z <= 1 };
    });
    points.sort((a, b) => b.y - a.y);
    for (const { label, x, y, seen } of points) {
      if (!seen) continue;
      const w = 7 * label.text.length + 8;
      const spot = { x: x + 8, y: y - LINE, w };
      // As often as there can be others above.
      for (let i = 0; i < placed.length; ++i) {
        const other = placed.find((p) => Math.abs(p.y - spot.y) < LINE && p.x < spot.x + w && spot.x < p.x + p.w);
        if (other === undefined) break;
        spot.y = other.y - LINE;
      }
      placed.push(spot);
      const span = el("span", { class: label.chosen ? "label chosen" : "label" }, label.text);
      span.style.transform = `translate(${spot.x.toFixed(1)}px, ${spot.y.toFixed(1)}px)`;
      span.style.borderColor = label.colour;
      children.push(span);
    }
    this.element.replaceChildren(...children);
  }
}
