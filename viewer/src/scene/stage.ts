import * as THREE from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { colourOf } from "../colours.ts";
import { bodiesAt, last, mapAt, poseAt } from "../data/recording.ts";
import { el } from "../dom.ts";
import type { State } from "../state.ts";
import { Discs } from "./discs.ts";
import { groundOf, mapOf } from "./ground.ts";
import { type Label, Labels } from "./labels.ts";
import { Solids } from "./solids.ts";
import { Paths, Trails } from "./trails.ts";

/** The space of a run: bodies, the world, where robots were and where they are told to go. Metres; z is up. */
export class Stage {
  readonly element = el("div", { class: "stage" });
  readonly measured = el("p", { class: "measured", role: "status" });
  private readonly renderer: THREE.WebGLRenderer;
  private readonly scene = new THREE.Scene();
  private readonly angle = new THREE.PerspectiveCamera(45, 1, 0.01, 5000);
  private readonly top = new THREE.OrthographicCamera(-1, 1, 1, -1, -1000, 1000);
  private readonly controls: { angle: OrbitControls; top: OrbitControls };
  private readonly bodies = new Solids();
  private readonly discs: Discs | null;
  private readonly trails: Trails;
  private readonly paths: Paths;
  private readonly labels = new Labels();
  private readonly bounds = new THREE.Box3();
  private ground: THREE.Group;
  private map: THREE.Mesh | null = null;
  private mapped = -1;
  private marks: THREE.Vector3[] = [];
  private readonly ruler = line("#ff3b9d", 2);
  private asked = false;

  constructor(private readonly state: State) {
    const { recording } = state;
    this.renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true, preserveDrawingBuffer: true });
    this.renderer.setPixelRatio(window.devicePixelRatio);
    this.renderer.domElement.setAttribute("aria-label", "the space of the run; the panel beside it says the same in words");
    this.renderer.domElement.setAttribute("role", "img");
    this.element.append(this.renderer.domElement, this.labels.element, this.measured);
    this.scene.add(new THREE.HemisphereLight("#ffffff", "#8a8f98", 2.2));
    const sun = new THREE.DirectionalLight("#ffffff", 2);
    sun.position.set(4, -6, 10);
    this.scene.add(sun);
    const world = new Solids();
    world.show(recording.world);
    this.scene.add(world.group, this.bodies.group, this.ruler);
    const known = recording.bodies.length > 0;
    this.discs = known ? null : new Discs(recording.robots);
    if (this.discs !== null) this.scene.add(this.discs.group);
    this.trails = new Trails(recording.robots);
    this.paths = new Paths(recording.robots);
    this.scene.add(this.trails.lines, this.paths.lines);
    this.measure();
    this.ground = groundOf(this.bounds, "#8a8f98");
    this.scene.add(this.ground);
    this.angle.up.set(0, 0, 1);
    this.top.up.set(0, 1, 0);
    this.controls = { angle: this.orbit(this.angle), top: this.orbit(this.top) };
    this.controls.top.enableRotate = false;
    this.home();
    new ResizeObserver(() => this.resize()).observe(this.element);
    this.renderer.domElement.addEventListener("dblclick", (event) => this.mark(event));
    state.onChange(() => this.ask());
  }

  private orbit(camera: THREE.Camera): OrbitControls {
    const controls = new OrbitControls(camera, this.renderer.domElement);
    controls.addEventListener("change", () => this.ask());
    return controls;
  }

  /** Everything that there ever is. */
  private measure(): void {
    const at = new THREE.Vector3();
    for (const robot of this.state.recording.robots) {
      const { values } = robot.pose;
      for (let i = 0; i < values.length; i += 7) this.bounds.expandByPoint(at.set(values[i]!, values[i + 1]!, values[i + 2]!));
    }
    for (const marker of this.state.recording.world) this.bounds.expandByPoint(at.set(...marker.pose.position));
    if (this.bounds.isEmpty()) this.bounds.set(new THREE.Vector3(-1, -1, 0), new THREE.Vector3(1, 1, 0));
    this.bounds.min.z = Math.min(0, this.bounds.min.z);
    this.bounds.expandByScalar(0.3);
    this.bounds.min.z += 0.3;
  }

  /** Looks at everything again. */
  home(): void {
    const middle = this.bounds.getCenter(new THREE.Vector3());
    const radius = Math.max(0.5, this.bounds.getBoundingSphere(new THREE.Sphere()).radius);
    this.angle.position.set(middle.x - 0.5 * radius, middle.y - 1.6 * radius, middle.z + 1.3 * radius);
    this.top.position.set(middle.x, middle.y, middle.z + radius);
    for (const controls of [this.controls.angle, this.controls.top]) {
      controls.target.copy(middle);
      controls.update();
    }
    this.top.zoom = 1;
    this.resize();
  }

  private camera(): THREE.PerspectiveCamera | THREE.OrthographicCamera {
    return this.state.look.from === "top" ? this.top : this.angle;
  }

  private resize(): void {
    const { clientWidth: w, clientHeight: h } = this.element;
    if (w === 0 || h === 0) return;
    this.renderer.setSize(w, h);
    this.angle.aspect = w / h;
    this.angle.updateProjectionMatrix();
    const size = this.bounds.getSize(new THREE.Vector3());
    const half = 0.55 * Math.max(size.y, size.x * h / w, 1);
    [this.top.left, this.top.right, this.top.bottom, this.top.top] = [-half * w / h, half * w / h, -half, half];
    this.top.updateProjectionMatrix();
    this.ask();
  }

  private ask(): void {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => {
      this.asked = false;
      if (this.state.look.screen === "run") this.draw();
    });
  }

  /** Draws what there is at the moment that is looked at. */
  draw(): void {
    const { recording, look } = this.state;
    const top = look.from === "top";
    this.controls.angle.enabled = !top;
    this.controls.top.enabled = top;
    const chosen = recording.robots[look.robot];
    const pose = chosen === undefined ? null : poseAt(chosen, look.time);
    if (look.follow && pose !== null) {
      const controls = top ? this.controls.top : this.controls.angle;
      const moved = new THREE.Vector3(...pose.position).sub(controls.target);
      controls.target.add(moved);
      controls.object.position.add(moved);
    }
    this.bodies.show(bodiesAt(recording, look.time));
    this.discs?.show(look.time);
    this.showMap();
    this.trails.show(look.time);
    this.paths.show(look.time);
    set(this.ruler, this.marks.flatMap((p) => p.toArray()));
    const camera = this.camera();
    this.renderer.render(this.scene, camera);
    const few = recording.robots.length <= 40;
    const labels = recording.robots.flatMap((robot, i): Label[] => {
      const at = few || i === look.robot ? poseAt(robot, look.time) : null;
      return at === null ? [] : [{ text: robot.name, position: at.position, colour: colourOf(i), chosen: i === look.robot }];
    });
    labels.push({ text: "x", position: [1, 0, 0], colour: "#d33", chosen: false }, { text: "y (north)", position: [0, 1, 0], colour: "#3a3", chosen: false });
    this.labels.show(labels, camera, this.element.clientWidth, this.element.clientHeight);
  }

  private showMap(): void {
    const { recording, look } = this.state;
    const index = last(recording.map.map((m) => m.time), look.time);
    if (index === this.mapped) return;
    this.mapped = index;
    if (this.map !== null) this.scene.remove(this.map);
    const grid = mapAt(recording, look.time);
    this.map = grid === null ? null : mapOf(grid);
    if (this.map !== null) this.scene.add(this.map);
  }

  /** Measures between two places on the ground that are clicked twice. */
  private mark(event: MouseEvent): void {
    const box = this.renderer.domElement.getBoundingClientRect();
    const at = new THREE.Vector2((event.clientX - box.left) / box.width * 2 - 1, 1 - (event.clientY - box.top) / box.height * 2);
    const ray = new THREE.Raycaster();
    ray.setFromCamera(at, this.camera());
    const hit = ray.ray.intersectPlane(new THREE.Plane(new THREE.Vector3(0, 0, 1), 0), new THREE.Vector3());
    if (hit === null) return;
    this.marks = this.marks.length === 2 ? [hit] : [...this.marks, hit];
    const [a, b] = this.marks;
    this.measured.textContent = a === undefined || b === undefined ? "double click where the distance ends"
      : `${a.distanceTo(b).toFixed(3)} m from (${a.x.toFixed(2)}, ${a.y.toFixed(2)}) to (${b.x.toFixed(2)}, ${b.y.toFixed(2)})`;
    this.ask();
  }

  /** Returns what is seen as a picture (PNG). */
  picture(): Promise<Blob | null> {
    this.draw();
    return new Promise((done) => this.renderer.domElement.toBlob(done, "image/png"));
  }

  /** How much was drawn for the last picture. */
  drawCalls(): number {
    return this.renderer.info.render.calls;
  }
}

function line(colour: string, points: number): THREE.Line {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(3 * (points + 2)), 3));
  const made = new THREE.Line(geometry, new THREE.LineBasicMaterial({ color: colour, transparent: true }));
  made.frustumCulled = false;
  return made;
}

function set(shown: THREE.Line, points: number[]): void {
  const position = shown.geometry.getAttribute("position") as THREE.BufferAttribute;
  const count = Math.min(points.length / 3, position.count);
  position.array.set(points.slice(0, 3 * count));
  position.needsUpdate = true;
  shown.geometry.setDrawRange(0, count);
  shown.visible = count > 1;
}
