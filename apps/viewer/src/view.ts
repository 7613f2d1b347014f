// Interface of all items on the stage.
import type * as THREE from "three";
import type { Colors } from "./colors.ts";
import type { Ray } from "./geometry.ts";
import type { Fact, Item, Triple } from "./scene.ts";

/** Hit of a click. */
export type Hit = {
  t: number; // along the ray
  title: string;
  facts: Fact[];
  at: Triple; // in coordinates of the files
  footprints: Triple[];
  labels?: { at: string; foot: string }; // names of these, if not place and footprint
  radius?: number; // of a ball around `at`
  about?: Triple; // approximate footprint if the exact one is unknown
  reach?: number; // distance to the footprint
  feature?: number; // site, if sites are vertices, edges and faces
  site?: number; // site of the first footprint, on another mesh
};

type Titled = { title: string; units: string };
type Ramp = Titled & { kind: "ramp"; from: number; to: number };
export type Legend =
  | (Ramp & { scale: "sequential" })
  | (Ramp & { scale: "grey" })
  // Colours range over `extremes`, the data from `from` to `to`.
  | (Ramp & { scale: "diverging"; extremes: [inside: number, outside: number] })
  | (Titled & { kind: "regions"; note: string })
  | (Titled & { kind: "keys"; entries: readonly { text: string; color: string }[] });

export interface View {
  readonly item: Exclude<Item, { kind: "error" }>;
  readonly object: THREE.Object3D;
  /** Controls below its name. */
  readonly controls: HTMLElement;
  /** True if it draws nothing although its object is visible. */
  readonly isEmpty?: boolean;
  /** Name for pictures of it, if not that of its item. */
  readonly fileName?: string;
  /** @param ray  in drawn coordinates. */
  pick(ray: Ray): Hit | undefined;
  legends(): Legend[];
  /** Returns the facts that controls change. */
  liveFacts(): Fact[];
  setTheme?(isDark: boolean): void;
  /** Draws less while the view moves. */
  setMoving?(isMoving: boolean): void;
}

/** Functions and values of the page for views. */
export type Surroundings = {
  center: Triple; // origin of drawn coordinates, in coordinates of the files
  radius: number;
  colors: Colors;
  changed: () => void; // the picture and the texts have changed
  moved: () => void; // the picture changes while something plays: texts can wait, and less may be drawn
  forget: () => void; // the clicked item no longer exists
  goTo: (view: View, hit: Hit, from: Triple, size: number) => void; // shows a hit as if clicked, from a direction
};
