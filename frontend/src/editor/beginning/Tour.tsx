/** A walk around the editor in five stops, which can be left at any of them. */
import { Button } from "@mantine/core";
import { X } from "lucide-react";
import { type KeyboardEvent, useEffect, useLayoutEffect, useRef, useState } from "react";
import { useTranslation } from "react-i18next";
import { IconButton } from "@/design/IconButton";
import { focusMap } from "../state/focus";
import classes from "./beginning.module.css";
import { cardSpot, leaveTour, type Rectangle, stopBeside, TOUR_STOPS, type TourStop, useTour } from "./tourStops";

export function Tour() {
  const at = useTour((tour) => tour.at);
  useEffect(() => leaveTour, []);
  const stop = at === null ? undefined : TOUR_STOPS[at];
  // Each stop is a card of its own, so that it takes the focus and is read out.
  return at !== null && stop ? <Stop key={at} at={at} stop={stop} /> : null;
}

function find({ target }: TourStop): Element | null {
  return document.querySelector(target);
}

function isThere(stop: TourStop): boolean {
  return find(stop) !== null;
}

function Stop({ at, stop }: { at: number; stop: TourStop }) {
  const { t } = useTranslation();
  const card = useRef<HTMLDivElement>(null);
  const { ring, spot } = useSpot(stop, card);
  const leave = () => {
    leaveTour();
    focusMap();
  };
  const go = (by: 1 | -1) => {
    const next = stopBeside(at, by, isThere);
    if (next === null) leave();
    else useTour.setState({ at: next });
  };
  const press = (event: KeyboardEvent) => {
    if (event.key !== "Escape") return;
    event.stopPropagation();
    leave();
  };
  return (
    <>
      {ring ? <div className={classes.ring} style={{ ...ring }} aria-hidden="true" /> : null}
      {/* oxlint-disable-next-line jsx-a11y/no-noninteractive-element-interactions -- Escape leaves it from each of its buttons */}
      <div
        ref={card}
        className={classes.card}
        style={spot}
        role="dialog"
        aria-labelledby="tour-title"
        aria-describedby="tour-text"
        tabIndex={-1}
        onKeyDown={press}
      >
        <IconButton label={t("first.tour.leave")} className={classes.leave} onClick={leave}>
          <X size={15} aria-hidden="true" />
        </IconButton>
        <small>{t("first.tour.of", { at: at + 1, all: TOUR_STOPS.length })}</small>
        <h2 id="tour-title">{t(`first.tour.${stop.id}.title`)}</h2>
        <p id="tour-text">{t(`first.tour.${stop.id}.text`)}</p>
        <div className={classes.cardActions}>
          {at > 0 ? (
            <Button variant="default" size="xs" onClick={() => go(-1)}>
              {t("first.tour.back")}
            </Button>
          ) : null}
          <Button size="xs" onClick={() => go(1)}>
            {t(stopBeside(at, 1, isThere) === null ? "first.tour.done" : "first.tour.next")}
          </Button>
        </div>
      </div>
    </>
  );
}

/** The ring around what the stop is about, and the card beside it; both follow when the window changes. */
function useSpot(stop: TourStop, card: React.RefObject<HTMLDivElement | null>) {
  const [placed, setPlaced] = useState<{ ring: Rectangle | null; spot: { left: number; top: number } }>();
  useLayoutEffect(() => {
    const place = () => {
      const box = find(stop)?.getBoundingClientRect();
      const { width = 320, height = 180 } = card.current?.getBoundingClientRect() ?? {};
      const screen = { width: innerWidth, height: innerHeight };
      const whole = { left: 0, top: 0, ...screen };
      const ring = box ? { left: box.left, top: box.top, width: box.width, height: box.height } : null;
      setPlaced({ ring, spot: cardSpot(ring ?? whole, { width, height }, screen) });
    };
    place();
    card.current?.focus({ preventScroll: true });
    window.addEventListener("resize", place);
    return () => window.removeEventListener("resize", place);
  }, [stop, card]);
  return placed ?? { ring: null, spot: { left: 0, top: 0 } };
}
