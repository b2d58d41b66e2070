/** A thing on the map that is put somewhere else by hand: by dragging or by the arrow keys. */
import { useEffect, useRef, useState, type KeyboardEvent, type MouseEvent, type PointerEvent } from "react";
import { toMetres, type Point } from "@/map/plane/projection";
import { isSame, nudge, onMap, type Extent } from "./placement";

export interface DraftPoint {
  at: Point;
  draft: Point | null;
  setDraft: (point: Point | null) => void;
  keep: () => void;
}

/** Arrow keys move, Enter keeps, Esc takes back. */
export function movedByKey(event: KeyboardEvent, { at, draft, setDraft, keep }: DraftPoint): void {
  const next = nudge(at, event.key, event.shiftKey);
  if (next) setDraft(next);
  else if (event.key === "Enter") keep();
  else if (event.key === "Escape" && draft) setDraft(null);
  else return;
  event.preventDefault();
}

/** Where the pointer is on the plane in which the machine stands, in metres. */
export function pointed(event: PointerEvent<SVGGraphicsElement> | MouseEvent<SVGGraphicsElement>): Point {
  const plane = event.currentTarget.parentElement as unknown as SVGGElement;
  return toMetres(new DOMPoint(event.clientX, event.clientY).matrixTransform(plane.getScreenCTM()?.inverse()));
}

/** Pixels of the screen: a hand that presses moves less than this. */
export const LEAST_DRAG = 4;

interface Drag<At> {
  /** Where the thing is when it is taken hold of. */
  at: At;
  /** Show it where it comes when it is moved by (metres) from where it was. */
  show: (from: At, by: Point) => void;
  keep: () => void;
  giveUp: () => void;
}

interface Held<At> {
  pointer: number;
  from: At;
  x: number;
  y: number;
  grip: Point;
  isMoved: boolean;
}

/** What a thing on the map hears while the main button, a pen or the first finger drags it. */
export function useDrag<At>({ at, show, keep, giveUp }: Drag<At>) {
  const held = useRef<Held<At> | null>(null);
  const isHeldBy = (event: PointerEvent) => held.current?.pointer === event.pointerId;
  const letGo = (done: () => void) => (event: PointerEvent) => {
    if (!isHeldBy(event)) return;
    held.current = null;
    done();
  };
  return {
    onPointerDown: (event: PointerEvent<SVGGraphicsElement>) => {
      if (event.button !== 0 || !event.isPrimary) return;
      event.currentTarget.setPointerCapture(event.pointerId);
      const { pointerId: pointer, clientX: x, clientY: y } = event;
      held.current = { pointer, from: at, x, y, grip: pointed(event), isMoved: false };
    },
    onPointerMove: (event: PointerEvent<SVGGraphicsElement>) => {
      const { current } = held;
      if (!current || !isHeldBy(event)) return;
      current.isMoved ||= Math.hypot(event.clientX - current.x, event.clientY - current.y) >= LEAST_DRAG;
      if (!current.isMoved) return;
      const [x, y] = pointed(event);
      show(current.from, [x - current.grip[0], y - current.grip[1]]);
    },
    onPointerUp: letGo(keep),
    onPointerCancel: letGo(giveUp),
  };
}

export function useDragging({ at, setDraft, keep }: DraftPoint) {
  return useDrag({
    at,
    show: ([x, y], by) => setDraft([x + by[0], y + by[1]]),
    keep,
    giveUp: () => setDraft(null),
  });
}

/** Send how it is now; it is told when that is refused, and when it is over. */
type Send<Value> = (to: Value, done: { onError: () => void; onSettled: () => void }) => void;

const UNSEEN = { onError: () => {}, onSettled: () => {} };

export interface Draft<Value> {
  /** How it is shown. */
  at: Value;
  draft: Value | null;
  /** Show it so; null: as it is kept. */
  setDraft: (value: Value | null) => void;
  /** Send what is shown, or this. */
  keep: (given?: Value) => void;
}

/**
 * How a thing is for the one who changes it, until the server says the same.
 *
 * What is changed while an earlier change is being kept (`isSending`) stays, and is kept next, also where it is shown no
 * more by then: `send` sends one after the other.
 */
export function useDraft<Value>(
  kept: Value,
  isAlike: (a: Value, b: Value) => boolean,
  isSending: boolean,
  send: Send<Value>,
): Draft<Value> {
  const [draft, setDraft] = useState<Value | null>(null);
  const [sent, next] = [useRef<Value | null>(null), useRef<Value | null>(null)];
  useEffect(() => {
    setDraft((last) => (last && sent.current && !isAlike(last, sent.current) ? last : null));
  }, [JSON.stringify(kept), sent]); // oxlint-disable-line react/exhaustive-deps -- when what is kept is another, and only then
  const sendOn = (to: Value) => {
    sent.current = to;
    const goOn = () => {
      const then = next.current;
      next.current = null;
      if (then && !isAlike(then, to)) sendOn(then);
    };
    const takeBack = () => setDraft((last) => (last && !isAlike(last, to) ? last : null));
    send(to, { onError: takeBack, onSettled: goOn });
  };
  const leave = useRef(() => {});
  useEffect(() => {
    leave.current = () => {
      if (next.current && sent.current && !isAlike(next.current, sent.current)) send(next.current, UNSEEN);
    };
  });
  useEffect(() => () => leave.current(), []);
  const keep = (given?: Value) => {
    const to = given ?? draft;
    if (!to) return;
    setDraft(to);
    if (isSending) next.current = to;
    else if (isAlike(to, kept)) setDraft(null);
    else sendOn(to);
  };
  return { at: draft ?? kept, draft, setDraft, keep };
}

/** Where a thing stands for the one who moves it, never off the map. */
export function useDraftPoint(map: Extent, at: Point, isSending: boolean, send: Send<Point>): DraftPoint {
  const { setDraft, keep, ...shown } = useDraft(at, isSame, isSending, send);
  return { ...shown, setDraft: (point) => setDraft(point && onMap(point, map)), keep: () => keep() };
}
