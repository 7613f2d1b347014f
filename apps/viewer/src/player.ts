// The clock of moving scenes: selects the frame for a time. Frames are skipped if drawing takes longer than a frame.

export class Player {
  readonly count: number;
  isLooping = true;
  #speed: number;
  #since: { time: number; frame: number } | undefined; // while it plays

  /** @param speed  frames per second. */
  constructor(count: number, speed: number) {
    this.count = count;
    this.#speed = speed;
  }

  get isPlaying(): boolean {
    return this.#since !== undefined;
  }

  /** Starts playing at a frame, or at the first one if no frame follows. @param now  in ms. */
  play(frame: number, now: number): void {
    const isOver = !this.isLooping && frame >= this.count - 1;
    this.#since = { time: now, frame: isOver ? 0 : frame };
  }

  pause(): void {
    this.#since = undefined;
  }

  setSpeed(speed: number, now: number): void {
    if (this.#since !== undefined) this.#since = { time: now, frame: this.at(now) ?? 0 };
    this.#speed = speed;
  }

  /** Returns the current frame; undefined if it is not playing. Stops at the last frame, unless it loops. */
  at(now: number): number | undefined {
    if (this.#since === undefined) return undefined;
    const passed = Math.floor((Math.max(now - this.#since.time, 0) / 1000) * this.#speed);
    const frame = this.#since.frame + passed;
    if (this.isLooping) return frame % this.count;
    if (frame < this.count - 1) return frame;
    this.#since = undefined;
    return this.count - 1;
  }
}
