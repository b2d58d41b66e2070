/** Keeps a canvas showing the constructs of a view: at once where they are few, else by a picture painted in slices. */
import { watchPalette, type Palette } from "@/map/plane/palette";
import { seenBox, type Viewport } from "@/map/plane/projection";
import type { ViewportSource } from "@/map/plane/viewport";
import type { PaintedLooks } from "./looks";
import { type Content, covers, type Job, paintPieces, unitsOf, work } from "./picture";
import { detailAt } from "../scene/detail";
import type { Pieces } from "../scene/pieces";

/** What is painted within one frame, and what of a larger picture in each. */
const AT_ONCE_UNITS = 150;
const SLICE_UNITS = 45;
/** The same while there is no picture yet, and so nothing to move smoothly. */
const FIRST_SLICE_UNITS = 600;
/** A picture reaches so far over the pane's edges, pixels of the screen. */
const MARGIN = 128;

export interface Shown {
  readonly pieces: Pieces;
  readonly looks: PaintedLooks;
  readonly without: ReadonlySet<string>;
  /** How many constructs are painted, on this canvas or another; on the element, for whoever looks from outside. */
  readonly count?: number;
}

interface Picture {
  readonly canvas: HTMLCanvasElement;
  readonly content: Content;
  readonly view: Viewport;
  readonly size: Size;
}

interface Size {
  readonly width: number;
  readonly height: number;
  readonly density: number;
}

export class ConstructPainter {
  #shown: Shown | null = null;
  #content: Content | null = null;
  #palette: Palette | null = null;
  #size: Size = { width: 0, height: 0, density: 1 };
  #picture: Picture | null = null;
  #next: { readonly job: Job; readonly picture: Picture } | null = null;
  #spare: HTMLCanvasElement | null = null;
  #told: Content | null = null;
  #frame = 0;
  readonly #stops: (() => void)[];

  /** `onPainted` hears what the canvas now shows without, after each content. */
  constructor(
    private readonly element: HTMLCanvasElement,
    private readonly context: CanvasRenderingContext2D,
    private readonly viewport: ViewportSource,
    private readonly onPainted?: (without: ReadonlySet<string>) => void,
  ) {
    const resize = new ResizeObserver(() => this.#measure());
    resize.observe(element);
    const stopPalette = watchPalette((palette) => {
      this.#palette = palette;
      this.#renew();
    });
    this.#stops = [stopPalette, viewport.subscribe(() => this.#ask()), () => resize.disconnect()];
    void document.fonts?.ready.then(() => this.#renew());
  }

  show(shown: Shown): void {
    this.#shown = shown;
    this.#renew();
  }

  end(): void {
    cancelAnimationFrame(this.#frame);
    for (const stop of this.#stops) stop();
  }

  #measure(): void {
    const { clientWidth: width, clientHeight: height } = this.element;
    const density = window.devicePixelRatio || 1;
    this.#size = { width, height, density };
    fitTo(this.element, width * density, height * density);
    this.#picture = this.#next = null;
    this.#ask();
  }

  #renew(): void {
    if (this.#shown && this.#palette) this.#content = { ...this.#shown, palette: this.#palette };
    this.#ask();
  }

  #ask(): void {
    if (!this.#frame) this.#frame = requestAnimationFrame(() => this.#draw());
  }

  #draw(): void {
    this.#frame = 0;
    const content = this.#content;
    if (!content || this.#size.width === 0) return;
    const view = this.viewport.get();
    if (this.#isLarge(content, view)) this.#drawByPicture(content, view);
    else this.#drawAtOnce(content, view);
  }

  /** Whether a view is more than one frame's work; what a picture was begun for stays so while it is moved alone. */
  #isLarge(content: Content, view: Viewport): boolean {
    const begun = this.#next?.picture ?? this.#picture;
    if (begun?.content === content && begun.view.zoom === view.zoom) return true;
    return unitsOf(content, seenBox(view, this.#size), view.zoom) > AT_ONCE_UNITS;
  }

  #drawAtOnce(content: Content, view: Viewport): void {
    this.#picture = this.#next = null;
    work(this.#begin(this.context, content, view, 0), Infinity);
    this.#tell(content);
  }

  #drawByPicture(content: Content, view: Viewport): void {
    const { width, height, density } = this.#size;
    if (!this.#next && !this.#isShown(content, view)) this.#next = this.#beginPicture(content, view);
    if (this.#next && work(this.#next.job, this.#picture ? SLICE_UNITS : FIRST_SLICE_UNITS)) {
      this.#spare = this.#picture?.canvas ?? null;
      this.#picture = this.#next.picture;
      this.#next = null;
      this.#tell(this.#picture.content);
    }
    this.context.setTransform(1, 0, 0, 1, 0, 0);
    this.context.clearRect(0, 0, width * density, height * density);
    if (this.#picture) this.#blit(this.#picture, view);
    if (this.#next || !this.#isShown(content, view)) this.#ask();
  }

  #isShown(content: Content, view: Viewport): boolean {
    return this.#picture?.content === content && covers(this.#picture.view, view, MARGIN);
  }

  #beginPicture(content: Content, view: Viewport): { job: Job; picture: Picture } | null {
    const { width, height, density } = this.#size;
    const canvas = this.#spare ?? document.createElement("canvas");
    this.#spare = null;
    fitTo(canvas, (width + 2 * MARGIN) * density, (height + 2 * MARGIN) * density);
    const context = canvas.getContext("2d");
    if (!context) return null;
    const picture = { canvas, content, view, size: this.#size };
    return { job: this.#begin(context, content, view, MARGIN), picture };
  }

  #begin(context: CanvasRenderingContext2D, content: Content, view: Viewport, margin: number): Job {
    const { width, height, density } = this.#size;
    context.setTransform(density, 0, 0, density, 0, 0);
    context.clearRect(0, 0, width + 2 * margin, height + 2 * margin);
    context.translate(view.x + margin, view.y + margin);
    context.scale(view.zoom, view.zoom);
    context.lineJoin = context.lineCap = "round";
    const { palette, looks } = content;
    const brush = { canvas: context, palette, looks, zoom: view.zoom, detail: detailAt(view.zoom) };
    return paintPieces(brush, content, seenBox(view, this.#size, margin));
  }

  /** Moved to where it belongs now; scaled, too, while the view is zoomed. */
  #blit({ canvas, view: then, size }: Picture, now: Viewport): void {
    const scale = now.zoom / then.zoom;
    const { density } = size;
    const x = (now.x - (then.x + MARGIN) * scale) * density;
    const y = (now.y - (then.y + MARGIN) * scale) * density;
    const same = scale === 1;
    this.context.imageSmoothingEnabled = !same;
    this.context.drawImage(
      canvas,
      same ? Math.round(x) : x,
      same ? Math.round(y) : y,
      canvas.width * scale,
      canvas.height * scale,
    );
  }

  #tell(content: Content): void {
    if (this.#told === content) return;
    this.#told = content;
    if (content.count !== undefined) this.element.dataset.constructs = String(content.count);
    this.onPainted?.(content.without);
  }
}

function fitTo(canvas: HTMLCanvasElement, width: number, height: number): void {
  const [wide, high] = [Math.round(width), Math.round(height)];
  if (canvas.width !== wide) canvas.width = wide;
  if (canvas.height !== high) canvas.height = high;
}
