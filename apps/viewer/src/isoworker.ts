// Worker that extracts level surfaces. The first message is the field. Each further message is a level, answered by a
// surface.
import { SurfaceNets } from "./surfacenets.ts";

export type IsoField = { values: Float32Array; size: number[]; spacing: number[] };
export type IsoQuestion = { field: IsoField } | { level: number };

let nets: SurfaceNets | undefined;

onmessage = (event: MessageEvent<IsoQuestion>) => {
  const question = event.data;
  if ("field" in question) {
    nets = new SurfaceNets(question.field.values, question.field.size, question.field.spacing);
    return;
  }
  if (nets === undefined) return;
  const surface = nets.extract(question.level);
  const answer = { level: question.level, surface };
  (self as unknown as Worker).postMessage(answer, [
    surface.positions.buffer as ArrayBuffer,
    surface.normals.buffer as ArrayBuffer,
    surface.triangles.buffer as ArrayBuffer,
  ]);
};
