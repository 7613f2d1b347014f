// What all things on the stage have in common.
import type * as THREE from "three";
import type { Colors } from "./colors.ts";
import type { Ray } from "./geometry.ts";
import type { Fact, Item, Triple } from "./scene.ts";

/** What a click hit. */
export type Hit = {
  t: number; // along the ray
  title: string;
  facts: Fact[];
  at: Triple; // in the world of the files
  footprints: Triple[];
  labels?: { at: string; foot: string }; // what these are called, where it is not place and footprint
  radius?: number; // of a ball around `at`
  about?: Triple; // about where the footprint is, where it is not known
  reach?: number; // how far away it is
  feature?: number; // the site, where sites are vertices, edges and faces
  site?: number; // what the first footprint lies on, of a mesh that is elsewhere
};

type Titled = { title: string; units: string };
type Ramp = Titled & { kind: "ramp"; from: number; to: number };
export type Legend =
  | (Ramp & { scale: "sequential" })
  | (Ramp & { scale: "grey" })
  // Colours go to `extremes`, and the data from `from` to `to`.
  | (Ramp & { scale: "diverging"; extremes: [inside: number, outside: number] })
  | (Titled & { kind: "regions"; note: string })
  | (Titled & { kind: "keys"; entries: readonly { text: string; color: string }[] });

export interface View {
  readonly item: Exclude<Item, { kind: "error" }>;
  readonly object: THREE.Object3D;
  /** Controls of its own, below its name. */
  readonly controls: HTMLElement;
  /** Whether any of it is seen, where its object is visible. */
  readonly isEmpty?: boolean;
  /** What pictures of it are named after, where that is not its item. */
  readonly fileName?: string;
  /** @param ray  in the drawn world. */
  pick(ray: Ray): Hit | undefined;
  legends(): Legend[];
  /** What changes with the controls, for the text. */
  liveFacts(): Fact[];
  setTheme?(isDark: boolean): void;
  /** Draws less while the view moves. */
  setMoving?(isMoving: boolean): void;
}

/** What a view needs of the page. */
export type Surroundings = {
  center: Triple; // of the drawn world, in that of the files
  radius: number;
  colors: Colors;
  changed: () => void; // something looks different now
  moved: () => void; // the same while something plays: texts can wait, and less may be drawn
  forget: () => void; // what was clicked is not there any more
  goTo: (view: View, hit: Hit, from: Triple, size: number) => void; // shows a hit as if it were clicked, from a direction
};
