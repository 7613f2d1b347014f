// Requests level surfaces from a worker. While it is busy, only the last request is kept.
import type { IsoQuestion } from "./isoworker.ts";
import type { Surface } from "./surfacenets.ts";

declare const ISO_WORKER: string; // source of the worker, inserted by the build

export class IsoSurfaces {
  readonly #worker: Worker;
  #isBusy = false;
  #next: number | undefined;

  constructor(values: Float32Array, size: number[], spacing: number[], onSurface: (surface: Surface) => void) {
    const url = URL.createObjectURL(new Blob([ISO_WORKER], { type: "text/javascript" }));
    this.#worker = new Worker(url);
    URL.revokeObjectURL(url);
    this.#worker.onmessage = (event: MessageEvent<{ level: number; surface: Surface }>) => {
      this.#isBusy = false;
      if (this.#next !== undefined) this.ask(this.#next);
      onSurface(event.data.surface);
    };
    this.#send({ field: { values, size, spacing } });
  }

  get isBusy(): boolean {
    return this.#isBusy;
  }

  ask(level: number): void {
    this.#next = this.#isBusy ? level : undefined;
    if (this.#isBusy) return;
    this.#isBusy = true;
    this.#send({ level });
  }

  #send(question: IsoQuestion): void {
    this.#worker.postMessage(question);
  }
}
