// The canvas: renderer, camera and controls. A picture is drawn only after a change.
import * as THREE from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import type { Ray } from "./geometry.ts";
import type { Box, Triple } from "./scene.ts";
import { pixelRatio, viewport } from "./shaders.ts";

const slowPicture = 120; // milliseconds
const restAfter = 250;
const flightTime = 500;

const middle = (box: Box): Triple => box.lower.map((low, a) => (low + box.upper[a]) / 2) as Triple;
const radiusOf = (box: Box): number =>
  Math.max(Math.hypot(...box.lower.map((low, a) => box.upper[a] - low)) / 2, 1e-12);

export class Stage {
  readonly scene = new THREE.Scene();
  readonly camera = new THREE.PerspectiveCamera(35, 1, 0.01, 100);
  readonly canvas: HTMLCanvasElement;
  /** Returns the box around the shown items; undefined if none is shown. */
  shown: () => Box | undefined = () => undefined;
  /** Called before each picture. */
  onDraw: () => void = () => undefined;
  /** Called when the view begins to move and when it rests, if whole pictures take long. */
  onMoving: (isMoving: boolean) => void = () => undefined;
  readonly #renderer: THREE.WebGLRenderer;
  readonly #controls: OrbitControls;
  readonly #center: Triple;
  readonly #radius: number;
  readonly #everything: Box;
  #fitted: Triple | undefined; // direction of look(), until the user moves the view
  #flight = 0;
  #isAsked = false;
  #isSlow = false;
  #rest: ReturnType<typeof setTimeout> | undefined;

  /** Throws if the browser has no WebGL 2. */
  constructor(canvas: HTMLCanvasElement, bounds: Box) {
    this.canvas = canvas;
    this.#renderer = new THREE.WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
    this.#renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.#everything = bounds;
    this.#center = middle(bounds);
    this.#radius = radiusOf(bounds);
    this.#controls = new OrbitControls(this.camera, canvas);
    this.#controls.rotateSpeed = 0.8;
    this.#controls.zoomToCursor = true;
    this.#controls.addEventListener("change", () => this.moved());
    this.#controls.addEventListener("start", () => {
      this.#fitted = undefined;
      ++this.#flight;
    });
    this.#resize();
    this.look([0.55, -0.75, 0.42]);
    new ResizeObserver(() => this.#resize()).observe(canvas.parentElement as HTMLElement);
    canvas.addEventListener("webglcontextrestored", () => this.draw());
  }

  /** Origin of drawn coordinates. They are relative to it because of single precision. */
  get center(): Triple {
    return this.#center;
  }
  get radius(): number {
    return this.#radius;
  }

  setBackground(color: string): void {
    this.#renderer.setClearColor(new THREE.Color(color));
    this.draw();
  }

  /** Looks at all shown items from a direction. */
  look(from: Triple): void {
    ++this.#flight;
    const box = this.shown() ?? this.#everything;
    const radius = radiusOf(box);
    const target = middle(box).map((p, a) => p - this.#center[a]) as Triple;
    const direction = new THREE.Vector3(...from).normalize();
    const isVertical = Math.abs(direction.z) > 0.999;
    this.camera.up.set(0, isVertical ? 1 : 0, isVertical ? 0 : 1);
    const away = this.#distanceToSeeAll(direction, box);
    this.camera.position.copy(direction).multiplyScalar(away).add(new THREE.Vector3(...target));
    this.camera.near = radius / 500;
    this.camera.far = away + 40 * this.#radius;
    this.camera.updateProjectionMatrix();
    this.#controls.object.up.copy(this.camera.up);
    this.#controls.target.set(...target);
    this.#controls.minDistance = radius / 100;
    this.#controls.maxDistance = 30 * this.#radius;
    this.#controls.update();
    this.#fitted = from;
    this.draw();
  }

  /**
   * Moves to a place in drawn coordinates and looks at it from a direction. Does not animate if the user prefers
   * reduced motion.
   * @param size  radius of the item at the place.
   */
  fly(to: Triple, from: Triple, size: number): void {
    this.#fitted = undefined;
    const away = 1.6 * size;
    const target = new THREE.Vector3(...to);
    // Looks slightly from the side, because surfaces look flat from straight ahead.
    const direction = new THREE.Vector3(0.3, -0.42, 0.24).add(new THREE.Vector3(...from)).normalize();
    const position = target.clone().addScaledVector(direction, away);
    const start = { position: this.camera.position.clone(), target: this.#controls.target.clone() };
    const begin = performance.now();
    const length = matchMedia("(prefers-reduced-motion: reduce)").matches ? 0 : flightTime;
    const flight = ++this.#flight;
    const step = () => {
      if (flight !== this.#flight) return; // another flight, or the user moved the view
      const t = length === 0 ? 1 : Math.min((performance.now() - begin) / length, 1);
      const s = t * t * (3 - 2 * t);
      this.camera.position.lerpVectors(start.position, position, s);
      this.#controls.target.lerpVectors(start.target, target, s);
      this.#controls.update();
      this.moved();
      if (t < 1) requestAnimationFrame(step);
    };
    step();
  }

  /** Turns the view by angles, for arrow keys. */
  turn(around: number, over: number): void {
    this.#fitted = undefined;
    const offset = this.camera.position.clone().sub(this.#controls.target);
    const toUp = new THREE.Quaternion().setFromUnitVectors(this.camera.up, new THREE.Vector3(0, 1, 0));
    offset.applyQuaternion(toUp);
    const spherical = new THREE.Spherical().setFromVector3(offset);
    spherical.theta += around;
    spherical.phi += over;
    spherical.makeSafe();
    offset.setFromSpherical(spherical).applyQuaternion(toUp.invert());
    this.camera.position.copy(this.#controls.target).add(offset);
    this.#controls.update();
    this.moved();
  }

  zoom(factor: number): void {
    this.#fitted = undefined;
    const offset = this.camera.position.clone().sub(this.#controls.target).multiplyScalar(factor);
    const length = offset.length();
    if (length < this.#controls.minDistance || length > this.#controls.maxDistance) return;
    this.camera.position.copy(this.#controls.target).add(offset);
    this.#controls.update();
    this.moved();
  }

  /** False while something else is dragged, so that the view does not turn. */
  set isTurnedByDragging(value: boolean) {
    this.#controls.enabled = value;
  }

  /** Requests a picture. */
  draw(): void {
    if (this.#isAsked) return;
    this.#isAsked = true;
    requestAnimationFrame(() => this.drawNow());
  }

  /** Requests a picture during a movement. If whole pictures take long, less is drawn until the view rests. */
  moved(): void {
    if (this.#isSlow) {
      if (this.#rest === undefined) this.onMoving(true);
      else clearTimeout(this.#rest);
      this.#rest = setTimeout(() => {
        this.#rest = undefined;
        this.onMoving(false);
        this.draw();
      }, restAfter);
    }
    this.draw();
  }

  /** Draws the first picture. If it takes long, less is drawn while the view moves. */
  begin(): void {
    this.#isSlow = this.measure() > slowPicture;
  }

  /** Draws a picture and waits for it. Returns the milliseconds that it took. */
  measure(): number {
    const start = performance.now();
    this.drawNow();
    const context = this.#renderer.getContext();
    context.readPixels(0, 0, 1, 1, context.RGBA, context.UNSIGNED_BYTE, new Uint8Array(4));
    return performance.now() - start;
  }

  drawNow(): void {
    this.#isAsked = false;
    this.onDraw();
    this.#renderer.render(this.scene, this.camera);
  }

  /** Returns the ray under a place of the canvas, in pixels of the page. */
  ray(x: number, y: number): Ray {
    const box = this.canvas.getBoundingClientRect();
    const caster = new THREE.Raycaster();
    this.camera.updateMatrixWorld();
    caster.setFromCamera(
      new THREE.Vector2(((x - box.left) / box.width) * 2 - 1, 1 - ((y - box.top) / box.height) * 2),
      this.camera,
    );
    return { origin: caster.ray.origin.toArray(), direction: caster.ray.direction.toArray() };
  }

  /** Returns the position on the page of a place in drawn coordinates; invalid if `isBehind` the camera. */
  project(p: Triple): { x: number; y: number; isBehind: boolean } {
    const box = this.canvas.getBoundingClientRect();
    this.camera.updateMatrixWorld();
    const at = new THREE.Vector3(...p).project(this.camera);
    return {
      x: box.left + ((at.x + 1) / 2) * box.width,
      y: box.top + ((1 - at.y) / 2) * box.height,
      isBehind: at.z > 1,
    };
  }

  /** Returns the distance from which all corners of the box are in the picture, with a margin. */
  #distanceToSeeAll(direction: THREE.Vector3, box: Box): number {
    const right = new THREE.Vector3().crossVectors(this.camera.up, direction).normalize();
    const up = new THREE.Vector3().crossVectors(direction, right);
    const high = Math.tan((this.camera.fov * Math.PI) / 360);
    const wide = high * this.camera.aspect;
    const center = middle(box);
    const distances = [0, 1, 2, 3, 4, 5, 6, 7].map((c) => {
      const corner = [0, 1, 2].map((a) => ((c >> a) & 1 ? box.upper : box.lower)[a] - center[a]) as Triple;
      const p = new THREE.Vector3(...corner);
      return p.dot(direction) + Math.max(Math.abs(p.dot(right)) / wide, Math.abs(p.dot(up)) / high);
    });
    return Math.max(1.08 * Math.max(...distances), 0.1 * radiusOf(box));
  }

  #resize(): void {
    const parent = this.canvas.parentElement as HTMLElement;
    const [width, height] = [Math.max(parent.clientWidth, 1), Math.max(parent.clientHeight, 1)];
    this.#renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    if (this.#fitted !== undefined) this.look(this.#fitted);
    pixelRatio.value = this.#renderer.getPixelRatio();
    viewport.value.set((width * pixelRatio.value) / 2, (height * pixelRatio.value) / 2);
    this.drawNow();
  }
}
