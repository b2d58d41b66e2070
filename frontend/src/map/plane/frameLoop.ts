/** Looks at something in each frame of the screen while it changes, and ten times a second while it does not. */

const STILL_FRAMES = 30;
const RESTING_MS = 100;

/**
 * Call `look` again and again with the frame's time; it says whether anything was different.
 *
 * After half a second without a difference it is called ten times a second: a page that is open all day lets the
 * processor sleep. `wake` makes it look at the next frame again.
 */
export class FrameLoop {
  private frame = 0;
  private timer: ReturnType<typeof setTimeout> | undefined;
  private still = 0;

  constructor(private readonly look: (now: number) => boolean) {
    this.ask();
  }

  readonly wake = (): void => {
    this.still = 0;
    if (this.timer === undefined) return;
    clearTimeout(this.timer);
    this.timer = undefined;
    this.ask();
  };

  stop(): void {
    cancelAnimationFrame(this.frame);
    clearTimeout(this.timer);
  }

  private readonly ask = (): void => {
    this.timer = undefined;
    this.frame = requestAnimationFrame(this.step);
  };

  private readonly step = (now: number): void => {
    this.still = this.look(now) ? 0 : this.still + 1;
    if (this.still < STILL_FRAMES) this.ask();
    else this.timer = setTimeout(this.ask, RESTING_MS);
  };
}
