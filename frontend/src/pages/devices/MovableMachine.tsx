/** A machine that an admin puts somewhere else on the map, by dragging or by the arrow keys. */
import { useEffect, useRef, useState, type KeyboardEvent, type PointerEvent } from "react";
import { useTranslation } from "react-i18next";
import type { Device, Site, SiteMap } from "@/api/types";
import { formatNumber } from "@/i18n/format";
import { footprint } from "@/map/devices/device";
import { nameOnMap } from "@/map/devices/framing";
import { DeviceGlyph } from "@/map/devices/DeviceToken";
import { toMetres, toPixels, type Point } from "@/map/plane/projection";
import { useDecide } from "./decisions";
import { isSame, nudge, onMap } from "./placement";
import styles from "./keys/keys.module.css";

const HALO = 5;

interface MovableProps {
  site: Site;
  map: SiteMap;
  device: Device;
}

export function MovableMachine({ site, map, device }: MovableProps) {
  const { t } = useTranslation();
  const place = useDraftPlace(site, map, device);
  const { at, draft, keep } = place;
  const pixel = toPixels(at);
  const { width, height } = footprint(device);
  return (
    <g
      transform={`translate(${pixel.x} ${pixel.y})`}
      className={styles.movable}
      role="button"
      tabIndex={0}
      aria-label={t("placing.at", { name: device.name, x: formatNumber(at[0], 2), y: formatNumber(at[1], 2) })}
      aria-describedby="placing-help"
      data-moved={draft ? true : undefined}
      {...useDragging(place)}
      onKeyDown={(event) => pressed(event, place)}
      onBlur={keep}
    >
      <DeviceGlyph device={device} plain />
      <rect
        className={styles.halo}
        x={-width / 2 - HALO}
        y={-height / 2 - HALO}
        width={width + 2 * HALO}
        height={height + 2 * HALO}
        rx={8}
      />
      <text className={styles.movableName} y={height / 2 + 22} textAnchor="middle">
        {nameOnMap(device.name)}
      </text>
    </g>
  );
}

interface DraftPlace {
  at: Point;
  draft: Point | null;
  setDraft: (point: Point | null) => void;
  keep: () => void;
}

function pressed(event: KeyboardEvent, { at, draft, setDraft, keep }: DraftPlace): void {
  const next = nudge(at, event.key, event.shiftKey);
  if (next) setDraft(next);
  else if (event.key === "Enter") keep();
  else if (event.key === "Escape" && draft) setDraft(null);
  else return;
  event.preventDefault();
}

/** Where the pointer is on the plane in which the machine stands, in metres. */
function pointed(event: PointerEvent<SVGGElement>): Point {
  const plane = event.currentTarget.parentElement as unknown as SVGGElement;
  return toMetres(new DOMPoint(event.clientX, event.clientY).matrixTransform(plane.getScreenCTM()?.inverse()));
}

function useDragging({ at, setDraft, keep }: DraftPlace) {
  const [grip, setGrip] = useState<Point | null>(null);
  const letGo = (done: () => void) => () => {
    if (grip) done();
    setGrip(null);
  };
  return {
    onPointerDown: (event: PointerEvent<SVGGElement>) => {
      if (event.button !== 0) return;
      event.currentTarget.setPointerCapture(event.pointerId);
      const [x, y] = pointed(event);
      setGrip([at[0] - x, at[1] - y]);
    },
    onPointerMove: (event: PointerEvent<SVGGElement>) => {
      if (!grip) return;
      const [x, y] = pointed(event);
      setDraft([x + grip[0], y + grip[1]]);
    },
    onPointerUp: letGo(keep),
    onPointerCancel: letGo(() => setDraft(null)),
  };
}

/**
 * Where the machine stands for the one who moves it, until the server says the same.
 *
 * What is moved while an earlier place is being kept is kept next.
 */
function useDraftPlace(site: Site, map: SiteMap, device: Device): DraftPlace {
  const decide = useDecide(site.slug);
  const [draft, setDraft] = useState<Point | null>(null);
  const [sent, next] = [useRef<Point | null>(null), useRef<Point | null>(null)];
  const { x, y } = device.location;
  useEffect(() => {
    setDraft((last) => (last && sent.current && !isSame(last, sent.current) ? last : null));
  }, [x, y, sent]);
  const send = (to: Point) => {
    sent.current = to;
    const goOn = () => {
      const then = next.current;
      next.current = null;
      if (then && !isSame(then, to)) send(then);
    };
    decide.mutate({ do: "move", device, to }, { onError: () => setDraft(null), onSettled: goOn });
  };
  const keep = () => {
    if (!draft) return;
    if (decide.isPending) next.current = draft;
    else if (isSame(draft, [x, y])) setDraft(null);
    else send(draft);
  };
  const place = (point: Point | null) => setDraft(point && onMap(point, map));
  return { at: draft ?? ([x, y] as const), draft, setDraft: place, keep };
}
