/** The next step follows the last: what mostly comes next, one press away, until something else is done. */
import { CornerDownRight, X } from "lucide-react";
import { useMemo } from "react";
import { useTranslation } from "react-i18next";
import { IconButton } from "@/design/IconButton";
import { VipoIcon } from "@/design/VipoIcon";
import { useRoutes } from "@/program/canvas/useRoutes";
import { keyOfPath } from "@/program/scene/stepPaths";
import { spotOf } from "@/program/surroundings";
import { valueText } from "@/program/words/stepWords";
import { floorMark } from "@/map/floor/floor";
import { useLanding } from "../canvas/landing";
import { chipBoxes, createTask } from "../canvas/stepGesture";
import { type OpenProgram, useOpenProgram } from "../state/context";
import { createAtDevice, createAtPlace } from "../state/newStep";
import { RESTING } from "../state/tool";
import { useUi } from "../state/ui";
import classes from "./beginning.module.css";
import { keyOfNext, type NextStep, nextSteps } from "./nextSteps";

export function NextSteps() {
  const open = useOpenProgram();
  const fresh = useUi((ui) => ui.fresh);
  const alone = useUi((ui) => ui.selected.length === 1 && ui.gesture.tool === "select" && ui.into === null);
  const { document, surroundings, canEdit } = open;
  const found = useMemo(
    () => (fresh !== null && alone && canEdit ? nextSteps({ document, surroundings }, fresh) : []),
    [fresh, alone, canEdit, document, surroundings],
  );
  return <Row open={open} found={found} />;
}

const ICONS = { operate: "operate", carry: "pickdrop", drive: "move" };

/** Stays while it is empty, so that a chip which it has set down can still come onto its route. */
function Row({ open, found }: { open: OpenProgram; found: readonly NextStep[] }) {
  const { t } = useTranslation();
  const draw = useDraw(open, found);
  const words = useWords(open);
  if (found.length === 0) return null;
  return (
    <div className={classes.next} role="group" aria-label={t("first.next.label")}>
      <CornerDownRight size={16} aria-hidden="true" />
      <span>{t("first.next.then")}</span>
      {found.map((next) => (
        <button key={keyOfNext(next)} type="button" className={classes.choice} onClick={() => draw(next)}>
          <VipoIcon name={ICONS[next.do]} size={16} />
          {words(next)}
        </button>
      ))}
      <IconButton label={t("first.next.close")} onClick={() => useUi.setState({ fresh: null })}>
        <X size={15} aria-hidden="true" />
      </IconButton>
    </div>
  );
}

function useWords({ speaker }: OpenProgram) {
  const { t } = useTranslation();
  return (next: NextStep): string => {
    if (next.do === "operate") return next.method.title || next.method.name;
    if (next.do === "drive") return t("first.next.drive", { place: next.to.name });
    const load = `${valueText(next.load.quantity, speaker) ?? "?"} × ${valueText(next.load.object, speaker) ?? "?"}`;
    return t("first.next.carry", { load, place: next.to.name });
  };
}

/** The ways are asked for while the choices are read, so that a step is mostly set down on its way at once. */
function useDraw(open: OpenProgram, found: readonly NextStep[]) {
  const { document, surroundings, site, plan } = open;
  const endsOf = (next: NextStep) => {
    if (next.do !== "carry") return null;
    const [from, to] = [next.from, next.to].map((each) => spotOf({ device: each.id }, surroundings, document, null));
    return from && to ? { from, to } : null;
  };
  const keys = found.flatMap((next) => {
    const ends = endsOf(next);
    return ends ? [keyOfPath(ends.from, ends.to)] : [];
  });
  const routes = useRoutes(site.slug, floorMark(plan), keys);
  const land = useLanding(open, routes);
  return (next: NextStep) => {
    const ends = endsOf(next);
    if (next.do === "carry" && ends) createTask(open, ends, next.load, routes, land);
    else if (next.do === "operate") operate(open, next);
    else if (next.do === "drive") createAtPlace(open, next.to);
  };
}

function operate(open: OpenProgram, { at, method }: Extract<NextStep, { do: "operate" }>): void {
  createAtDevice(open, { ...RESTING, tool: "operate" }, at, chipBoxes(open), method.name);
}
