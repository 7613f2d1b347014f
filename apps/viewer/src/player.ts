// The clock of moving scenes: which frame is to be seen when. Frames are left out where drawing takes longer than one.

export class Player {
  readonly count: number;
  isLooping = true;
  #speed: number;
  #since: { time: number; frame: number } | undefined; // while it plays

  /** @param speed  frames a second. */
  constructor(count: number, speed: number) {
    this.count = count;
    this.#speed = speed;
  }

  get isPlaying(): boolean {
    return this.#since !== undefined;
  }

  /** Goes on from a frame; from the first one, where that is the last and nothing would follow. @param now  in ms. */
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

  /** The frame to be seen now; undefined while nothing plays. Ends playing at the last one, unless it loops. */
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
