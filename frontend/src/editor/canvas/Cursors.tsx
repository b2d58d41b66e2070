/** The pointers of the others on the map; moved outside React, hidden after 30 s of rest. */
import { useEffect, useRef, useState } from "react";
import { toPixels } from "@/map/plane/projection";
import { useStage } from "@/program/canvas/stageContext";
import type { SharedProgram } from "../shared/sharedProgram";
import { readCursors, type Cursor } from "../state/presence";
import classes from "./cursors.module.css";

const REST_MS = 30_000;

export function Cursors({ shared }: { shared: SharedProgram }) {
  const { viewport } = useStage();
  const [shown, setShown] = useState<readonly Cursor[]>([]);
  /** Since when each rests; for as long as it is looked at. */
  const seen = useRef(new Map<number, { key: string; at: number }>());
  const elements = useRef(new Map<number, HTMLDivElement>());
  useEffect(() => {
    const update = () => {
      const fresh = readCursors(shared).filter((cursor) => isFresh(seen.current, cursor, performance.now()));
      const view = viewport.get();
      for (const cursor of fresh) {
        const at = toPixels(cursor.at);
        const element = elements.current.get(cursor.client);
        if (element)
          element.style.transform = `translate(${at.x * view.zoom + view.x}px, ${at.y * view.zoom + view.y}px)`;
      }
      setShown((before) => (sameClients(before, fresh) ? before : fresh));
    };
    update();
    const timer = setInterval(update, 2000);
    const stop = viewport.subscribe(update);
    shared.awareness.on("change", update);
    return () => {
      clearInterval(timer);
      stop();
      shared.awareness.off("change", update);
    };
  }, [shared, viewport, shown]);
  return (
    <div className={classes.cursors} aria-hidden="true">
      {shown.map((cursor) => (
        <div
          key={cursor.client}
          className={classes.cursor}
          style={{ color: cursor.colour }}
          ref={(element) => {
            if (element) elements.current.set(cursor.client, element);
            else elements.current.delete(cursor.client);
          }}
        >
          <svg width={16} height={18} viewBox="0 0 16 18">
            <path d="M1.5 1.5 14 8l-5.6 1.7L5.6 15Z" fill="currentColor" stroke="var(--floor)" strokeWidth={1.5} />
          </svg>
          <span style={{ background: cursor.colour }}>{cursor.name}</span>
        </div>
      ))}
    </div>
  );
}

function isFresh(seen: Map<number, { key: string; at: number }>, cursor: Cursor, now: number): boolean {
  const key = cursor.at.join();
  const before = seen.get(cursor.client);
  if (before?.key !== key) seen.set(cursor.client, { key, at: now });
  return now - (seen.get(cursor.client)?.at ?? now) < REST_MS;
}

function sameClients(one: readonly Cursor[], other: readonly Cursor[]): boolean {
  return one.length === other.length && one.every((cursor, index) => cursor.client === other[index]?.client);
}
