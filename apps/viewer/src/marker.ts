// The result of a click on the stage: the place, lines to its footprints, and the ball that touches them.
import * as THREE from "three";
import { sub } from "./geometry.ts";
import type { Triple } from "./scene.ts";
import { dotMaterial, lineGeometry, lineMaterial, setColor, setStyle, surfaceMaterial } from "./shaders.ts";
import type { Hit } from "./view.ts";

export class Marker {
  readonly object = new THREE.Group();
  readonly #center: Triple;
  readonly #lines = new THREE.Mesh(new THREE.BufferGeometry(), lineMaterial([0.8, 0.15, 0.4], 3));
  readonly #dots = new THREE.Points(new THREE.BufferGeometry(), dotMaterial([0.8, 0.15, 0.4], 10));
  readonly #ball = new THREE.Mesh(new THREE.SphereGeometry(1, 48, 24), surfaceMaterial());

  constructor(center: Triple) {
    this.#center = center;
    this.object.add(this.#lines, this.#dots, this.#ball);
    for (const part of [this.#lines, this.#dots, this.#ball]) part.frustumCulled = false;
    for (const material of [this.#lines.material, this.#dots.material]) material.depthTest = false;
    this.#lines.renderOrder = this.#dots.renderOrder = 30;
    this.#ball.renderOrder = 20;
    setStyle(this.#ball.material, "translucent", 0.1);
    setColor(this.#ball.material, [0.8, 0.15, 0.4]);
    this.object.visible = false;
  }

  show(hit: Hit | undefined): void {
    this.object.visible = hit !== undefined;
    if (hit === undefined) return;
    const at = sub(hit.at, this.#center);
    const feet = (hit.footprints.length > 0 ? hit.footprints : hit.about ? [hit.about] : []).map((p) =>
      sub(p, this.#center),
    );
    this.#lines.geometry.dispose();
    this.#lines.geometry = lineGeometry(new Float32Array(feet.flatMap((p) => [...at, ...p])));
    this.#lines.visible = feet.length > 0;
    this.#dots.geometry.dispose();
    this.#dots.geometry = new THREE.BufferGeometry();
    this.#dots.geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array([at, ...feet].flat()), 3));
    this.#ball.visible = hit.radius !== undefined;
    this.#ball.position.set(...at);
    this.#ball.scale.setScalar(Math.max(hit.radius ?? 1, 1e-30));
  }
}
