/** Pins on the map at what has open comments; a press opens the threads, as read, or comes nearer to what lies close. */
import { useReactFlow, useStore, useStoreApi } from "@xyflow/react";
import { useEffect, useMemo, useRef } from "react";
import { useTranslation } from "react-i18next";
import { showSteps } from "../commands/view";
import { useOpenProgram, type OpenProgram } from "../state/context";
import { select, useUi } from "../state/ui";
import { aboutOf } from "./about";
import classes from "./comments.module.css";
import { openThreads, resetComments, useComments } from "./commentsUi";
import { gatherPins, levelOf, pinsOf, type Pin } from "./pins";
import { useCommenting, useThreads } from "@/shell/comments/threads";

/** Nearer than this a pin opens its threads, whatever it stands for. */
const NEAR_ENOUGH = 1;

export function CommentPins() {
  const { program } = useOpenProgram();
  const shown = useComments((ui) => ui.pins);
  useEffect(() => resetComments, [program.id]);
  return shown ? <Pins /> : null;
}

function Pins() {
  const open = useOpenProgram();
  const { program, document, scene } = open;
  const threads = useThreads(program.id).data;
  const level = useStore((flow) => levelOf(flow.transform[2]));
  const flow = useReactFlow();
  const resting = useUi((ui) => ui.gesture.tool === "select");
  const pins = useMemo(() => pinsOf(threads ?? [], { document, scene }), [threads, document, scene]);
  const gathered = useMemo(() => gatherPins(pins, level), [pins, level]);
  const plane = useOwnSize();
  const { t } = useTranslation();
  const act = useCommenting(program.id);
  const byId = new Map((threads ?? []).map((thread) => [thread.id, thread]));
  const unreadOf = (pin: Pin) => pin.threads.filter((id) => (byId.get(id)?.unread ?? 0) > 0);
  const nameOf = ({ threads: [first], things, threads: all }: Pin) => {
    const thread = byId.get(first ?? "");
    const what = things === 1 && thread ? aboutOf(open, thread) : t("comments.things", { count: things });
    return t("comments.pin", { count: all.length, what });
  };
  return (
    <div ref={plane} className={`${classes.pins} nopan nodrag`} data-quiet={resting ? undefined : true}>
      {gathered.map((pin) => (
        <button
          key={pin.key}
          type="button"
          className={classes.pin}
          style={{ left: pin.at.x, top: pin.at.y }}
          data-unread={pin.unread > 0 || undefined}
          aria-label={nameOf(pin)}
          title={nameOf(pin)}
          onClick={() => {
            if (press(open, pin, flow.getZoom())) void Promise.allSettled(unreadOf(pin).map(act.markRead));
          }}
        >
          {pin.threads.length}
        </button>
      ))}
    </div>
  );
}

/** True once its threads are opened. */
function press(open: OpenProgram, pin: Pin, zoom: number): boolean {
  const parts = pin.things > 1 && zoom < NEAR_ENOUGH && pin.steps.length === pin.things;
  if (parts && showSteps(open, pin.steps)) return false;
  const [step] = pin.steps;
  if (pin.steps.length === 1 && step !== undefined) select([step]);
  openThreads(pin.threads);
  return true;
}

/** Pins lie in the map's plane and are moved by it; that they keep their own size is told to them all at once. */
function useOwnSize() {
  const store = useStoreApi();
  const element = useRef<HTMLDivElement>(null);
  useEffect(() => {
    let told = 0;
    const tell = () => {
      const [, , zoom] = store.getState().transform;
      if (zoom !== told) element.current?.style.setProperty("--out", String(1 / zoom));
      told = zoom;
    };
    tell();
    return store.subscribe(tell);
  }, [store]);
  return element;
}
